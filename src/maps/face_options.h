#pragma once

namespace spherical_springs::mesh {

/// The second derivatives of a face: the exact ones; a positive semidefinite part of them; or those
/// that areas have where they are linear (Gauss and Newton), which serve where the areas are nearly
/// right.
enum class FaceHessian { exact, definite, gauss_newton };

/// The cost of the area of a face, with r = area / share: (r + 1/r - 2) / 2, which is infinite at a
/// fold, or (r - 1)^2 / 2 of the signed area, which is finite there.
enum class AreaCost { barrier, square };

}  // namespace spherical_springs::mesh
