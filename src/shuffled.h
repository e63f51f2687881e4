// Numbers of two vectors in another order, by whichever compiler. Local to each file, as
// kernels/lanes.h has it.
#pragma once

namespace {

/// `order`: numbers of a count from 0, those of b go on.
template <int... order, class Vector>
[[gnu::always_inline]] inline Vector shuffled(const Vector& a, const Vector& b) {
#ifdef __clang__
  return __builtin_shufflevector(a, b, order...);
#else
  using Order = decltype(a < b);
  return __builtin_shuffle(a, b, Order{order...});
#endif
}

}  // namespace
