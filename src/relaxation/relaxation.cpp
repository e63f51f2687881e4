#include "spherical_springs/relaxation.h"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "relaxation/freedom.h"
#include "relaxation/global_search.h"
#include "relaxation/minimum_search.h"
#include "relaxation/newton.h"
#include "relaxation/torque_limit.h"
#include "spherical_springs/range.h"

namespace spherical_springs::core {

RelaxationMethod relaxationMethod(const std::string& name) {
  if (name.empty() || name == "newton") return RelaxationMethod::newton;
  if (name == "dynamics") return RelaxationMethod::dynamics;
  if (name == "fire") return RelaxationMethod::fire;
  if (name == "global") return RelaxationMethod::global;
  throw std::invalid_argument("method is " + quoted(name) +
                              "; allowed: newton (the default), dynamics, fire, global");
}

void requireValid(const RelaxationOptions& options) {
  requireInside(
      Range{0, kLargest, "0 (1e-9 of the stiffness that each particle feels) to 1e30 [N m]"},
      options.tolerance, "tolerance");
  requireInside(Range{0, kLargest, "0 (no limit) to 1e30 [s]"}, options.max_time, "max_time");
  if (options.method != RelaxationMethod::global) return;
  if (options.starts == 0) throw std::invalid_argument("starts is 0; allowed: 1 and more");
  if (options.keep_orientation) {
    throw std::invalid_argument(
        "keep_orientation is true; allowed: false with the method global, which jumps from place "
        "to place");
  }
}

RelaxationResult unrelaxed(const System& system, const Points& positions) {
  RelaxationResult result;
  result.positions = positions;
  result.energy_before = result.energy_after = system.potential(positions).total();
  result.max_torque = largestTorque(system, positions);
  return result;
}

Relaxer::Relaxer() = default;
Relaxer::~Relaxer() = default;

void Relaxer::forget() {
  newton_.reset();
  last_end_ = Points();
}

RelaxationResult Relaxer::relax(const System& system, const Points& positions,
                                const RelaxationOptions& options) {
  requireValid(options);
  if (options.method == RelaxationMethod::global) {
    forget();
    RelaxationResult result = GlobalSearch(system, positions, options).run();
    judge(system, result);
    return result;
  }
  // Only from the very place where the last one ended, so that results do not depend on what was
  // relaxed before from elsewhere.
  const bool goes_on = newton_ && newton_->fits(system) && positions == last_end_;
  // Kept only from a relaxation that has come to its end.
  std::unique_ptr<Newton> newton = std::move(newton_);
  if (goes_on) {
    newton->goOn(system, positions);
  } else {
    newton = std::make_unique<Newton>(system, positions);
  }
  RelaxationResult result = MinimumSearch(system, positions, options, *newton, goes_on).run();
  if (options.method == RelaxationMethod::newton) {
    last_end_ = Points(result.positions);
    newton_ = std::move(newton);
  }
  judge(system, result);
  return result;
}

RelaxationResult relax(const System& system, const Points& positions,
                       const RelaxationOptions& options) {
  return Relaxer().relax(system, positions, options);
}

}  // namespace spherical_springs::core
