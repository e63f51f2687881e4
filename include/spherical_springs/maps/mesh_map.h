// A mesh mapped in one call, and what became of its faces.
#pragma once

#include <optional>

#include "spherical_springs/maps/distortion.h"
#include "spherical_springs/maps/sphere_map.h"

namespace spherical_springs::mesh {

/// The wall time [s] that is enough for most meshes of so many vertices on two cores.
double usualTime(Eigen::Index vertices);

/// Why the search for a map has ended.
enum class MapEnd {
  found,     ///< the tolerance is reached, or nothing better is found from any start
  time,      ///< `max_time` is over
  told,      ///< `go_on` has returned false
  no_memory  ///< memory has run out
};

/// A map of a mesh.
struct MeshMap {
  Points points;               ///< one unit vector a vertex
  FaceDistortion faces;        ///< of these points
  Distortion distortion;       ///< the summary of `faces`, with no face folded
  MapEnd end = MapEnd::found;  ///< why the search has ended
};

/// Maps a mesh as `sphereMap` does, from `start` if there is one, and tells how far the map is from
/// keeping areas and angles.
/// @throw what `sphereMap` throws; NoMap also where the areas of the map, computed independently,
/// show a fold or do not sum to 4 pi.
/// \snippet test_headers.cpp map_scene
MeshMap meshMap(const TriangleMesh& mesh, const ValuesRef& shares,
                const std::optional<Points>& start, const MapOptions& options = {});

/// The directions of the vertices from their mean, one unit vector a vertex: what the map is
/// compared with. A vertex at the mean is as good as anywhere.
Points centralProjection(const TriangleMesh& mesh);

/// Whether no face is folded and their areas sum to 4 pi.
bool coversOnce(const Distortion& distortion);

}  // namespace spherical_springs::mesh
