// Random numbers that are the same with every standard library.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "spherical_springs/sphere.h"

namespace benchmark_scenes {

class Random {
 public:
  explicit Random(std::uint32_t seed) : generator_(seed) {}

  /// In [0, 1).
  double unit() { return generator_() / 4294967296.; }

  double between(double low, double high) { return low + (high - low) * unit(); }

  std::uint32_t below(std::uint32_t bound) { return static_cast<std::uint32_t>(unit() * bound); }

  /// Draws a number of mean 0 and deviation 1, after G. E. P. Box and M. E. Muller, Ann. Math.
  /// Stat. 29 (1958).
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - unit()));
    return radius * std::cos(2 * spherical_springs::core::kPi * unit());
  }

  /// A unit vector, every direction alike.
  spherical_springs::core::Vector3 direction() {
    const double z = between(-1, 1);
    const double turn = 2 * spherical_springs::core::kPi * unit();
    const double radius = std::sqrt(1 - z * z);
    return {radius * std::cos(turn), radius * std::sin(turn), z};
  }

 private:
  std::mt19937 generator_;
};

}  // namespace benchmark_scenes
