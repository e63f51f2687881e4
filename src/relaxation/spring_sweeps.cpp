#include "relaxation/spring_sweeps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace spherical_springs::core {
namespace {

constexpr std::size_t kLeastRuns = 64, kLongestRun = 32;

/// The next number of a sequence; SplitMix64 of G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014.
std::uint64_t next(std::uint64_t& state) {
  std::uint64_t z = state += 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

}  // namespace

SpringSweeps::SpringSweeps(const System& system, std::uint64_t seed)
    : inverse_masses_(system.inverseMasses()), state_(seed) {
  constexpr double kLastShare = 0.01;  // of the stiffest spring
  constexpr double kSoftest = 1e-6;    // of the stiffest, that counts
  std::size_t count = 0;
  double least = std::numeric_limits<double>::infinity();
  forEachKind([&](auto kind) {
    auto& springs = springs_.get<typename decltype(kind)::type>();
    springs = system.springs<typename decltype(kind)::type>();
    shuffle(springs.data(), springs.size());
    count += springs.size();
    for (const auto& spring : springs) least = std::min(least, spring.stiffness);
  });
  const double largest = system.largestStiffness();
  first_eta_ = 1 / std::max(least, kSoftest * largest);
  last_eta_ = kLastShare / largest;

  const std::size_t length = std::clamp<std::size_t>(count / kLeastRuns, 1, kLongestRun);
  std::uint32_t number = 0;
  forEachKind([&](auto kind) {
    const std::size_t end = springs_.get<typename decltype(kind)::type>().size();
    for (std::size_t first = 0; first < end; first += length) {
      runs_.push_back({number, static_cast<std::uint32_t>(first),
                       static_cast<std::uint32_t>(std::min(end, first + length))});
    }
    ++number;
  });
}

void SpringSweeps::sweep(int number, Points& positions) {
  const double eta = first_eta_ * std::pow(last_eta_ / first_eta_, number / (kCount - 1.));
  shuffle(runs_.data(), runs_.size());
  for (const auto& [wanted, first, end] : runs_) {
    std::array<std::uint8_t, kLongestRun> order;
    std::iota(order.begin(), order.end(), std::uint8_t{0});
    shuffle(order.data(), end - first);
    std::uint32_t passed = 0;
    forEachKind([&, wanted = wanted, first = first, end = end](auto kind) {
      if (passed++ != wanted) return;
      const auto* springs = springs_.get<typename decltype(kind)::type>().data() + first;
      for (std::uint32_t i = 0; i < end - first; ++i) satisfy(springs[order[i]], eta, positions);
    });
  }
}

/// A random number from 0 to `bound` - 1.
std::uint32_t SpringSweeps::below(std::size_t bound) {
  return static_cast<std::uint32_t>(((next(state_) >> 32) * bound) >> 32);
}

/// After R. A. Fisher and F. Yates.
template <class Item>
void SpringSweeps::shuffle(Item* items, std::size_t count) {
  for (std::size_t i = count; i > 1; --i) std::swap(items[i - 1], items[below(i)]);
}

template <class Spring>
void SpringSweeps::satisfy(const Spring& spring, double eta, Points& positions) const {
  constexpr double kLongestMove = 0.5 * kPi;  // [rad]
  constexpr double kLeastMobility = 1e-100;
  constexpr std::size_t kEnds = Spring::kParticles;
  const auto c = condition(spring, System::points(spring, positions));
  std::array<double, kEnds> ease;  // of moving each particle
  for (std::size_t j = 0; j < kEnds; ++j) ease[j] = inverse_masses_[spring.particles[j]];
  const double easiest = *std::max_element(ease.begin(), ease.end());
  if (easiest == 0) return;
  double mobility = 0, longest = 0;
  for (std::size_t j = 0; j < kEnds; ++j) {
    ease[j] /= easiest;
    const double squared = c.gradient[j].squaredNorm();
    mobility += ease[j] * squared;
    longest = std::max(longest, ease[j] * ease[j] * squared);
  }
  if (mobility < kLeastMobility) return;
  const double share = std::min(1., spring.stiffness * eta);
  const double wanted = share * std::abs(c.value) / mobility;
  const double most = kLongestMove / std::sqrt(longest);
  const double length = std::copysign(std::min(wanted, most), -c.value);
  for (std::size_t j = 0; j < kEnds; ++j) {
    if (ease[j] == 0) continue;
    auto place = positions.col(spring.particles[j]);
    place = rotated(place, length * ease[j] * c.gradient[j]);
  }
}

}  // namespace spherical_springs::core
