#pragma once

#include <memory>

#include "relaxation/newton.h"
#include "stepping/plain_integrator.h"

namespace spherical_springs::core {

/// Each step minimises the springs' energy + sum of m d^2 / (2 dt^2), with d the distance from
/// where inertia alone would carry the particle: large steps in the sense of Baraff and Witkin
/// 1998.
class ImplicitEuler : public PlainIntegrator {
 public:
  ImplicitEuler(std::shared_ptr<const System> system, double time_step);

 private:
  void stepOnce(State& state) override;
  void damp(State& state);
  Points inertialPositions(const State& state) const;
  bool minimise(Points& positions, const Points& targets);
  bool descend(const Points& positions, const Points& targets);
  void takeVelocities(const Points& targets, State& state) const;
  void boundEnergy(double most, State& state) const;

  std::shared_ptr<const System> system_;
  double time_step_;
  System::Workspace workspace_;
  Eigen::VectorXd inertia_;
  std::unique_ptr<Newton> newton_;
};

}  // namespace spherical_springs::core
