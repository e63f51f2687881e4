// Run-time detection of the instruction sets that kernels are compiled for.
#pragma once

namespace spherical_springs::core {

inline bool hasAvx2() {
#ifdef __x86_64__
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

inline bool hasAvx512() {
#ifdef __x86_64__
  return hasAvx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl");
#else
  return false;
#endif
}

}  // namespace spherical_springs::core
