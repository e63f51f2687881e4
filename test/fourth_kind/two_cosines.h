// A kind of spring that exists in this test alone.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "spherical_springs/range.h"
#include "spherical_springs/springs/condition.h"

namespace spherical_springs::core {

/// C = cosine of the angle of the first two particles + twice that of the last two - rest_sum. It
/// joins four particles, and its ends cannot be turned round.
struct TwoCosinesSpring {
  static constexpr std::size_t kParticles = 4;
  static constexpr std::size_t kCorners = 2;
  static constexpr const char* kTable = "two_cosines_springs";
  static constexpr const char* kName = "two-cosines spring";

  std::array<std::uint32_t, kParticles> particles{};
  double rest_sum = 0;
  double stiffness = 0;  ///< [J]
  double damping = 0;    ///< [N m s]
  bool at_rest = false;

  double restValue() const { return rest_sum; }

  template <class Spring, class Visitor>
  static void visitFields(Spring& spring, Visitor&& visit) {
    visit("rest_sum", spring.rest_sum, Range{-3, 3, "-3 to 3"});
    visit("stiffness", spring.stiffness, Range{kSmallest, kLargest, "above 0 [J]"});
    visit("damping", spring.damping, Range{0, kLargest, "0 to 1e30 [N m s]"});
  }
};

using FourPoints = std::array<Vector3, 4>;

inline double sumOfCosines(const FourPoints& p) { return p[0].dot(p[1]) + 2 * p[2].dot(p[3]); }

inline void rest(TwoCosinesSpring& spring, const FourPoints& p) {
  spring.rest_sum = sumOfCosines(p);
}

constexpr double distanceToUndefined(const TwoCosinesSpring&, const FourPoints&) {
  return std::numeric_limits<double>::infinity();
}

inline Condition<4> condition(const TwoCosinesSpring& spring, const FourPoints& p) {
  const Vector3 first = p[0].cross(p[1]), last = 2 * p[2].cross(p[3]);
  return {sumOfCosines(p) - spring.rest_sum, {first, -first, last, -last}};
}

inline TangentCondition<4> tangentCondition(const TwoCosinesSpring& spring, const FourPoints& p,
                                            const std::array<TangentFrame, 4>& frames,
                                            Curvature curvature) {
  TangentCondition<4> result;
  result.value = sumOfCosines(p) - spring.rest_sum;
  for (auto& row : result.hessian) row.fill(Matrix2(Eigen::Matrix2d::Zero()));
  for (int i = 0; i < 4; ++i) {
    const int other = i ^ 1;  // 0 and 1, 2 and 3
    const double factor = i < 2 ? 1 : 2;
    result.gradient[i] = factor * frames[i].transpose() * p[other];
    if (curvature == Curvature::definite) continue;
    result.hessian[i][i] = -factor * p[i].dot(p[other]) * Eigen::Matrix2d::Identity();
    result.hessian[i][other] = factor * frames[i].transpose() * frames[other];
  }
  return result;
}

}  // namespace spherical_springs::core
