#include "stepping/splitting.h"

namespace spherical_springs::core {
namespace {

// The six-stage scheme S6 of fourth order of S. Blanes and P. C. Moan, "Practical symplectic
// partitioned Runge-Kutta and Runge-Kutta-Nystrom methods", J. Comput. Appl. Math. 142 (2002),
// 313-330, table 2. Its stability limit follows from the trace of a step of an oscillator.
SplittingScheme blanesMoan() {
  constexpr double a1 = 0.0792036964311957, a2 = 0.353172906049774, a3 = -0.0420650803577195;
  constexpr double b1 = 0.209515106613362, b2 = -0.143851773179818;
  constexpr double a4 = 1 - 2 * (a1 + a2 + a3), b3 = 0.5 - (b1 + b2);
  return {4, 3.13, {a1, a2, a3, a4, a3, a2, a1}, {b1, b2, b3, b3, b2, b1}};
}

}  // namespace

const SplittingScheme& splittingScheme(IntegrationMethod method) {
  static const SplittingScheme kEuler = {1, 2, {0, 1}, {1}};
  static const SplittingScheme kVerlet = {2, 2, {0.5, 0.5}, {1}};
  static const SplittingScheme kFourthOrder = blanesMoan();
  if (method == IntegrationMethod::euler) return kEuler;
  return method == IntegrationMethod::verlet ? kVerlet : kFourthOrder;
}

// Above second order some kicks go back in time, and damping with them: where it decays within a
// step that would amplify it without bound. A verlet step is stable there.
const SplittingScheme& schemeUnderDamping(const SplittingScheme& scheme, double fastest_rate,
                                          double time_step) {
  if (scheme.order <= 2 || fastest_rate * time_step <= 1) return scheme;
  return splittingScheme(IntegrationMethod::verlet);
}

}  // namespace spherical_springs::core
