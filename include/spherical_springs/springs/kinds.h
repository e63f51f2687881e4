// The list of kinds of springs. A new kind is a header beside the others and a name in this list
// (and, for people who call the node, a message and its conversion).
#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "spherical_springs/springs/angle.h"
#include "spherical_springs/springs/oriented_angle.h"
#include "spherical_springs/springs/solid_angle.h"

namespace spherical_springs::core {

/// One `Holder<Spring>` for each kind of spring.
template <template <class> class Holder>
class PerKind {
 public:
  template <class Spring>
  Holder<Spring>& get() {
    return std::get<Holder<Spring>>(holders_);
  }
  template <class Spring>
  const Holder<Spring>& get() const {
    return std::get<Holder<Spring>>(holders_);
  }

 private:
  std::tuple<Holder<AngleSpring>, Holder<SolidAngleSpring>, Holder<OrientedAngleSpring>> holders_;
};

template <class Spring>
struct Kind {
  using type = Spring;
};

/// Calls `visit(Kind<Spring>())` for each kind of spring, always in the same order.
template <class Visitor>
void forEachKind(Visitor&& visit) {
  visit(Kind<AngleSpring>());
  visit(Kind<SolidAngleSpring>());
  visit(Kind<OrientedAngleSpring>());
}

template <class Visitor>
void forEachKindBackward(Visitor&& visit) {
  visit(Kind<OrientedAngleSpring>());
  visit(Kind<SolidAngleSpring>());
  visit(Kind<AngleSpring>());
}

template <class Spring>
struct SpringList : std::vector<Spring> {
  using std::vector<Spring>::vector;
};

/// Ids of springs of one kind.
template <class Spring>
struct IdList : std::vector<std::uint32_t> {
  using std::vector<std::uint32_t>::vector;
};

using SpringLists = PerKind<SpringList>;
using SpringIds = PerKind<IdList>;

}  // namespace spherical_springs::core
