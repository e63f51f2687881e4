#include "elements.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace spherical_springs::core {
namespace {

using Places = std::vector<std::uint32_t>;

double widthOf(const AngleSpring&) { return 0; }
double widthOf(const SolidAngleSpring&) { return 0; }
double widthOf(const OrientedAngleSpring& spring) { return effectiveWidth(spring); }

/// Elements of one spring each, in order; turned to have the first end first where that is the
/// same.
template <class Spring>
std::vector<Element> sortedSprings(const SpringList<Spring>& springs, const Places& places) {
  std::vector<Element> elements(springs.size());
  for (std::uint32_t s = 0; s < springs.size(); ++s) {
    Element& element = elements[s];
    element.springs[0] = s;
    const auto begin = element.ends.begin(), end = begin + Spring::kParticles;
    for (std::size_t i = 0; i < Spring::kParticles; ++i) {
      element.ends[i] = places[springs[s].particles[i]];
    }
    if (Spring::kCorners == Spring::kParticles) {
      std::rotate(begin, std::min_element(begin, end), end);
    }
  }
  const auto key = [&](const Element& element) {
    const Spring& spring = springs[element.springs[0]];
    return std::make_tuple(spring.restValue(), spring.stiffness, widthOf(spring));
  };
  std::sort(elements.begin(), elements.end(), [&](const Element& a, const Element& b) {
    return a.ends != b.ends ? a.ends < b.ends : key(a) < key(b);
  });
  return elements;
}

/// Which edges of triangles join two ends.
class EdgeTable {
 public:
  struct Edge {
    std::uint32_t last, triangle;
    std::uint8_t side;  ///< from this corner to the next
  };

  EdgeTable(const std::vector<Element>& triangles, std::size_t place_count)
      : first_(place_count + 1, 0), edges_(3 * triangles.size()) {
    forEachEdge(triangles, [&](std::uint32_t first, const Edge&) { ++first_[first + 1]; });
    for (std::size_t i = 0; i < place_count; ++i) first_[i + 1] += first_[i];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    forEachEdge(triangles,
                [&](std::uint32_t first, const Edge& edge) { edges_[next[first]++] = edge; });
    for (std::size_t i = 0; i < place_count; ++i) {
      std::stable_sort(edges_.begin() + first_[i], edges_.begin() + first_[i + 1], ByLast());
    }
  }

  /// Those from `first` to `last`, which is above it.
  auto find(std::uint32_t first, std::uint32_t last) const {
    return std::equal_range(edges_.begin() + first_[first], edges_.begin() + first_[first + 1],
                            Edge{last, 0, 0}, ByLast());
  }

 private:
  struct ByLast {
    bool operator()(const Edge& a, const Edge& b) const { return a.last < b.last; }
  };

  template <class Visitor>
  static void forEachEdge(const std::vector<Element>& triangles, const Visitor& visit) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      for (std::uint8_t side = 0; side < 3; ++side) {
        const auto [first, last] =
            std::minmax(triangles[t].ends[side], triangles[t].ends[(side + 1) % 3]);
        visit(first, Edge{last, t, side});
      }
    }
  }

  std::vector<std::uint32_t> first_;
  std::vector<Edge> edges_;
};

/// The arcs along the sides of a triangle.
struct Sides {
  std::array<std::uint32_t, 3> arcs{kNone, kNone, kNone};

  int count() const { return 3 - static_cast<int>(std::count(arcs.begin(), arcs.end(), kNone)); }
};

/// Gives arcs to triangles that have them as a side, to those with the fewest first.
/// @return the arcs left over.
std::vector<Element> giveAway(const std::vector<Element>& arcs,
                              const std::vector<Element>& triangles, std::size_t place_count,
                              std::vector<Sides>& sides) {
  const EdgeTable table(triangles, place_count);
  std::vector<Element> left;
  for (const Element& arc : arcs) {
    const EdgeTable::Edge* best = nullptr;
    int least = 2;
    const auto [begin, end] = table.find(arc.ends[0], arc.ends[1]);
    for (auto edge = begin; edge != end; ++edge) {
      const Sides& of = sides[edge->triangle];
      if (of.count() >= least || of.arcs[edge->side] != kNone) continue;
      best = &*edge;
      least = of.count();
    }
    if (best != nullptr) {
      sides[best->triangle].arcs[best->side] = arc.springs[0];
    } else {
      left.push_back(arc);
    }
  }
  return left;
}

/// The triangle turned to have its arcs on its first sides.
Element joined(Element triangle, Sides sides) {
  const int count = sides.count();
  for (int turn = 0; turn < 3; ++turn) {
    if ((count < 1 || sides.arcs[0] != kNone) && (count < 2 || sides.arcs[1] != kNone)) break;
    std::rotate(triangle.ends.begin(), triangle.ends.begin() + 1, triangle.ends.end());
    std::rotate(sides.arcs.begin(), sides.arcs.begin() + 1, sides.arcs.end());
  }
  triangle.springs[1] = sides.arcs[0];
  triangle.springs[2] = sides.arcs[1];
  return triangle;
}

}  // namespace

ElementLists elementsOf(const System& system, const Places& places) {
  ElementLists lists;
  auto& arcs = lists[0];
  arcs = sortedSprings(system.springs<AngleSpring>(), places);
  lists[4] = sortedSprings(system.springs<OrientedAngleSpring>(), places);
  const auto triangles = sortedSprings(system.springs<SolidAngleSpring>(), places);
  if (triangles.empty()) return lists;
  std::vector<Sides> sides(triangles.size());
  arcs = giveAway(arcs, triangles, places.size(), sides);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    lists[1 + sides[t].count()].push_back(joined(triangles[t], sides[t]));
  }
  return lists;
}

}  // namespace spherical_springs::core
