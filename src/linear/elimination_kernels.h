// Elimination of unknowns from dense symmetric matrices, for the instruction set of this processor.
#pragma once

#include <cstddef>

namespace spherical_springs::core {

/// A symmetric matrix in parts, each stored by columns without gaps: `own` (own x own) and `rest`
/// (rest x rest), of which the lower triangles count, and `below` (rest x own) between them.
/// `rest` is output alone.
struct FrontMatrix {
  double *own, *below, *rest;
  std::ptrdiff_t own_size, rest_size;
};

/// Calls back in the middle of the elimination of a large matrix, several times a second.
struct Interlude {
  void (*call)(const void* data);  ///< what it throws comes out; the matrix is then of no use
  const void* data;
};

struct EliminationKernels {
  /// Leaves the Cholesky factor of the first unknowns in `own` and `below`, and what is to be added
  /// to the matrix of the others in `rest`.
  /// @return whether `own` is positive definite; else the matrix is of no use.
  bool (*eliminate)(const FrontMatrix& front, const Interlude& interlude);
};

/// Results of different instruction sets differ by rounding.
const EliminationKernels& eliminationKernels();

}  // namespace spherical_springs::core
