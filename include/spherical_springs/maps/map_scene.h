// A map of a mesh as particles and springs.
#pragma once

#include <cstddef>

#include "spherical_springs/maps/triangle_mesh.h"
#include "spherical_springs/scene.h"

namespace spherical_springs::mesh {

/// The springs, of all kinds, that the scene of a closed mesh of so many faces has.
constexpr std::size_t springCountOfMap(std::size_t faces) { return faces + 3 * faces / 2; }

/// A map of a closed mesh as a scene: a particle a vertex, under its number, a solid-angle spring a
/// face, at rest at its share [sr], and an angle spring an edge, at rest at the map. A solid-angle
/// spring holds 1/2 J where it is off by all of its rest, an angle spring that times `angle_weight`
/// and a little.
/// @throw std::invalid_argument for more than `limits` allow.
/// \snippet test_headers.cpp map_scene
core::Scene sceneOfMap(const Faces& faces, const ValuesRef& shares, const Points& map,
                       double angle_weight, const core::SceneLimits& limits);

}  // namespace spherical_springs::mesh
