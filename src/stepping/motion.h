// Particles under way, in the order of a layout.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "../kernels/step_kernels.h"
#include "layout.h"
#include "spherical_springs/state.h"
#include "spherical_springs/system.h"

namespace spherical_springs::core {

class Motion {
 public:
  Motion(std::shared_ptr<const System> system, std::shared_ptr<const Layout> layout,
         const StepKernels& kernels);

  void take(const State& state);
  void give(State& state) const;  ///< positions and velocities, back in the order of ids

  /// Particles on great circles at constant angular velocity, for `duration` [s].
  void drift(double duration);

  using Drifts = std::array<double, 2>;  ///< one after the other [s]

  /// Forces at the present positions for `kick` [s], then drifts.
  /// @return the energy that damping took out [J].
  double kickAndDrift(double kick, const Drifts& drifts);

  std::size_t bytes() const;

 private:
  struct Scratch {
    std::vector<Row> forces;
    std::vector<std::uint32_t> hard;
  };

  /// Of the viscous damping of all particles over a kick's duration.
  struct Viscous {
    double duration;
    std::vector<double> decay, gain, taken[3];
  };

  const Viscous& viscousFor(double duration);
  Particles particlesOf(const Patch& patch, const std::vector<Row>& positions,
                        std::vector<Row>& moved, const Row* forces);
  double kickAndDriftPatch(const Patch& patch, double kick, const Viscous* viscous,
                           const Drifts& drifts);
  void fetch(const Patch& patch) const;
  void welcomeGuests(const Patch& patch);
  void addForces(const Patch& patch, Scratch& scratch) const;
  template <int kSort>
  void addElements(const Patch& patch, Scratch& scratch) const;
  template <int kEnds, int kSprings>
  void addExactly(const Patch& patch, const ElementGroup<kEnds, kSprings>& group,
                  std::uint32_t lane, Scratch& scratch) const;
  void addExactly(const Patch& patch, const OrientedArcs& group, std::uint32_t lane,
                  Scratch& scratch) const;
  template <class Spring>
  void addExactly(const Patch& patch, const Spring& spring,
                  const std::array<std::uint32_t, Spring::kParticles>& rows,
                  Scratch& scratch) const;

  std::shared_ptr<const System> system_;
  std::shared_ptr<const Layout> layout_;
  const StepKernels& kernels_;
  int threads_;
  std::vector<Row> positions_, moved_;
  std::array<std::vector<double>, 3> velocities_;
  std::vector<double> inverse_masses_;
  std::vector<Viscous> viscous_;    // one a duration; only in a scene with damped particles
  std::vector<double> dissipated_;  // likewise, one a patch
};

}  // namespace spherical_springs::core
