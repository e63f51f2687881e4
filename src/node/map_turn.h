#pragma once

#include <mutex>
#include <stdexcept>

namespace spherical_springs {

/// Lets one mesh be mapped at a time, and others end that. For many threads.
class MapTurn {
 public:
  /// Marks a mapping as under way for its own lifetime.
  class Busy {
   public:
    /// @throw std::runtime_error while another is under way, and when the node ends.
    explicit Busy(MapTurn& turn) : turn_(turn) {
      const std::lock_guard<std::mutex> lock(turn_.mutex_);
      if (turn_.closed_) throw std::runtime_error("the node is shutting down");
      if (turn_.busy_) {
        throw std::runtime_error("a ~map_mesh is under way; wait for it or end it by ~cancel");
      }
      turn_.busy_ = true;
      turn_.cancelled_ = false;
    }
    ~Busy() {
      const std::lock_guard<std::mutex> lock(turn_.mutex_);
      turn_.busy_ = false;
    }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;

   private:
    MapTurn& turn_;
  };

  /// Ends the mapping under way with its best map so far.
  /// @return whether there was one.
  bool cancel() {
    const std::lock_guard<std::mutex> lock(mutex_);
    cancelled_ = true;
    return busy_;
  }

  /// Ends the mapping under way, and refuses every further one.
  void close() {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = cancelled_ = true;
  }

  /// Whether the mapping under way is to end.
  bool cancelled() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return cancelled_;
  }

 private:
  mutable std::mutex mutex_;  // guards all
  bool busy_ = false, cancelled_ = false, closed_ = false;
};

}  // namespace spherical_springs
