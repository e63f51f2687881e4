#pragma once

#include <limits>
#include <vector>

#include "relaxation/descent.h"
#include "relaxation/model_solver.h"
#include "relaxation/orientation_guard.h"
#include "relaxation/tangent_energy.h"
#include "relaxation/torque_limit.h"

namespace spherical_springs::core {

/// Judgement of a drop of the energy by the ratio to the drop before it.
enum class Pace {
  near_end,  ///< below 0.005: the model is as good as exact
  good,      ///< below 0.25, or above 1, as where triangles unfold
  poor       ///< from 0.25 to 1
};

/// Newton's method, with the shift of Levenberg and Marquardt where the energy is not as its
/// quadratic model has it, and steps along directions of negative curvature within a radius.
class Newton : public Descent {
 public:
  /// `positions`: where particles are about; `inertia`: as TangentEnergy has it.
  Newton(const System& system, const Points& positions, Eigen::VectorXd inertia = {});

  /// Whether `goOn` may be called.
  bool fits(const System& system) const { return energy_.fits(system); }
  /// Takes a system that fits and differs little, and starts near where the particles are, with all
  /// that has been prepared before.
  void goOn(const System& system, const Points& positions);
  void setTargets(const Points& targets) { energy_.setTargets(targets); }

  /// The torque that may be left, so that no step goes further for nothing. `limit` must live as
  /// long as it is aimed at; null: none, and the excess is infinite.
  void aimAt(const TorqueLimit* limit);

  /// Whether the torque on each particle, in the order of their ids, is within the limit; true
  /// where particles cannot move.
  std::vector<bool> calm() const;

  /// Steps are cut before what `guard` forbids; null: nothing is forbidden.
  void keepOrientation(OrientationGuard* guard) { guard_ = guard; }

  void place(const Points& positions) override;
  bool iterate() override;
  const char* whyStuck() const override;
  Points positions() const override { return energy_.places().positions(); }
  double value() const override { return energy_.energy(); }
  /// Returns the sum of the groups' energies, each in its unit (`TangentEnergy`), which the descent
  /// lowers.
  double scaledValue() const { return energy_.value(); }
  double maxTorque() const override { return energy_.maxTorque(); }
  double excess() const override { return excess_; }

  /// Where the torque vanishes: whether a direction leads down all the same, beyond what rounding
  /// leaves open; if so, goes along it.
  bool leaveSaddle();

 private:
  /// The Hessian of the model: a definite part of the exact one, at first; the tempered one, which
  /// gets past a few folded triangles of a large mesh while the rest goes on; the exact one; or the
  /// exact one with the definite part beside it for the preconditioner, where it has negative
  /// curvature.
  enum class Model { definite, tempered, exact, indefinite };
  enum class Trial { accepted, rejected, exhausted };

  void forgetSteps();
  void evaluate();
  void measureExcess();
  double stiffnessAt(std::size_t free) const;
  double excessAt(std::size_t free, double stiffness) const;
  template <class Stiffness>
  double largestExcess(const Stiffness& stiffness) const;
  ModelMinimum minimum(const Eigen::VectorXd& gradient, double tolerance);
  double tolerance() const;
  void chooseModel(const ModelMinimum& minimum);
  double longestMove(const Eigen::VectorXd& step) const;
  double scaledLength(const Eigen::VectorXd& step) const;
  double scaledGradient() const;
  void goDownward(ModelMinimum& minimum) const;
  void keepInside(Eigen::VectorXd& step);
  double allowedShare(const Eigen::VectorXd& step);
  Trial tryStep(const ModelMinimum& minimum);
  void correct();
  bool creeps();
  void scaleToHere();
  Eigen::VectorXd downwardDirection();
  bool goAlong(const Eigen::VectorXd& direction);

  int threads_;
  TangentEnergy energy_;
  ModelSolver solver_;
  TangentEnergy::Hessian definite_;  // beside the exact one, while the model is indefinite
  Model model_ = Model::definite;
  Eigen::VectorXd scale_;  // stiffness at each free particle, of which the shift is a share
  Eigen::VectorXd hold_;   // shares of the scale that the guard has added
  double shift_ = 0;
  double radius_ = 0;  // that steps stay inside, in their scaled length
  const TorqueLimit* limit_ = nullptr;
  double excess_ = std::numeric_limits<double>::infinity();
  OrientationGuard* guard_ = nullptr;
  int iterations_ = 0;
  int calm_iterations_ = 0;  // since negative curvature
  double earlier_gradient_ = 0;
  double earlier_drop_ = 0;
  Pace pace_ = Pace::good;
  double earlier_value_ = 0;
  bool creeping_ = false;
};

}  // namespace spherical_springs::core
