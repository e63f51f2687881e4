#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "stepping/encounters.h"
#include "stepping/motion.h"
#include "stepping/splitting.h"

namespace spherical_springs::core {

/// Whether steps are divided where springs pass places without derivative.
enum class Passing { resolved, ignored };

/// A splitting scheme block by block, several springs at a time. A step that finds no memory for
/// passages leaves all as it was before `advance`; other steps need none that has not been taken
/// when the integrator is made.
class BlockedSplitting : public Integrator {
 public:
  BlockedSplitting(std::shared_ptr<const Plan> plan, const SplittingScheme& scheme,
                   double time_step, Passing passing = Passing::resolved,
                   const StepKernels& kernels = stepKernels());
  void take(const State& state) override;
  void advance(std::uint64_t steps) override;
  void give(State& state) const override;

 private:
  void prepare(const SplittingScheme& scheme);
  void advanceAtOnce(std::uint64_t steps);
  void advanceByRates(std::uint64_t steps);
  void stepOnce(const SplittingScheme& scheme, double next_drift);
  bool stepFarFromAll(const SplittingScheme& scheme, double next_drift);
  void stepThroughEncounters(const SplittingScheme& scheme, double next_drift);
  double passFirstKick(const SplittingScheme& scheme);
  std::optional<double> passOtherKicks(const SplittingScheme& scheme);
  void driftPast(const SplittingScheme& scheme, std::size_t stage);
  void countPassages();

  const SplittingScheme& scheme_;
  double time_step_;
  bool depends_on_rates_;  // of damped springs
  Motion motion_;
  const bool resolves_passages_;
  const std::shared_ptr<const Plan> plan_;
  std::unique_ptr<Encounters> encounters_;  // once any spring has been near
  bool was_near_ = false;                   // a place without derivative in the last step
  Progress progress_;
  Motion::Copy before_, drifted_;  // before `advance`; after the first drift of a step
  Motion::Velocities entered_;     // before the first kick of a step
};

}  // namespace spherical_springs::core
