// Items in the order of their ids.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace spherical_springs::core {

/// The largest id that an item may have.
inline constexpr std::uint32_t kLargestId = 4294967294;
/// The largest id that a file may choose for an item: what is added later gets the ids above.
inline constexpr std::uint32_t kLargestChosenId = 4000000000;

/// Items under ids that are given in order from 0 and never used again.
template <class Item>
class IdTable {
 public:
  const std::vector<std::uint32_t>& ids() const { return ids_; }  ///< rising
  const std::vector<Item>& items() const { return items_; }       ///< in the order of their ids
  std::size_t size() const { return items_.size(); }              ///< number of items
  std::uint32_t nextId() const { return next_id_; }               ///< the id that `add` will give
  /// Item at an index below `size()`.
  Item& item(std::size_t index) { return items_[index]; }
  /// Item at an index below `size()`.
  const Item& item(std::size_t index) const { return items_[index]; }

  /// Index of an id among the items, or nothing when there is none.
  std::optional<std::size_t> find(std::uint32_t id) const {
    if (id < ids_.size() && ids_[id] == id) return id;  // none below it is missing
    const auto found = std::lower_bound(ids_.begin(), ids_.end(), id);
    if (found == ids_.end() || *found != id) return std::nullopt;
    return static_cast<std::size_t>(found - ids_.begin());
  }

  /// Takes the memory for so many more items, so that adding them cannot fail.
  void makeRoomFor(std::size_t count) {
    reserveFor(ids_, count);
    reserveFor(items_, count);
  }

  /// Adds under the next id, and returns it.
  std::uint32_t add(const Item& item) { return add(next_id_, item); }

  /// Adds under an id that is not below `nextId()`.
  std::uint32_t add(std::uint32_t id, const Item& item) {
    ids_.push_back(id);
    items_.push_back(item);
    next_id_ = id + 1;
    return id;
  }

  /// Ids below `id` will not be given.
  void reserveIdsBelow(std::uint32_t id) { next_id_ = std::max(next_id_, id); }

  /// Removes the items whose index is marked in `doomed`.
  void remove(const std::vector<bool>& doomed) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < items_.size(); ++i) {
      if (doomed[i]) continue;
      ids_[kept] = ids_[i];
      items_[kept] = items_[i];
      ++kept;
    }
    ids_.resize(kept);
    items_.resize(kept);
  }

 private:
  template <class Value>
  static void reserveFor(std::vector<Value>& values, std::size_t count) {
    const std::size_t needed = values.size() + count;
    if (needed > values.capacity()) values.reserve(std::max(needed, 2 * values.capacity()));
  }

  std::vector<std::uint32_t> ids_;
  std::vector<Item> items_;
  std::uint32_t next_id_ = 0;
};

}  // namespace spherical_springs::core
