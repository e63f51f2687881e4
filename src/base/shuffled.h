// Numbers of two vectors in another order, by whichever compiler.
#pragma once

namespace spherical_springs::core {

/// `order`: numbers of a count from 0, those of b go on. Always inlined, so that files compiled for
/// different instruction sets have no function of this name that one could call of another.
template <int... order, class Vector>
[[gnu::always_inline]] inline Vector shuffled(const Vector& a, const Vector& b) {
#ifdef __clang__
  return __builtin_shufflevector(a, b, order...);
#else
  using Order = decltype(a < b);
  return __builtin_shuffle(a, b, Order{order...});
#endif
}

}  // namespace spherical_springs::core
