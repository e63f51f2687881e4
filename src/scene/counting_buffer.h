#pragma once

#include <array>
#include <cstddef>
#include <istream>
#include <streambuf>

namespace spherical_springs::core {

/// Reads a stream by the block, and knows how far without asking the system.
class CountingBuffer : public std::streambuf {
 public:
  explicit CountingBuffer(std::istream& in) : in_(in) {}

  /// Whether more than there is has been asked for.
  bool hasEnded() const { return ended_; }

  std::size_t offset() const { return filled_ - static_cast<std::size_t>(egptr() - gptr()); }

 private:
  int_type underflow() override {
    in_.read(block_.data(), static_cast<std::streamsize>(block_.size()));
    const auto count = in_.gcount();
    filled_ += static_cast<std::size_t>(count);
    setg(block_.data(), block_.data(), block_.data() + count);
    ended_ = count == 0;
    return count > 0 ? traits_type::to_int_type(block_[0]) : traits_type::eof();
  }

  std::istream& in_;
  std::array<char, 1 << 16> block_;
  std::size_t filled_ = 0;
  bool ended_ = false;
};

}  // namespace spherical_springs::core
