#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scene/fields.h"
#include "spherical_springs/scene.h"

namespace spherical_springs::core {

/// The items of one list of a scene file, as they come.
template <class Item>
struct ItemList {
  std::vector<std::uint32_t> ids;
  std::vector<Item> items;
  std::vector<std::size_t> ends;  ///< in the file [bytes]

  void take(Fields& fields, std::size_t end);
};

inline void takeFields(Fields& fields, Particle& particle) {
  fields.take("position", particle.position);
  fields.take("angular_velocity", particle.angular_velocity);
  fields.take("pinned", particle.pinned);
}

template <class Spring>
void takeFields(Fields& fields, Spring& spring) {
  fields.take("particles", spring.particles);
  fields.take("at_rest", spring.at_rest);
}

template <class Item>
void ItemList<Item>::take(Fields& fields, std::size_t end) {
  std::uint32_t id = ids.empty() ? 0 : ids.back() + 1;
  Item item;
  fields.take("id", id);
  takeFields(fields, item);
  Item::visitFields(
      item, [&](const char* field, double& value, const Range&) { fields.take(field, value); });
  fields.requireNothingLeft();
  ids.push_back(id);
  items.push_back(item);
  ends.push_back(end);
}

/// All lists of a scene file.
class ItemLists {
 public:
  explicit ItemLists(const SceneLimits& limits) : limits_(limits.heldByIndices()) {}

  static bool isList(const std::string& name) {
    bool known = name == kParticles;
    forEachKind([&](auto kind) { known |= name == decltype(kind)::type::kTable; });
    return known;
  }

  /// Takes the next item of the list `name`, which ends at byte `end` of the file.
  /// @throw std::invalid_argument for what is no item, or one too many.
  void take(const std::string& name, Fields& fields, std::size_t end) {
    if (name == kParticles) {
      require(kParticles, particles_.items.size(), limits_.particles);
      particles_.take(fields, end);
      return;
    }
    require("springs", springs_taken_++, limits_.springs);
    forEachKind([&](auto kind) {
      using Spring = typename decltype(kind)::type;
      if (name == Spring::kTable) springs_.get<Spring>().take(fields, end);
    });
  }

  std::size_t size(const std::string& name) const {
    std::size_t count = particles_.items.size();
    forEachKind([&](auto kind) {
      using Spring = typename decltype(kind)::type;
      if (name == Spring::kTable) count = springs_.get<Spring>().items.size();
    });
    return count;
  }

  /// Where an item ends in the file [bytes].
  std::size_t endOf(const std::string& name, std::size_t index) const {
    if (name == kParticles) return particles_.ends[index];
    std::size_t end = 0;
    forEachKind([&](auto kind) {
      using Spring = typename decltype(kind)::type;
      if (name == Spring::kTable) end = springs_.get<Spring>().ends[index];
    });
    return end;
  }

  /// Makes a scene of all items, which are moved out of here.
  /// @throw ItemFault, std::invalid_argument as Scene's constructor does.
  Scene scene() {
    SpringIds ids;
    SpringLists springs;
    forEachKind([&](auto kind) {
      using Spring = typename decltype(kind)::type;
      auto& list = springs_.get<Spring>();
      static_cast<std::vector<std::uint32_t>&>(ids.get<Spring>()) = std::move(list.ids);
      static_cast<std::vector<Spring>&>(springs.get<Spring>()) = std::move(list.items);
    });
    return Scene(limits_, particles_.ids, std::move(particles_.items), ids, std::move(springs));
  }

 private:
  static constexpr const char* kParticles = "particles";

  static void require(const std::string& what, std::size_t present, std::size_t limit) {
    if (present < limit) return;
    throw std::invalid_argument(what + " in the file are " + std::to_string(present + 1) +
                                " or more; allowed: at most " + std::to_string(limit));
  }

  const SceneLimits limits_;
  ItemList<Particle> particles_;
  PerKind<ItemList> springs_;
  std::size_t springs_taken_ = 0;
};

}  // namespace spherical_springs::core
