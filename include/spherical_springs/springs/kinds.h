// Lists over the kinds of springs, and loops over them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include "spherical_springs/springs/kind_list.h"

namespace spherical_springs::core {

/// Tells a generic lambda the kind of spring that it is called for, which is its `type`.
template <class Spring>
struct Kind {
  using type = Spring;  ///< the kind
};

namespace detail {

template <class List>
struct KindLoops;

template <class... Springs>
struct KindLoops<KindList<Springs...>> {
  template <template <class> class Holder>
  using Tuple = std::tuple<Holder<Springs>...>;

  static constexpr std::size_t kMostEnds = std::max({Springs::kParticles...});

  template <class Visitor>
  static void forward(Visitor& visit) {
    (visit(Kind<Springs>()), ...);
  }

  // The right operand of an assignment is evaluated before the left one.
  template <class Visitor>
  static void backward(Visitor& visit) {
    int last = 0;
    const auto visited = [&](auto kind) -> int& { return visit(kind), last; };
    (visited(Kind<Springs>()) = ... = 0);
  }
};

}  // namespace detail

/// The largest number of particles that a spring of any kind joins.
inline constexpr std::size_t kMostEnds = detail::KindLoops<Kinds>::kMostEnds;

/// One `Holder<Spring>` for each kind of spring.
template <template <class> class Holder>
class PerKind {
 public:
  /// Returns the holder of a kind.
  template <class Spring>
  Holder<Spring>& get() {
    return std::get<Holder<Spring>>(holders_);
  }
  /// Returns the holder of a kind.
  template <class Spring>
  const Holder<Spring>& get() const {
    return std::get<Holder<Spring>>(holders_);
  }

 private:
  detail::KindLoops<Kinds>::Tuple<Holder> holders_;
};

/// Calls `visit(Kind<Spring>())` for each kind of spring, always in the same order.
/// \snippet test_headers.cpp kinds
template <class Visitor>
void forEachKind(Visitor&& visit) {
  detail::KindLoops<Kinds>::forward(visit);
}

/// Calls `visit(Kind<Spring>())` for each kind of spring, in the opposite order.
template <class Visitor>
void forEachKindBackward(Visitor&& visit) {
  detail::KindLoops<Kinds>::backward(visit);
}

/// Springs of one kind.
template <class Spring>
struct SpringList : std::vector<Spring> {
  using std::vector<Spring>::vector;
};

/// Ids of springs of one kind.
template <class Spring>
struct IdList : std::vector<std::uint32_t> {
  using std::vector<std::uint32_t>::vector;
};

/// Springs of each kind.
using SpringLists = PerKind<SpringList>;
/// Ids of springs of each kind.
using SpringIds = PerKind<IdList>;

}  // namespace spherical_springs::core
