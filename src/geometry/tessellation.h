// Arcs and triangles of the sphere cut into pieces short enough to pass for straight and flat.
#pragma once

#include <vector>

#include "spherical_springs/sphere.h"

namespace spherical_springs::core {

/// The longest piece [rad] whose chord stays within `depth` of the unit sphere, depth in (0, 1].
double pieceWithin(double depth);

/// Appends the great-circle arc from `a` to `b` as pairs of unit vectors, one pair a piece, in
/// equal pieces of at most `longest` [rad]; nothing where `a` and `b` coincide.
void appendArc(const Vector3& a, const Vector3& b, double longest, std::vector<Vector3>& ends);

/// Appends the spherical triangle as triples of unit vectors, one triple a piece, each with the
/// orientation of the whole and with sides of at most `longest` [rad]. The longest side is halved
/// until all are short, so that triangles with a side in common cut it at the same places.
void appendTriangle(const Vector3& a, const Vector3& b, const Vector3& c, double longest,
                    std::vector<Vector3>& corners);

}  // namespace spherical_springs::core
