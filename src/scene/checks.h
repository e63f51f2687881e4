// The checks at the door of a scene: each throws std::invalid_argument, which names item, field,
// value and what is allowed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "spherical_springs/scene.h"

namespace spherical_springs::core {

using Ids = std::vector<std::uint32_t>;

inline std::string itemName(const std::string& list, std::size_t index) {
  return list + "[" + std::to_string(index) + "]";
}

/// Something is wrong with one item of a list.
struct ItemFault : std::invalid_argument {
  ItemFault(const std::string& list_name, std::size_t item_index, const std::string& what)
      : std::invalid_argument(itemName(list_name, item_index) + "." + what),
        list(list_name),
        index(item_index) {}

  std::string list;
  std::size_t index;
};

[[noreturn]] inline void refuse(const std::string& field, const std::string& value,
                                const std::string& allowed) {
  throw std::invalid_argument(field + " is " + value + "; allowed: " + allowed);
}

inline std::string toText(const Vector3& v) {
  return "(" + toText(v.x()) + ", " + toText(v.y()) + ", " + toText(v.z()) + ")";
}

[[noreturn]] inline void refuse(const std::string& field, const Vector3& value,
                                const std::string& allowed) {
  if (!value.allFinite()) throw NonFinite(field + " is " + toText(value) + "; allowed: " + allowed);
  refuse(field, toText(value), allowed);
}

/// Returns the bound for a number that is just beyond pi or 2 pi, as these are when they are
/// rounded to 32 bits or to four decimals; any other number as it is.
inline double withinRoundedPi(double value, const Range& range) {
  constexpr double kRounding = 3e-6;  // relative
  const auto isRounded = [&](double bound) {
    const double size = std::abs(bound);
    return (size == kPi || size == 2 * kPi) && std::abs(value - bound) <= kRounding * size;
  };
  if (value > range.high && isRounded(range.high)) return range.high;
  if (value < range.low && !range.open_low && isRounded(range.low)) return range.low;
  return value;
}

template <class Item>
void checkFields(Item& item) {
  Item::visitFields(item, [](const char* field, double& value, const Range& range) {
    value = withinRoundedPi(value, range);
    requireInside(range, value, field);
  });
}

/// Puts the item's name before what `check` has to say against it.
template <class Item, class Check>
void checkEach(std::vector<Item>& items, const char* list, Check&& check) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    try {
      check(items[i]);
    } catch (const NonFinite& fault) {
      throw NonFinite(itemName(list, i) + "." + fault.what());
    } catch (const std::invalid_argument& fault) {
      throw ItemFault(list, i, fault.what());
    }
  }
}

inline void checkParticle(Particle& particle) {
  if (!particle.position.allFinite() || particle.position.isZero(0)) {
    refuse("position", particle.position, "any finite non-zero vector");
  }
  // The length is bounded, not the components: those grow when a particle turns or the part along
  // its position is dropped, and a scene that was saved must be accepted again.
  constexpr double kRounding = 1e-9;
  if (!particle.angular_velocity.allFinite() ||
      particle.angular_velocity.stableNorm() > (1 + kRounding) * kFastest) {
    refuse("angular_velocity", particle.angular_velocity, "finite, of length up to 1e100 [rad/s]");
  }
  if (particle.mass == 0) particle.mass = 1;
  checkFields(particle);
  particle.position = direction(particle.position);
  particle.angular_velocity = particle.pinned
                                  ? Vector3(Vector3::Zero())
                                  : tangentPart(particle.position, particle.angular_velocity);
}

inline void checkParticles(std::vector<Particle>& particles) {
  checkEach(particles, "particles", checkParticle);
}

/// Refuses an id that is none of those of `table`, which are of items of the kind `what`.
template <class Item>
[[noreturn]] void refuseId(const std::string& field, std::uint32_t id, const IdTable<Item>& table,
                           const std::string& what) {
  std::string there = "there is none";
  if (table.size() == 1) there = "there is " + std::to_string(table.ids().front());
  if (table.size() > 1) {
    there = "there are " + std::to_string(table.size()) + ", from " +
            std::to_string(table.ids().front()) + " to " + std::to_string(table.ids().back());
  }
  refuse(field, std::to_string(id), "the id of " + what + "; " + there);
}

template <class Item>
std::vector<std::size_t> indicesOf(const IdTable<Item>& table, const Ids& ids,
                                   const std::string& list, const std::string& what) {
  std::vector<std::size_t> indices(ids.size());
  std::vector<bool> seen(table.size(), false);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto index = table.find(ids[i]);
    if (!index) refuseId(itemName(list, i), ids[i], table, what);
    if (seen[*index]) refuse(itemName(list, i), std::to_string(ids[i]) + " again", "each id once");
    seen[*index] = true;
    indices[i] = *index;
  }
  return indices;
}

inline void requireSameLength(const std::string& ids, std::size_t id_count,
                              const std::string& items, std::size_t item_count) {
  if (id_count == item_count) return;
  throw std::invalid_argument(
      ids + " has " + std::to_string(id_count) + (id_count == 1 ? " item" : " items") + " and " +
      items + " has " + std::to_string(item_count) + "; allowed: as many of one as of the other");
}

inline void requireRoom(const std::string& what, std::size_t present, std::size_t added,
                        std::size_t limit) {
  if (added <= limit && present <= limit - added) return;
  throw std::invalid_argument(what + " would be " + std::to_string(present + added) +
                              " in all; allowed: at most " + std::to_string(limit));
}

template <class Item>
void requireFreeIds(const IdTable<Item>& table, std::size_t added, const std::string& what) {
  const std::uint32_t left = kLargestId + 1 - table.nextId();
  if (added <= left) return;
  throw std::invalid_argument(what + " to add are " + std::to_string(added) + ", and " +
                              std::to_string(left) + " ids are left: the largest is " +
                              std::to_string(kLargestId) +
                              ", and none is given twice; they begin from 0 again after a new "
                              "start");
}

/// Ids that were chosen, not given, must not use up those that are given later.
template <class Item>
void requireIdsForOthers(const IdTable<Item>& table, std::uint32_t given_before,
                         const std::string& list) {
  if (table.nextId() <= std::max(given_before, kLargestChosenId + 1)) return;
  throw ItemFault(list, table.size() - 1,
                  "id is " + std::to_string(table.ids().back()) + "; allowed: at most " +
                      std::to_string(kLargestChosenId) +
                      ", so that there are ids for what is added later");
}

template <class Item>
void requireRisingIds(const IdTable<Item>& table, const Ids& ids, const std::string& list) {
  std::uint64_t least = table.nextId();
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (least > kLargestId) {
      throw ItemFault(list, i,
                      "id cannot follow " + std::to_string(kLargestId) + ", the largest there is");
    }
    if (ids[i] < least || ids[i] > kLargestId) {
      throw ItemFault(list, i,
                      "id is " + std::to_string(ids[i]) + "; allowed: " + std::to_string(least) +
                          " to " + std::to_string(kLargestId) + ", rising");
    }
    least = std::uint64_t(ids[i]) + 1;
  }
}

template <class Spring>
std::string idListName() {
  const std::string table = Spring::kTable;
  return table.substr(0, table.size() - 1) + "_ids";
}

template <class Spring>
std::string oneOf() {
  std::string name = Spring::kTable;
  std::replace(name.begin(), name.end(), '_', ' ');
  return "a spring among the " + name;
}

template <class Spring>
struct Indices {
  std::vector<std::size_t> values;
};

template <class Spring>
std::array<std::size_t, Spring::kParticles> particleIndices(const IdTable<Particle>& particles,
                                                            const Spring& spring) {
  std::array<std::size_t, Spring::kParticles> indices;
  for (std::size_t j = 0; j < Spring::kParticles; ++j) {
    const std::uint32_t id = spring.particles[j];
    const auto index = particles.find(id);
    if (!index) refuseId(itemName("particles", j), id, particles, "a particle");
    if (std::find(indices.begin(), indices.begin() + j, *index) != indices.begin() + j) {
      refuse(itemName("particles", j), std::to_string(id) + " again", "particles that differ");
    }
    indices[j] = *index;
  }
  return indices;
}

template <class Spring>
void checkSpring(Spring& spring, const IdTable<Particle>& particles, const Points& positions) {
  const auto indices = particleIndices(particles, spring);
  if (spring.at_rest) {
    std::array<Vector3, Spring::kParticles> points;
    for (std::size_t j = 0; j < Spring::kParticles; ++j) points[j] = positions.col(indices[j]);
    rest(spring, points);
    spring.at_rest = false;
  }
  checkFields(spring);
}

}  // namespace spherical_springs::core
