#pragma once

#include "spherical_springs/integrator.h"

namespace spherical_springs::core {

/// Steps the state as it is.
class PlainIntegrator : public Integrator {
 public:
  void take(const State& state) override { state_ = state; }
  void advance(std::uint64_t steps) override {
    for (; steps > 0; --steps) stepOnce(state_);
  }
  void give(State& state) const override { state = state_; }

 private:
  virtual void stepOnce(State& state) = 0;

  State state_;
};

}  // namespace spherical_springs::core
