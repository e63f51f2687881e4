#pragma once

#include <utility>

#include "spherical_springs/integrator.h"

namespace spherical_springs::core {

/// Steps the state as it is, all steps of a call or, where one throws, none.
class PlainIntegrator : public Integrator {
 public:
  void take(const State& state) override { state_ = state; }
  void advance(std::uint64_t steps) override {
    State next = state_;
    for (; steps > 0; --steps) stepOnce(next);
    std::swap(state_, next);
  }
  void give(State& state) const override { state = state_; }

 private:
  virtual void stepOnce(State& state) = 0;

  State state_;
};

}  // namespace spherical_springs::core
