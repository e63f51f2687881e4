#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

namespace spherical_springs::core {

/// Writes JSON's bits of text by the block.
class TextWriter {
 public:
  explicit TextWriter(std::ostream& out) : out_(out) { text_.reserve(2 * kBlock); }
  ~TextWriter() { flush(); }
  TextWriter(const TextWriter&) = delete;
  TextWriter& operator=(const TextWriter&) = delete;

  TextWriter& operator<<(const char* text) {
    text_ += text;
    if (text_.size() >= kBlock) flush();
    return *this;
  }

  TextWriter& operator<<(bool value) { return *this << (value ? "true" : "false"); }

  TextWriter& operator<<(std::uint32_t value) {
    char digits[kMostDigits];
    char* const end = std::to_chars(digits, digits + kMostDigits, value).ptr;
    text_.append(digits, end);
    return *this;
  }

  /// As short as can be read back to the last bit, and never as an integer, which has no -0.
  TextWriter& operator<<(double value) {
#ifdef __cpp_lib_to_chars  // for floating point, which came later than integers
    char digits[kMostDigits];
    char* const end = std::to_chars(digits, digits + kMostDigits, value).ptr;
    text_.append(digits, end);
    const bool is_integer = std::none_of(digits, end, [](char c) { return c == '.' || c == 'e'; });
    if (is_integer) text_ += ".0";
#else
    text_ += nlohmann::json(value).dump();
#endif
    return *this;
  }

 private:
  static constexpr std::size_t kBlock = 1 << 16, kMostDigits = 32;

  void flush() {
    out_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
    text_.clear();
  }

  std::ostream& out_;
  std::string text_;
};

}  // namespace spherical_springs::core
