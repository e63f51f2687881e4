#include "maps/map_descent.h"

#include <algorithm>

namespace spherical_springs::mesh {

MapDescent::MapDescent(MapEnergy& energy, int threads, const core::Checkpoint& checkpoint)
    : energy_(energy), inverse_(energy.pattern(), threads, checkpoint) {}

bool MapDescent::solve() {
  shifted_ = energy_.hessian();
  for (std::size_t n = 0; n < energy_.pattern().rows(); ++n) {
    shifted_[energy_.pattern().diagonal[n]].diagonal().array() += shift_ * energy_.mass()[n];
  }
  if (!inverse_.refresh(shifted_)) return false;
  inverse_.apply(-energy_.gradient(), step_);
  return true;
}

double MapDescent::expectedDrop(double length) const {
  const core::Graph& graph = energy_.pattern().graph;
  double curvature = 0;
  for (std::size_t n = 0; n < energy_.pattern().rows(); ++n) {
    curvature += step_.segment<2>(2 * n).dot(core::rowProduct<double, 2>(
        graph, energy_.hessian(), step_, graph.first[n], graph.first[n + 1]));
  }
  return -length * (energy_.gradient().dot(step_) + 0.5 * length * curvature);
}

void MapDescent::adaptShift(double length, double ratio, bool may_fall) {
  constexpr double kShort = 0.3, kPoor = 0.25, kGood = 0.75, kFall = 5;
  if (length < kShort) {
    shift_ *= 4;
  } else if (ratio < kPoor) {
    shift_ *= 3;
  } else if (length == 1 && ratio > kGood && may_fall) {
    shift_ /= kFall;
  }
}

bool MapDescent::iterate(FaceHessian hessian) {
  constexpr int kMostAttempts = 30, kMostCuts = 25;
  constexpr double kCut = 0.6, kRaise = 4, kLeastRaised = 1e-9;
  constexpr double kSufficient = 5e-5;  // of what the gradient promises
  constexpr double kFree = 1e-3;        // shift that hardly holds a step short
  energy_.evaluate(hessian);
  const double value = energy_.value();
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    if (solve()) {
      const double slope = energy_.gradient().dot(step_);
      double length = 1;
      for (int cut = 0; cut < kMostCuts; ++cut, length *= kCut) {
        const double next = energy_.valueAfter(length * step_);
        if (!(next < value + kSufficient * length * slope)) continue;
        const double shift = shift_;
        adaptShift(length, (value - next) / expectedDrop(length), attempt == 0);
        energy_.move(length * step_);
        held_short_ = length < 1 || (shift_ < shift && shift_ > kFree);
        drop_ = (value - next) / value;
        return true;
      }
    }
    shift_ = std::max(kRaise * shift_, kLeastRaised);
  }
  return false;
}

}  // namespace spherical_springs::mesh
