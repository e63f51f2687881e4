// Relaxations that a caller need not wait for to the end.
#pragma once

#include <functional>
#include <memory>
#include <thread>

#include "spherical_springs/relaxation.h"

namespace spherical_springs::core {

/// Relaxes on a thread of its own, which is left to end by itself where its relaxation is
/// cancelled: an iteration of a large scene may take long. For one caller at a time.
class CancellableRelaxer {
 public:
  CancellableRelaxer() = default;
  ~CancellableRelaxer();
  CancellableRelaxer(const CancellableRelaxer&) = delete;
  CancellableRelaxer& operator=(const CancellableRelaxer&) = delete;

  struct Outcome {
    RelaxationResult result;
    bool cancelled;
  };

  /// Called every 20 ms with the best so far, which is null before the first iteration, and the
  /// fraction of the way; returning false cancels.
  using Watch =
      std::function<bool(const std::shared_ptr<const RelaxationResult>& best, double fraction)>;

  /// Relaxes as `Relaxer::relax`, or ends with the best so far where it is cancelled. Waits for the
  /// thread of an earlier relaxation that was cancelled.
  /// @throw what `Relaxer::relax` throws.
  Outcome relax(std::shared_ptr<const System> system, Points start,
                const RelaxationOptions& options, const Watch& watch);

  /// Lets go of what is prepared for further relaxations, unless the thread of one that was
  /// cancelled still uses it.
  void forget();

 private:
  struct Work;

  bool awaitLast(const Watch& watch);
  static Outcome await(Work& work, const Watch& watch);

  Relaxer relaxer_;
  std::shared_ptr<Work> last_;
  std::thread thread_;
};

}  // namespace spherical_springs::core
