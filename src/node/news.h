#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>

namespace spherical_springs {

/// Tells ~status and /diagnostics what has happened. For many threads. Telling takes no memory and
/// cannot fail, so that it may follow a change of the scene; a text beyond `kLongest` bytes is cut.
class News {
 public:
  static constexpr std::size_t kLongest = 8192;  ///< [bytes]

  News();

  /// The status is to be published soon.
  void statusChanged() noexcept { status_changed_ = true; }

  /// Whether the status has changed since this was asked last.
  bool takeStatusChange() noexcept { return status_changed_.exchange(false); }

  /// A change, a step or a relaxation is done: samples are to be published once more.
  void sceneChanged() noexcept { ++scene_changes_; }

  /// How often `sceneChanged` has been told.
  std::uint64_t sceneChanges() const noexcept { return scene_changes_; }

  /// "`subject` `what`" is the last thing worth telling a person; the status has changed.
  void tell(std::string_view what, std::string_view subject = "") noexcept;

  /// A request was refused for a number that is not finite.
  void refused(std::string_view reason) noexcept;

  /// The last ~relax ended: `fault` says why it did not converge, and is empty if it did, or if
  /// nothing is left of where it came to.
  void relaxed(std::string_view fault) noexcept;

  struct Facts {
    std::string message;           ///< the last one told
    bool message_is_new = false;   ///< told in the last ten seconds
    std::string refusal;           ///< the reason of one in the last ten seconds, or empty
    unsigned refusals = 0;         ///< so far
    std::string relaxation_fault;  ///< as `relaxed` was told
  };
  Facts facts() const;

 private:
  using Clock = std::chrono::steady_clock;

  std::atomic<bool> status_changed_{true};
  std::atomic<std::uint64_t> scene_changes_{0};

  mutable std::mutex mutex_;  // guards what follows
  std::string message_, refusal_, relaxation_fault_;
  Clock::time_point told_at_, refused_at_;
  unsigned refusals_ = 0;
};

/// Has the status published whether a call succeeds or not.
class StatusChange {
 public:
  explicit StatusChange(News& news) : news_(news) {}
  ~StatusChange() { news_.statusChanged(); }
  StatusChange(const StatusChange&) = delete;
  StatusChange& operator=(const StatusChange&) = delete;

 private:
  News& news_;
};

}  // namespace spherical_springs
