// The steps of single vertices of a map.
#include <Eigen/Eigenvalues>
#include <limits>
#include <utility>

#include "maps/map_energy.h"

namespace spherical_springs::mesh {
namespace {

/// Returns a Newton step in which negative curvatures count by their magnitude.
Eigen::Vector2d newtonStep(const RingTerms& terms) {
  constexpr double kLeastCurvature = 1e-6;  // of the other direction's
  const auto& [xx, xy, yy] = terms.hessian;
  Eigen::Matrix2d hessian;
  hessian << xx, xy, xy, yy;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(hessian);
  const Eigen::Array2d curvature = axes.eigenvalues().array().abs();
  const Eigen::Array2d bounded = curvature.max(kLeastCurvature * curvature.maxCoeff());
  const Eigen::Vector2d gradient(terms.gradient[0], terms.gradient[1]);
  return -axes.eigenvectors() *
         ((axes.eigenvectors().transpose() * gradient).array() / bounded).matrix();
}

}  // namespace

RingLists MapEnergy::ringLists() const {
  return {next_.data(),           last_.data(), corner_over_shares_.data(),
          corner_weights_.data(), shape_,       cost_};
}

/// The part of a vertex in the energy of the faces round it.
RingTerms MapEnergy::ownTerms(std::size_t n) const {
  const std::uint32_t begin = first_corner_[n], end = first_corner_[n + 1];
  RingTerms result = {};
  if (kernels_.ring_terms(ringLists(), places_.front().frame.data(), begin, end,
                          places_[n].frame.data(), result)) {
    return result;
  }
  result.value = ownValue(n, places_[n].point);
  for (std::uint32_t s = begin; s < end; ++s) {
    const FaceEnergy::Terms of_face = terms(corners_[s] / 3, FaceHessian::exact);
    const int i = 2 * static_cast<int>(corners_[s] % 3);
    for (int k = 0; k < 2; ++k) result.gradient[k] += of_face.gradient[i + k];
    result.hessian[0] += of_face.hessian(i, i);
    result.hessian[1] += of_face.hessian(i, i + 1);
    result.hessian[2] += of_face.hessian(i + 1, i + 1);
  }
  return result;
}

/// Energy of the faces round a vertex if it were at `point`.
double MapEnergy::ownValue(std::size_t n, const Vector3& point) const {
  const std::uint32_t begin = first_corner_[n], end = first_corner_[n + 1];
  double value;
  if (kernels_.ring_value(ringLists(), rowsHere(), begin, end, point.data(), value)) return value;
  value = 0;
  for (std::uint32_t s = begin; s < end; ++s) {
    FaceEnergy::Corners around = corners(corners_[s] / 3, rowsHere());
    around[corners_[s] % 3] = point;
    value += faceEnergy(corners_[s] / 3).value(around);
  }
  return value;
}

void MapEnergy::moveAlone(std::size_t n) {
  constexpr int kMostCuts = 12;
  const RingTerms terms = ownTerms(n);
  core::TangentPlace& place = places_[n];
  Eigen::Vector2d step = newtonStep(terms);
  for (int cut = 0; cut < kMostCuts; ++cut, step /= 2) {
    const Vector3 point = (place.point + place.frame * step).normalized();
    if (!(ownValue(n, point) < terms.value)) continue;
    place = {core::tangentFrame(point), point};
    return;
  }
}

void MapEnergy::moveEachAlone() {
  order_.apart.forEach(threads_, [&](std::uint32_t block) {
    checkpoint_();
    for (std::uint32_t n = order_.first_node[block]; n < order_.first_node[block + 1]; ++n) {
      moveAlone(n);
    }
  });
}

void MapEnergy::sweep() {
  std::vector<core::TangentPlace> before = places_;
  try {
    moveEachAlone();
    if (valueHere() < std::numeric_limits<double>::infinity()) return;
  } catch (...) {
    places_ = std::move(before);
    throw;
  }
  places_ = std::move(before);  // positive faces round a vertex alone may cover a part twice
}

}  // namespace spherical_springs::mesh
