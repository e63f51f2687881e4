#include "curvature.h"

#include <Spectra/SymEigsSolver.h>

#include <Eigen/CholmodSupport>
#include <Eigen/Eigenvalues>
#include <numeric>

#include "difference_hessian.h"
#include "random.h"
#include "spherical_springs/springs/condition.h"

namespace benchmark_scenes {
namespace {

using namespace spherical_springs::core;  // NOLINT: names of the core throughout

/// For each particle a particle of its component, the same for all of it.
std::vector<std::uint32_t> components(const System& system) {
  const auto graph = neighbours(system);
  std::vector<std::uint32_t> component(graph.size(), UINT32_MAX);
  for (std::uint32_t first = 0; first < graph.size(); ++first) {
    if (component[first] != UINT32_MAX) continue;
    std::vector<std::uint32_t> reached = {first};
    component[first] = first;
    while (!reached.empty()) {
      const std::uint32_t i = reached.back();
      reached.pop_back();
      for (const std::uint32_t j : graph[i]) {
        if (component[j] != UINT32_MAX) continue;
        component[j] = first;
        reached.push_back(j);
      }
    }
  }
  return component;
}

/// Rotation vectors, one column each, that leave pinned particles where they are and turn the free
/// ones by orthonormal amounts. `pinned`, `free`: the sums of 1 - p p^T over those particles.
Eigen::Matrix3Xd rotationVectors(const Eigen::Matrix3d& pinned, const Eigen::Matrix3d& free) {
  constexpr double kNone = 1e-8;
  using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;
  const Solver of_pinned(pinned);
  Eigen::Matrix3d allowed = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Vector3 vector = of_pinned.eigenvectors().col(i);
    if (of_pinned.eigenvalues()[i] < kNone) allowed += vector * vector.transpose();
  }
  const Solver of_free(allowed * free * allowed);
  Eigen::Matrix3Xd vectors(3, 0);
  for (int i = 0; i < 3; ++i) {
    const double squared = of_free.eigenvalues()[i];
    if (squared <= kNone * of_free.eigenvalues()[2]) continue;
    vectors.conservativeResize(3, vectors.cols() + 1);
    vectors.rightCols<1>() = of_free.eigenvectors().col(i) / std::sqrt(squared);
  }
  return vectors;
}

/// Orthonormal columns: the rotations of each component as a whole.
SparseMatrix rotations(const System& system, const Points& positions) {
  const std::vector<std::uint32_t> component = components(system);
  std::vector<Eigen::Matrix3d> pinned(component.size(), Eigen::Matrix3d::Zero()), free = pinned;
  for (std::size_t i = 0; i < component.size(); ++i) {
    const TangentFrame frame = tangentFrame(positions.col(i));
    (system.pinned(i) ? pinned : free)[component[i]] += frame * frame.transpose();
  }
  std::vector<Eigen::Matrix3Xd> vectors(component.size(), Eigen::Matrix3Xd(3, 0));
  std::vector<Eigen::Index> first_column(component.size());
  Eigen::Index columns = 0;
  for (std::size_t i = 0; i < component.size(); ++i) {
    if (component[i] != i) continue;
    vectors[i] = rotationVectors(pinned[i], free[i]);
    first_column[i] = columns;
    columns += vectors[i].cols();
  }
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < component.size(); ++i) {
    if (system.pinned(i)) continue;
    const std::uint32_t c = component[i];
    const Eigen::MatrixXd turns = tangentFrame(positions.col(i)).transpose() * vectors[c];
    for (Eigen::Index j = 0; j < turns.cols(); ++j) {
      for (int k = 0; k < 2; ++k) entries.emplace_back(row + k, first_column[c] + j, turns(k, j));
    }
    row += 2;
  }
  SparseMatrix result(row, columns);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

/// x -> factor (H without rotations) x + shift x, and the rotations at 1 + shift: out of the way.
class Operator {
 public:
  using Scalar = double;

  Operator(const SparseMatrix& hessian, const SparseMatrix& rotations, double factor, double shift)
      : hessian_(hessian), rotations_(rotations), factor_(factor), shift_(shift) {}

  Eigen::Index rows() const { return hessian_.rows(); }
  Eigen::Index cols() const { return hessian_.cols(); }

  void perform_op(const double* in, double* out) const {
    const Eigen::Map<const Eigen::VectorXd> x(in, rows());
    const Eigen::VectorXd turn = rotations_ * (rotations_.transpose() * x);
    const Eigen::VectorXd rest = x - turn;
    const Eigen::VectorXd product = factor_ * (hessian_ * rest);
    Eigen::Map<Eigen::VectorXd>(out, rows()) =
        product - rotations_ * (rotations_.transpose() * product) + turn + shift_ * x;
  }

 private:
  const SparseMatrix& hessian_;
  const SparseMatrix& rotations_;
  double factor_, shift_;
};

struct Extreme {
  double value;
  bool resolved;
};

Extreme extreme(Operator op, Spectra::SortRule which, double tolerance) {
  constexpr Eigen::Index kBasis = 120;
  constexpr Eigen::Index kRestarts = 60;
  Random random(1);
  Eigen::VectorXd start(op.rows());
  for (double& component : start) component = random.between(-1, 1);
  Spectra::SymEigsSolver<Operator> solver(op, 1, std::min(kBasis, op.rows()));
  solver.init(start.data());
  const bool resolved = solver.compute(which, kRestarts, tolerance) == 1;
  return {resolved ? solver.eigenvalues()[0] : 0, resolved};
}

EigenvalueRange byLanczos(const SparseMatrix& hessian, const SparseMatrix& rotations) {
  // The iterations resolve a share of what they look for: shifted, a share of the shift.
  constexpr double kShift = 1e-6;
  EigenvalueRange result;
  result.largest =
      extreme(Operator(hessian, rotations, 1, 0), Spectra::SortRule::LargestAlge, 1e-3).value;
  const Extreme smallest = extreme(Operator(hessian, rotations, 1 / result.largest, kShift),
                                   Spectra::SortRule::SmallestAlge, 1e-2);
  result.smallest = (smallest.value - kShift) * result.largest;
  result.resolved = smallest.resolved;
  return result;
}

EigenvalueRange byAllEigenvalues(const SparseMatrix& hessian, const SparseMatrix& rotations) {
  const Eigen::MatrixXd r = rotations;
  const Eigen::MatrixXd p = Eigen::MatrixXd::Identity(r.rows(), r.rows()) - r * r.transpose();
  const Eigen::MatrixXd h = p * (hessian * p);
  const double beyond = 2 * h.cwiseAbs().rowwise().sum().maxCoeff() + 1;
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
                                     h + beyond * r * r.transpose(), Eigen::EigenvaluesOnly)
                                     .eigenvalues();
  const Eigen::Index others = values.size() - r.cols();
  if (others == 0) return {};
  return {values[0], values[others - 1], true};
}

}  // namespace

EigenvalueRange eigenvalueRange(const System& system, const SparseMatrix& hessian,
                                const Points& positions) {
  constexpr Eigen::Index kFewUnknowns = 1300;
  if (hessian.rows() == 0) return {};
  const SparseMatrix turns = rotations(system, positions);
  return hessian.rows() <= kFewUnknowns ? byAllEigenvalues(hessian, turns)
                                        : byLanczos(hessian, turns);
}

double leastDefiniteShift(const SparseMatrix& hessian) {
  if (hessian.rows() == 0) return 0;
  const Eigen::VectorXd diagonal = hessian.diagonal().cwiseAbs();
  const Eigen::VectorXd scale =
      (diagonal.array() > 0).select(diagonal.cwiseSqrt().cwiseInverse(), 1);
  const SparseMatrix scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
  Eigen::CholmodSupernodalLLT<SparseMatrix> cholesky;
  cholesky.cholmod().print = 0;
  cholesky.analyzePattern(scaled);
  const auto isDefinite = [&](int exponent) {
    cholesky.setShift(std::pow(10, exponent));
    cholesky.factorize(scaled);
    return cholesky.info() == Eigen::Success;
  };
  int too_little = -15, enough = 0;
  while (enough - too_little > 1) {
    const int middle = (too_little + enough) / 2;
    (isDefinite(middle) ? enough : too_little) = middle;
  }
  return std::pow(10, enough);
}

}  // namespace benchmark_scenes
