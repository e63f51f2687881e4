// The kick of `Damping` in a scene with damped springs, patch by patch, several springs at a time.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "spherical_springs/system.h"
#include "stepping/damper_layout.h"
#include "stepping/damper_sweep.h"
#include "stepping/layout.h"
#include "stepping/scratch.h"
#include "stepping/step_kernels.h"
#include "stepping/viscous_flows.h"

namespace spherical_springs::core {

/// Velocities of the particles that are being stepped, in the order of a layout.
struct Velocities {
  std::array<double*, 3> components;  ///< arrays over slots [rad/s]
  const double* inverse_masses;       ///< array over slots [1/kg]
  const Row* positions;               ///< array over rows
};

class DampedKick {
 public:
  DampedKick(const System& system, const Layout& layout, const DampingKernels& kernels,
             int threads);

  /// Takes the gradients of the springs of a patch whose rows begin at `positions`.
  void takeGradients(std::size_t patch, const Row* positions);

  /// Takes the torques of the forces on the particles of a patch, and their velocities.
  void takeTorques(std::size_t patch, const Particles& particles);

  /// As `Damping::fastestRate` [1/s], at the gradients taken.
  double fastestRate() const;

  /// Takes the memory that kicks over `duration` [s] need, so that none of them can fail.
  void prepare(double duration);

  /// For a duration that has been prepared, as `Damping::kick` under what was taken of all patches.
  /// Where the damping is fast dampers act in another order, which that of the springs in the scene
  /// does not change.
  double kick(double duration, const Velocities& velocities);

 private:
  double kickBySeries(double duration, int terms, const Velocities& velocities);
  double addTerm(std::size_t patch, const SeriesTerm& term, const Velocities& velocities);
  double kickByTorques(double duration, const Velocities& velocities);
  double kickBySweeps(double duration, const Velocities& velocities);
  double sweepThere(std::size_t patch, const ViscousFlow* viscous);
  double sweepBack(std::size_t patch, const ViscousFlow* viscous);
  double dampViscously(const Patch& patch, const ViscousFlow* viscous);
  void applyTorques(const Patch& patch, double duration, const double* inverse_masses);
  void giveVelocities(const Patch& patch, const Velocities& velocities) const;

  template <class Work>
  double sumOverPatches(const Work& work);

  const System& system_;
  const Layout& layout_;
  const DampingKernels& kernels_;
  const int threads_;
  const bool own_;
  const DamperLayout dampers_;
  PerKind<DamperGradients> gradients_;
  DamperSweep sweep_;
  ViscousFlows viscous_flows_;
  std::vector<double> viscous_;     // coefficients, over slots
  std::vector<Row> torques_;        // over slots
  std::vector<Row> last_, next_;    // velocities or terms of their series
  std::vector<double> rates_;       // the fastest of each patch
  std::vector<double> dissipated_;  // of each patch
  ScratchPool scratches_;
};

}  // namespace spherical_springs::core
