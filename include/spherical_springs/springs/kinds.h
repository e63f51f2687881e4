// The list of kinds of springs. doc/architecture.md names the files that a new kind touches.
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
  /// Returns the holder of a kind.
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

/// Tells a generic lambda the kind of spring that it is called for, which is its `type`.
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

/// Calls `visit(Kind<Spring>())` for each kind of spring, in the opposite order.
template <class Visitor>
void forEachKindBackward(Visitor&& visit) {
  visit(Kind<OrientedAngleSpring>());
  visit(Kind<SolidAngleSpring>());
  visit(Kind<AngleSpring>());
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

using SpringLists = PerKind<SpringList>;
using SpringIds = PerKind<IdList>;

}  // namespace spherical_springs::core
