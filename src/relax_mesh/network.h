// A map of a surface as particles and springs.
#pragma once

#include <spherical_springs/AddParticles.h>
#include <spherical_springs/AddSprings.h>

#include <cstdint>
#include <vector>

#include "spherical_springs/maps/triangle_mesh.h"

namespace spherical_springs::relax_mesh {

using core::Points;
using core::Values;

using Ids = std::vector<std::uint32_t>;

/// A surface on the sphere as springs, each of which holds 1/2 J where it is off by all of its
/// rest: a solid-angle spring a face, and an angle spring an edge, at rest at the start.
struct Network {
  const Points& start;  ///< one unit vector a vertex
  const mesh::Faces& faces;
  const Values& rests;  ///< one a face [sr]
  double arc_weight;    ///< of the angle springs beside the others, above 0
};

/// The springs that a network on a closed surface of so many faces has.
constexpr std::size_t springCount(std::size_t faces) { return faces + 3 * faces / 2; }

AddParticles::Request particlesOf(const Network& network);

/// `ids`: one a vertex.
AddSprings::Request springsOf(const Network& network, const Ids& ids);

/// The torque on the vertices of a face of the mean size that is off by a share of it [N m].
double torqueOf(double share, const Network& network);

}  // namespace spherical_springs::relax_mesh
