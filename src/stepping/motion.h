// Particles under way, in the order of a layout.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "spherical_springs/plan.h"
#include "spherical_springs/state.h"
#include "stepping/damped_kick.h"
#include "stepping/forces.h"
#include "stepping/layout.h"
#include "stepping/spring_subset.h"
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

  /// Forces at the present positions for `kick` [s], which has been prepared, then drifts. Nothing
  /// happens where springs may be near places without derivative and `until_near` is set.
  /// @return the energy that damping took out [J], unless springs may be near.
  std::optional<double> kickAndDrift(double kick, const Drifts& drifts, bool until_near);

  /// Forces at the present positions for `kick` [s], which has been prepared, but for those of some
  /// springs.
  /// @return the energy that damping took out [J].
  double kick(double kick, const SpringSubset& left_out);

  using Velocities = std::array<std::vector<double>, 3>;

  /// Positions and velocities at a time, in the order of the layout.
  struct Copy {
    std::vector<Row> positions;
    Velocities velocities;
  };

  const Velocities& velocities() const { return velocities_; }

  /// Whether springs may have been near places without derivative at the last kick.
  bool isNear() const;

  /// Calls `visit(kind, index in the system)` for those springs of a patch.
  template <class Visitor>
  void forEachNearSpring(std::size_t patch, const Visitor& visit) const;

  void copyTo(Copy& copy) const;
  void copyTo(Velocities& copy) const { copy = velocities_; }
  void putBack(const Copy& copy);
  void putBack(const Velocities& copy) { velocities_ = copy; }
  void putBack(std::uint32_t particle, const Copy& copy);

  /// Returns where particles are in the order of the layout, by their indices in the system.
  const std::vector<std::uint32_t>& places() const { return rows_; }

  // Position and velocity of a particle, by its index in the system.
  Vector3 position(std::uint32_t particle) const {
    return Eigen::Map<const Vector3>(positions_[rows_[particle]].values);
  }
  Vector3 angularVelocity(std::uint32_t particle) const {
    return angularVelocity(particle, velocities_);
  }
  Vector3 angularVelocity(std::uint32_t particle, const Velocities& velocities) const {
    const std::uint32_t slot = slots_[particle];
    return {velocities[0][slot], velocities[1][slot], velocities[2][slot]};
  }
  void place(std::uint32_t particle, const Vector3& position, const Vector3& angular_velocity);

  /// As `Damping::fastestRate`, at the present positions; only in a scene with damped springs.
  double fastestRate();

 private:
  Particles particlesOf(const Patch& patch, const std::vector<Row>& positions,
                        std::vector<Row>& moved, const Row* forces);
  template <class Work>
  void forEachPatch(const Work& work);
  const Row* forcesOn(const Patch& patch, Scratch& scratch, NearElements* near);
  bool isNear(std::size_t patch) const;
  bool takeTorques(const SpringSubset& left_out);
  bool undoIfNear();
  static void copyVelocities(const Patch& patch, const Velocities& from, Velocities& to);
  void subtractForces(const Patch& patch, const SpringSubset& springs, Scratch& scratch) const;
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
  std::vector<NearElements> near_;           // of each patch, at the last kick
  std::vector<std::uint32_t> rows_, slots_;  // of each particle
  std::vector<Row> positions_, moved_;
  Velocities velocities_, earlier_velocities_;  // earlier: of patches kicked until one is near
  std::vector<double> inverse_masses_;
  std::vector<double> dissipated_;           // one a patch, only in a scene with damped particles
  ViscousFlows viscous_flows_;               // only in a scene with damped particles
  std::unique_ptr<DampedKick> damped_kick_;  // only in a scene with damped springs
};

template <class Visitor>
void Motion::forEachNearSpring(std::size_t patch, const Visitor& visit) const {
  forEachSort([&](auto sort) {
    for (const std::uint32_t e : near_[patch][sortOf<typename decltype(sort)::type>()]) {
      layout_.forEachSpringOf(sort, layout_.patches()[patch], e, visit);
    }
  });
}

}  // namespace spherical_springs::core
