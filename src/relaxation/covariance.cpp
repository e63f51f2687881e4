#include "spherical_springs/covariance.h"

#include <Eigen/Dense>
#include <stdexcept>
#include <string>
#include <utility>

#include "linear/multifrontal_cholesky.h"
#include "relaxation/free_groups.h"
#include "relaxation/tangent_energy.h"
#include "spherical_springs/range.h"

namespace spherical_springs::core {
namespace {

constexpr double kMostWork = 3e10;  // multiplications; seconds
const char* const kNotAtMinimum = "the scene is not at a minimum of the energy: ";

std::string named(const System& system, std::size_t particle) {
  return "particle " + std::to_string(system.particleId(particle));
}

/// Orthonormal columns that span those of a matrix of a rank.
Eigen::MatrixXd rangeOf(const Eigen::MatrixXd& matrix, Eigen::Index rank) {
  if (rank == 0) return Eigen::MatrixXd(matrix.rows(), 0);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix);
  return qr.householderQ() * Eigen::MatrixXd::Identity(matrix.rows(), rank);
}

/// The inverse of the Hessian on the complement of what is left open.
class InverseHessian {
 public:
  InverseHessian(const System& system, const Points& positions);

  /// Its block at a free particle, in the scene's axes.
  Matrix3 at(std::uint32_t particle);

 private:
  void requireRest();
  double stiffnessAt(std::size_t free) const;
  void findOpen(const Points& positions);
  void hold(std::size_t group, TangentEnergy::Hessian& values) const;
  void project(std::size_t group, Eigen::VectorXd& vector) const;

  const System& system_;
  TangentEnergy energy_;
  MultifrontalCholesky cholesky_;
  const FreeGroups groups_;
  std::vector<Eigen::MatrixXd> open_;                // orthonormal moves of each group's unknowns
  std::vector<std::vector<Eigen::Index>> unknowns_;  // of each group
  std::vector<std::size_t> group_of_;                // of each free particle
};

InverseHessian::InverseHessian(const System& system, const Points& positions)
    : system_(system),
      energy_(system, positions),
      cholesky_(energy_.pattern(), system.threads()),
      groups_(system),
      group_of_(positions.cols()) {
  if (cholesky_.work() > kMostWork) {
    throw std::invalid_argument("the springs join too many particles: their Hessian would take " +
                                toText(cholesky_.work()) +
                                " multiplications; allowed: " + toText(kMostWork));
  }
  energy_.place(positions);
  requireRest();
  energy_.evaluate(Curvature::exact);
  findOpen(positions);
  TangentEnergy::Hessian held = energy_.hessian();
  for (std::size_t g = 0; g < groups_.count(); ++g) hold(g, held);
  if (!cholesky_.refresh(held)) {
    throw std::invalid_argument(kNotAtMinimum + std::string("it falls in some direction, or stays "
                                                            "as it is in more than rotations"));
  }
}

void InverseHessian::requireRest() {
  constexpr double kLargest = 1e-6;  // [rad] to the minimum, about
  energy_.evaluate(Curvature::definite);
  for (std::size_t f = 0; f < energy_.freeCount(); ++f) {
    const double torque = energy_.gradient().segment<2>(2 * f).norm();
    if (torque <= kLargest * stiffnessAt(f)) continue;
    throw std::invalid_argument(kNotAtMinimum + named(system_, energy_.particle(f)) +
                                " has a torque of " + toText(energy_.unit(f) * torque) +
                                " N m; relax it first");
  }
}

/// Half the trace of a free particle's block of the Hessian.
double InverseHessian::stiffnessAt(std::size_t free) const {
  return 0.5 * energy_.hessian()[energy_.pattern().diagonal[free]].trace();
}

/// The moves of each group by the rotations that it is free to make.
void InverseHessian::findOpen(const Points& positions) {
  const auto rotations = energy_.places().rotations<double>();
  for (std::size_t g = 0; g < groups_.count(); ++g) {
    const auto& particles = groups_.particles(g);
    const Eigen::Matrix3Xd axes = groups_.axes(g, positions);
    Eigen::MatrixXd moves(2 * particles.size(), axes.cols());
    std::vector<Eigen::Index> unknowns;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const Eigen::Index free = energy_.places().order().numbers[particles[i]];
      moves.middleRows<2>(2 * i) = rotations[free] * axes;
      unknowns.insert(unknowns.end(), {2 * free, 2 * free + 1});
    }
    open_.push_back(rangeOf(moves, groups_.rotations(g, positions)));
    unknowns_.push_back(std::move(unknowns));
    for (const std::uint32_t i : particles) group_of_[i] = g;
  }
}

/// Holds as many coordinates of a group as it may turn in ways, those that its rotations move most.
/// The inverse is then the one on the complement of the open moves: a right-hand side without a
/// part along them does not strain the added springs.
void InverseHessian::hold(std::size_t group, TangentEnergy::Hessian& values) const {
  const Eigen::MatrixXd& open = open_[group];
  if (open.cols() == 0) return;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(open.transpose());
  for (Eigen::Index k = 0; k < open.cols(); ++k) {
    const Eigen::Index unknown = unknowns_[group][qr.colsPermutation().indices()[k]];
    auto& block = values[energy_.pattern().diagonal[unknown / 2]];
    block(unknown % 2, unknown % 2) += stiffnessAt(unknown / 2);
  }
}

void InverseHessian::project(std::size_t group, Eigen::VectorXd& vector) const {
  const Eigen::MatrixXd& open = open_[group];
  const auto& unknowns = unknowns_[group];
  Eigen::VectorXd own(open.rows());
  for (Eigen::Index i = 0; i < own.size(); ++i) own[i] = vector[unknowns[i]];
  own -= open * (open.transpose() * own);
  for (Eigen::Index i = 0; i < own.size(); ++i) vector[unknowns[i]] = own[i];
}

Matrix3 InverseHessian::at(std::uint32_t particle) {
  constexpr double kLoosest = 1e10;  // by the inverse of the particle's own stiffness
  const Eigen::Index free = energy_.places().order().numbers[particle];
  const std::size_t group = group_of_[particle];
  Eigen::Matrix2d block;
  for (Eigen::Index k = 0; k < 2; ++k) {
    Eigen::VectorXd side = Eigen::VectorXd::Zero(2 * energy_.freeCount());
    Eigen::VectorXd column(side.size());
    side[2 * free + k] = 1;
    project(group, side);
    cholesky_.apply(side, column);
    project(group, column);
    block.col(k) = column.segment<2>(2 * free);
  }
  if (!(block.trace() * stiffnessAt(free) < kLoosest)) {
    throw std::invalid_argument(named(system_, particle) +
                                " may move by more than rotations of the whole without a change of "
                                "the energy; add springs that hold it");
  }
  const TangentFrame frame = energy_.places()[free].frame;
  const Eigen::Matrix2d symmetric = 0.5 * (block + block.transpose()) / energy_.unit(free);
  return frame * symmetric * frame.transpose();
}

}  // namespace

std::vector<Matrix3> covariances(const System& system, const Points& positions,
                                 const std::vector<std::uint32_t>& particles) {
  for (const std::uint32_t i : particles) {
    if (system.pinned(i) || system.joined(i)) continue;
    throw std::invalid_argument(named(system, i) + " has no spring that holds it");
  }
  InverseHessian inverse(system, positions);
  std::vector<Matrix3> result;
  result.reserve(particles.size());
  for (const std::uint32_t i : particles) {
    result.push_back(system.pinned(i) ? Matrix3(Matrix3::Zero()) : inverse.at(i));
  }
  return result;
}

}  // namespace spherical_springs::core
