// Particles under way, in the order of a layout.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "spherical_springs/plan.h"
#include "spherical_springs/state.h"
#include "stepping/damped_kick.h"
#include "stepping/forces.h"
#include "stepping/layout.h"
#include "stepping/step_kernels.h"
#include "stepping/viscous_flows.h"

namespace spherical_springs::core {

class Motion {
 public:
  Motion(std::shared_ptr<const Plan> plan, const StepKernels& kernels);

  void take(const State& state);
  void give(State& state) const;  ///< positions and velocities, back in the order of ids

  /// Particles on great circles at constant angular velocity, for `duration` [s].
  void drift(double duration);

  using Drifts = std::array<double, 2>;  ///< one after the other [s]

  /// Takes the memory that kicks over `kick` [s] need, so that none of them can fail.
  void prepareKick(double kick);

  /// Forces at the present positions for `kick` [s], which has been prepared, then drifts.
  /// @return the energy that damping took out [J].
  double kickAndDrift(double kick, const Drifts& drifts);

  /// As `Damping::fastestRate`, at the present positions; only in a scene with damped springs.
  double fastestRate();

 private:
  Particles particlesOf(const Patch& patch, const std::vector<Row>& positions,
                        std::vector<Row>& moved, const Row* forces);
  template <class Work>
  void forEachPatch(const Work& work);
  const Row* forcesOn(const Patch& patch, Scratch& scratch);
  double kickPatch(const Particles& particles, const Patch& patch, double kick,
                   const ViscousFlow* viscous) const;
  double kickUnderSpringDamping(double kick);
  void driftPatch(Particles particles, const Drifts& drifts) const;
  void fetch(const Patch& patch) const;

  const std::shared_ptr<const Plan> plan_;
  const System& system_;
  const Layout& layout_;
  const StepKernels& kernels_;
  Forces forces_;
  int threads_;
  ScratchPool scratches_;
  std::vector<Row> positions_, moved_;
  std::array<std::vector<double>, 3> velocities_;
  std::vector<double> inverse_masses_;
  std::vector<double> dissipated_;           // one a patch, only in a scene with damped particles
  ViscousFlows viscous_flows_;               // only in a scene with damped particles
  std::unique_ptr<DampedKick> damped_kick_;  // only in a scene with damped springs
};

}  // namespace spherical_springs::core
