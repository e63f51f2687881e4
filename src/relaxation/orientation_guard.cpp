#include "relaxation/orientation_guard.h"

#include <algorithm>
#include <array>
#include <vector>

#include "base/parallel.h"

namespace spherical_springs::core {
namespace {

constexpr double kLeastShare = 1e-12;

/// The triple product of three points that move straight: a cubic polynomial of the share of the
/// moves, from the constant on.
using Cubic = std::array<double, 4>;

/// From edges, so that those of small triangles do not cancel.
Cubic tripleProduct(const std::array<Vector3, 3>& points, const std::array<Vector3, 3>& moves) {
  const Vector3 ab = points[1] - points[0], ac = points[2] - points[0];
  const Vector3 ab_rate = moves[1] - moves[0], ac_rate = moves[2] - moves[0];
  const Vector3 cross = ab.cross(ac);
  const Vector3 cross_rate = ab.cross(ac_rate) + ab_rate.cross(ac);
  const Vector3 cross_bend = ab_rate.cross(ac_rate);
  const Vector3 &a = points[0], &rate = moves[0];
  return {a.dot(cross), a.dot(cross_rate) + rate.dot(cross),
          a.dot(cross_bend) + rate.dot(cross_rate), rate.dot(cross_bend)};
}

/// The least of the coefficients of Bernstein's polynomials on [0, end]: a lower bound there.
double lowerBound(const Cubic& c, double end) {
  const double c1 = c[1] * end, c2 = c[2] * end * end, c3 = c[3] * end * end * end;
  return std::min({c[0], c[0] + c1 / 3, c[0] + (2 * c1 + c2) / 3, c[0] + c1 + c2 + c3});
}

/// A share at which the polynomial, positive at 0, is still a tenth of that, and above what
/// rounding of the points makes of it at edges of that length.
double shareInside(Cubic polynomial, double edges) {
  constexpr double kLeft = 0.1, kCut = 0.7;
  constexpr double kRounding = 1e-15;
  if (polynomial[0] < 0) {
    for (double& coefficient : polynomial) coefficient = -coefficient;
  }
  const double kept = std::min(polynomial[0], std::max(kLeft * polynomial[0], kRounding * edges));
  double share = 1;
  while (lowerBound(polynomial, share) < kept) {
    share *= kCut;
    if (share < kLeastShare) return 0;
  }
  return share;
}

}  // namespace

double OrientationGuard::allowedShare(const Points& points, const Points& moves,
                                      Eigen::VectorXd& hold) {
  const auto& springs = system_.springs<SolidAngleSpring>();
  std::vector<double> shares(springs.size(), 1);
  parallelFor(springs.size(), system_.threads(), [&](std::ptrdiff_t s) {
    const auto corners = System::points(springs[s], points);
    const Cubic polynomial = tripleProduct(corners, System::points(springs[s], moves));
    if (polynomial[0] * springs[s].rest_solid_angle < 0 || polynomial[0] == 0) return;
    const double edges = (corners[1] - corners[0]).norm() + (corners[2] - corners[0]).norm();
    shares[s] = shareInside(polynomial, edges);
  });
  double least = 1;
  tightest_.reset();
  for (std::size_t s = 0; s < springs.size(); ++s) {
    if (shares[s] == 1) continue;
    for (const std::uint32_t i : springs[s].particles) {
      hold[i] = std::max(hold[i], 1 / std::max(shares[s], kLeastShare) - 1);
    }
    if (shares[s] < least) {
      least = shares[s];
      tightest_ = s;
    }
  }
  return least;
}

}  // namespace spherical_springs::core
