#include "stepping/elements.h"

#include <algorithm>
#include <utility>

#include "base/buckets.h"

namespace spherical_springs::core {
namespace {

using Places = std::vector<std::uint32_t>;

/// A spring alone; turned to have the first end first where that is the same.
template <class Spring>
Element elementOf(const SpringList<Spring>& springs, std::uint32_t index, const Places& places) {
  Element element;
  element.ends.fill(kNone);
  element.springs[0] = index;
  const auto begin = element.ends.begin(), end = begin + Spring::kParticles;
  for (std::size_t i = 0; i < Spring::kParticles; ++i) {
    element.ends[i] = places[springs[index].particles[i]];
  }
  if (isCyclic<Spring>()) {
    std::rotate(begin, std::min_element(begin, end), end);
  }
  return element;
}

/// Elements of one spring each, of those that are wanted, by their ends and, where those are the
/// same, by their springs.
template <class Spring, class Wanted>
std::vector<Element> sortedSprings(const SpringList<Spring>& springs, const Places& places,
                                   const Wanted& wanted) {
  auto by_first_end = dealtOut<Element>(places.size(), [&](const auto& visit) {
    for (std::uint32_t s = 0; s < springs.size(); ++s) {
      if (!wanted(springs[s])) continue;
      const Element element = elementOf<Spring>(springs, s, places);
      visit(element.ends[0], element);
    }
  });
  for (std::size_t place = 0; place < places.size(); ++place) {
    std::sort(by_first_end.begin(place), by_first_end.end(place),
              [&](const Element& a, const Element& b) {
                if (a.ends != b.ends) return a.ends < b.ends;
                return fieldsOf(springs[a.springs[0]]) < fieldsOf(springs[b.springs[0]]);
              });
  }
  return std::move(by_first_end.items);
}

template <class Spring>
struct SortedElements : std::vector<Element> {
  using std::vector<Element>::operator=;
};

/// Returns whether two sorted elements have the same ends.
bool anyParallel(const std::vector<Element>& sorted) {
  return std::adjacent_find(sorted.begin(), sorted.end(), [](const Element& a, const Element& b) {
           return a.ends == b.ends;
         }) != sorted.end();
}

/// Which edges of triangles join two ends.
class EdgeTable {
 public:
  struct Edge {
    std::uint32_t last, triangle;
    std::uint8_t side;  ///< from this corner to the next
  };

  EdgeTable(const std::vector<Element>& triangles, std::size_t place_count)
      : by_first_(dealtOut<Edge>(place_count, [&](const auto& visit) {
          for (std::uint32_t t = 0; t < triangles.size(); ++t) {
            for (std::uint8_t side = 0; side < 3; ++side) {
              const auto [first, last] =
                  std::minmax(triangles[t].ends[side], triangles[t].ends[(side + 1) % 3]);
              visit(first, Edge{last, t, side});
            }
          }
        })) {}

  /// Calls `visit(edge)` for those from `first` to `last`, which is above it.
  template <class Visitor>
  void forEachBetween(std::uint32_t first, std::uint32_t last, const Visitor& visit) const {
    std::for_each(by_first_.begin(first), by_first_.end(first), [&](const Edge& edge) {
      if (edge.last == last) visit(edge);
    });
  }

 private:
  Buckets<Edge> by_first_;
};

/// The arcs along the sides of a triangle.
struct Sides {
  std::array<std::uint32_t, 3> arcs{kNone, kNone, kNone};

  int count() const { return 3 - static_cast<int>(std::count(arcs.begin(), arcs.end(), kNone)); }
};

/// Gives arcs to triangles that have them as a side, to those with the fewest first.
/// @return the arcs left over.
std::vector<Element> giveAway(std::vector<Element> arcs, const std::vector<Element>& triangles,
                              std::size_t place_count, std::vector<Sides>& sides) {
  if (triangles.empty()) return arcs;
  const EdgeTable table(triangles, place_count);
  std::vector<Element> left;
  for (const Element& arc : arcs) {
    const EdgeTable::Edge* best = nullptr;
    int least = 2;
    table.forEachBetween(arc.ends[0], arc.ends[1], [&](const EdgeTable::Edge& edge) {
      const Sides& of = sides[edge.triangle];
      if (of.count() >= least || of.arcs[edge.side] != kNone) return;
      best = &edge;
      least = of.count();
    });
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
    std::rotate(triangle.ends.begin(), triangle.ends.begin() + 1, triangle.ends.begin() + 3);
    std::rotate(sides.arcs.begin(), sides.arcs.begin() + 1, sides.arcs.end());
  }
  triangle.springs[1] = sides.arcs[0];
  triangle.springs[2] = sides.arcs[1];
  return triangle;
}

}  // namespace

ElementLists elementsOf(const System& system, const Places& places) {
  ElementLists lists;
  PerKind<SortedElements> sorted;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    std::vector<Element>& elements = sorted.get<Spring>();
    elements = sortedSprings(system.springs<Spring>(), places, [](const Spring&) { return true; });
    lists.any_parallel = lists.any_parallel || anyParallel(elements);
    if constexpr (!kHasStepKernels<Spring>) {
      lists.of[sortOf<PlainSprings<Spring>>()] = std::move(elements);
    }
  });
  const std::vector<Element>& triangles = sorted.get<SolidAngleSpring>();
  std::vector<Sides> sides(triangles.size());
  lists.of[sortOf<Arcs>()] =
      giveAway(std::move(sorted.get<AngleSpring>()), triangles, places.size(), sides);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const std::size_t sort = sortOf<Triangles<0>>() + sides[t].count();
    lists.of[sort].push_back(joined(triangles[t], sides[t]));
  }
  lists.of[sortOf<OrientedArcs>()] = std::move(sorted.get<OrientedAngleSpring>());
  return lists;
}

PerKind<DampedElements> dampedElementsOf(const System& system, const Places& places) {
  PerKind<DampedElements> elements;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    static_cast<std::vector<Element>&>(elements.get<Spring>()) = sortedSprings(
        system.springs<Spring>(), places, [](const Spring& spring) { return spring.damping > 0; });
  });
  return elements;
}

}  // namespace spherical_springs::core
