#include "node/news.h"

namespace spherical_springs {
namespace {

/// Appends as much as the memory that `text` has can take.
void append(std::string_view more, std::string& text) {
  text.append(more.substr(0, text.capacity() - text.size()));
}

void replace(std::string_view by, std::string& text) {
  text.clear();
  append(by, text);
}

}  // namespace

News::News() {
  for (std::string* text : {&message_, &refusal_, &relaxation_fault_}) text->reserve(kLongest);
}

void News::tell(std::string_view what, std::string_view subject) noexcept {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    replace(subject, message_);
    append(what, message_);
    told_at_ = Clock::now();
  }
  statusChanged();
}

void News::refused(std::string_view reason) noexcept {
  const std::lock_guard<std::mutex> lock(mutex_);
  replace(reason, refusal_);
  refused_at_ = Clock::now();
  ++refusals_;
}

void News::relaxed(std::string_view fault) noexcept {
  const std::lock_guard<std::mutex> lock(mutex_);
  replace(fault, relaxation_fault_);
}

News::Facts News::facts() const {
  constexpr std::chrono::seconds kRemembered(10);
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto now = Clock::now();
  const bool told_lately = !message_.empty() && now - told_at_ < kRemembered;
  const bool refused_lately = refusals_ > 0 && now - refused_at_ < kRemembered;
  return {message_, told_lately, refused_lately ? refusal_ : "", refusals_, relaxation_fault_};
}

}  // namespace spherical_springs
