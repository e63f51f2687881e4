// Items dealt out to buckets, in memory of one piece.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherical_springs::core {

/// Items of bucket b are at [first[b], first[b + 1]), in the order in which they came: fewer than
/// 2^32 in all, to which SceneLimits bounds what comes of a scene.
template <class Item>
struct Buckets {
  std::vector<std::uint32_t> first;
  std::vector<Item> items;

  auto begin(std::size_t bucket) { return items.begin() + first[bucket]; }
  auto end(std::size_t bucket) { return items.begin() + first[bucket + 1]; }
  auto begin(std::size_t bucket) const { return items.begin() + first[bucket]; }
  auto end(std::size_t bucket) const { return items.begin() + first[bucket + 1]; }
};

/// `forEach(visit)` calls `visit(bucket, item)` for every item, the same ones in each of two calls.
template <class Item, class ForEach>
Buckets<Item> dealtOut(std::size_t bucket_count, const ForEach& forEach) {
  Buckets<Item> buckets{std::vector<std::uint32_t>(bucket_count + 1, 0), {}};
  auto& first = buckets.first;
  forEach([&](std::size_t bucket, const Item&) { ++first[bucket + 1]; });
  for (std::size_t b = 0; b < bucket_count; ++b) first[b + 1] += first[b];
  buckets.items.resize(first.back());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  forEach([&](std::size_t bucket, const Item& item) { buckets.items[next[bucket]++] = item; });
  return buckets;
}

}  // namespace spherical_springs::core
