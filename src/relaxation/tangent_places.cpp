#include "relaxation/tangent_places.h"

#include "base/parallel.h"

namespace spherical_springs::core {
namespace {

/// The frame turned as little as leaves it tangent at `p`.
TangentFrame carried(const TangentFrame& frame, const Vector3& p) {
  const Vector3 x = frame.col(0);
  TangentFrame result;
  result.col(0) = (x - x.dot(p) * p).normalized();
  result.col(1) = p.cross(result.col(0));
  return result;
}

}  // namespace

void TangentPlaces::place(const Points& positions) {
  places_.resize(order_.particles.size());
  parallelFor(order_.particles.size(), threads_, [&](std::ptrdiff_t n) {
    const Vector3 point = positions.col(order_.particles[n]);
    places_[n] = {tangentFrame(point), point};
  });
}

void TangentPlaces::carry(const Points& positions) {
  parallelFor(order_.particles.size(), threads_, [&](std::ptrdiff_t n) {
    const Vector3 point = positions.col(order_.particles[n]);
    places_[n] = {carried(places_[n].frame, point), point};
  });
}

void TangentPlaces::move(const Eigen::VectorXd& step) {
  parallelFor(freeCount(), threads_, [&](std::ptrdiff_t n) {
    if (step.segment<2>(2 * n).isZero(0)) return;
    const auto& [frame, from] = places_[n];
    const Vector3 point = (from + frame * step.segment<2>(2 * n)).normalized();
    places_[n] = {carried(frame, point), point};
  });
}

// A rotation vector w moves p by w x p, whose parts along x and y = p x x are w.y and -w.x.
template <class Real>
std::vector<Eigen::Matrix<Real, 2, 3>> TangentPlaces::rotations() const {
  std::vector<Eigen::Matrix<Real, 2, 3>> result(freeCount());
  parallelFor(freeCount(), threads_, [&](std::ptrdiff_t n) {
    const TangentFrame& frame = places_[n].frame;
    result[n].row(0) = frame.col(1).template cast<Real>();
    result[n].row(1) = -frame.col(0).template cast<Real>();
  });
  return result;
}

template std::vector<Eigen::Matrix<float, 2, 3>> TangentPlaces::rotations() const;
template std::vector<Eigen::Matrix<double, 2, 3>> TangentPlaces::rotations() const;

Points TangentPlaces::positions() const {
  Points result(3, order_.particles.size());
  parallelFor(order_.particles.size(), threads_,
              [&](std::ptrdiff_t n) { result.col(order_.particles[n]) = places_[n].point; });
  return result;
}

Points TangentPlaces::moves(const Eigen::VectorXd& step) const {
  Points result = Points::Zero(3, static_cast<Eigen::Index>(order_.particles.size()));
  for (std::size_t n = 0; n < freeCount(); ++n) {
    result.col(order_.particles[n]) = places_[n].frame * step.segment<2>(2 * n);
  }
  return result;
}

}  // namespace spherical_springs::core
