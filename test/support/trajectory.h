// A scene stepped some way.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "scenes.h"
#include "spherical_springs/integrator.h"
#include "spherical_springs/measures.h"

namespace spherical_springs::core::testing {

inline State stepped(Integrator& integrator, const Scene& scene, int steps) {
  State state = stateOf(scene);
  integrator.take(state);
  integrator.advance(steps);
  integrator.give(state);
  return state;
}

struct Trajectory {
  std::shared_ptr<const Plan> plan;
  State state;

  Trajectory(const Scene& scene, const std::string& method, double time_step, int steps,
             System::Options options = {})
      : plan(std::make_shared<const Plan>(scene, options)), state(stateOf(scene)) {
    const auto integrator = makeIntegrator(plan, integrationMethod(method), time_step);
    for (int i = 0; i < steps; ++i) integrator->step(state);
  }
  const System& system() const { return *plan->system(); }
  double conserved() const { return energies(*plan, state).total() + state.dissipated; }
};

inline void expectSound(const State& state) {
  EXPECT_TRUE(state.positions.allFinite());
  EXPECT_TRUE(state.angular_velocities.allFinite());
  EXPECT_LT(normError(state), 4 * std::numeric_limits<double>::epsilon());
  for (Eigen::Index i = 0; i < state.positions.cols(); ++i) {
    const double along = state.positions.col(i).dot(state.angular_velocities.col(i));
    EXPECT_LT(std::abs(along), 1e-14 * (1 + state.angular_velocities.col(i).norm()));
  }
}

}  // namespace spherical_springs::core::testing
