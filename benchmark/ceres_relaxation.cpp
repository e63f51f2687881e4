#include "ceres_relaxation.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <ceres/sphere_manifold.h>

#include <cmath>

namespace benchmark_scenes {
namespace {

using namespace spherical_springs::core;  // NOLINT: names of the core throughout

template <class T>
using Vector = Eigen::Matrix<T, 3, 1>;

template <class T>
using Point = Eigen::Map<const Vector<T>>;

template <class T>
Vector3 valueOf(const Vector<T>& vector) {
  if constexpr (std::is_same_v<T, double>) {
    return vector;
  } else {
    return {vector[0].a, vector[1].a, vector[2].a};
  }
}

/// a x b of unit vectors, without cancellation.
template <class T>
Vector<T> cross(const Vector<T>& a, const Vector<T>& b) {
  return T(0.5) * Vector<T>(a - b).cross(Vector<T>(a + b));
}

/// At coinciding or antipodal points the norm of a x b has no derivative: there it is the component
/// along the core's fixed axis, which gives the gradient of the core.
template <class T>
T angle(const Vector<T>& a, const Vector<T>& b) {
  using std::atan2;
  using std::sqrt;
  const Vector<T> normal = cross(a, b);
  const T squared_sine = normal.squaredNorm();
  if (squared_sine > T(0)) return atan2(sqrt(squared_sine), a.dot(b));
  const Vector<T> axis = perpendicular(valueOf(a)).template cast<T>();
  return atan2(normal.dot(axis), a.dot(b));
}

template <class T>
T tripleProduct(const Vector<T>& a, const Vector<T>& b, const Vector<T>& c) {
  return a.dot(Vector<T>(b - a).cross(Vector<T>(c - a)));
}

struct AngleResidual {
  AngleSpring spring;
  using Cost = ceres::AutoDiffCostFunction<AngleResidual, 1, 3, 3>;

  template <class T>
  bool operator()(const T* a, const T* b, T* residual) const {
    const Vector<T> pa = Point<T>(a), pb = Point<T>(b);
    *residual = std::sqrt(spring.stiffness) * (angle(pa, pb) - spring.rest_angle);
    return true;
  }
};

struct SolidAngleResidual {
  SolidAngleSpring spring;
  using Cost = ceres::AutoDiffCostFunction<SolidAngleResidual, 1, 3, 3, 3>;

  /// With an antipodal pair the area is undefined: it counts as 0, without a gradient, as in the
  /// core.
  template <class T>
  bool operator()(const T* a, const T* b, const T* c, T* residual) const {
    using std::atan2;
    const Vector<T> pa = Point<T>(a), pb = Point<T>(b), pc = Point<T>(c);
    const T triple_product = tripleProduct(pa, pb, pc);
    const T denominator = T(1) + pa.dot(pb) + pb.dot(pc) + pc.dot(pa);
    T value = T(-spring.rest_solid_angle);
    if (triple_product * triple_product + denominator * denominator > T(0)) {
      value += T(2) * atan2(triple_product, denominator);
    }
    if (value > T(2 * kPi)) value -= T(4 * kPi);
    if (value < T(-2 * kPi)) value += T(4 * kPi);
    *residual = std::sqrt(spring.stiffness) * value;
    return true;
  }
};

struct OrientedAngleResidual {
  OrientedAngleSpring spring;
  using Cost = ceres::AutoDiffCostFunction<OrientedAngleResidual, 1, 3, 3, 3>;

  template <class T>
  bool operator()(const T* a, const T* b, const T* c, T* residual) const {
    const Vector<T> pa = Point<T>(a), pb = Point<T>(b), pc = Point<T>(c);
    *residual = std::sqrt(spring.stiffness) *
                (sign(tripleProduct(pa, pb, pc)) * angle(pa, pb) - spring.rest_angle);
    return true;
  }

 private:
  template <class T>
  T sign(const T& triple_product) const {
    const double width = effectiveWidth(spring);
    if (triple_product >= T(width)) return T(1);
    if (triple_product <= T(-width)) return T(-1);
    const T u = triple_product / width;
    return u * (T(15) - T(10) * u * u + T(3) * u * u * u * u) / T(8);
  }
};

template <class Residual, class Spring>
void addResiduals(const System& system, double* positions, ceres::Problem& problem) {
  for (const Spring& spring : system.springs<Spring>()) {
    std::vector<double*> blocks;
    for (const std::uint32_t particle : spring.particles)
      blocks.push_back(positions + 3 * particle);
    problem.AddResidualBlock(new typename Residual::Cost(new Residual{spring}), nullptr, blocks);
  }
}

void constrain(const System& system, double* positions, ceres::Manifold& sphere,
               ceres::Problem& problem) {
  for (Eigen::Index i = 0; i < system.particleCount(); ++i) {
    double* const position = positions + 3 * i;
    if (!problem.HasParameterBlock(position)) continue;
    problem.SetManifold(position, &sphere);
    if (system.pinned(i)) problem.SetParameterBlockConstant(position);
  }
}

/// Ceres compares its gradient tolerance with the gradient in the manifold's coordinates, taken
/// back into space: this factor times the gradient (in version 2.1, whose coordinates are twice the
/// angle, a quarter).
double shareOfGradient(const ceres::Manifold& sphere) {
  const Vector3 point = Vector3::UnitZ();
  Eigen::Matrix<double, 3, 2, Eigen::RowMajor> jacobian;
  sphere.PlusJacobian(point.data(), jacobian.data());
  return jacobian.col(0).squaredNorm();
}

ceres::Solver::Options options(double tolerance, double max_time) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.num_threads = 2;
  options.max_num_iterations = 200;
  options.max_solver_time_in_seconds = max_time;
  options.gradient_tolerance = tolerance;
  options.function_tolerance = 0;
  options.parameter_tolerance = 0;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace

CeresResult relaxByCeres(const System& system, const Points& positions, double tolerance,
                         double max_time) {
  CeresResult result;
  result.positions = positions;
  ceres::SphereManifold<3> sphere;
  ceres::Problem::Options ownership;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  double* const places = result.positions.data();
  addResiduals<AngleResidual, AngleSpring>(system, places, problem);
  addResiduals<SolidAngleResidual, SolidAngleSpring>(system, places, problem);
  addResiduals<OrientedAngleResidual, OrientedAngleSpring>(system, places, problem);
  constrain(system, places, sphere, problem);

  ceres::Solver::Summary summary;
  ceres::Solve(options(tolerance * shareOfGradient(sphere), max_time), &problem, &summary);
  result.positions.colwise().normalize();
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  result.iterations = static_cast<int>(summary.iterations.size()) - 1;
  result.seconds = summary.total_time_in_seconds;
  result.message = summary.message;
  return result;
}

}  // namespace benchmark_scenes
