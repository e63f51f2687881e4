// Maps of closed meshes of genus 0 to the unit sphere, without a fold, of wanted areas.
#pragma once

#include <functional>
#include <stdexcept>

#include "spherical_springs/maps/triangle_mesh.h"
#include "spherical_springs/range.h"

namespace spherical_springs::mesh {

/// Each face's share of the sphere [sr], in proportion to `areas` (one a face: its own, or that
/// times a density), summing to 4 pi. Shares below a millionth of the mean are raised to that.
/// @throw std::invalid_argument for an area that is negative or not finite, or where all are 0.
Values faceShares(const ValuesRef& areas);

/// That no map without folds was found, from any start.
class NoMap : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// How far the search for a map has come.
struct MapProgress {
  double fraction;  ///< of the time, that is over; 0 to 1
  double spread;    ///< of the map that would come out now; infinity while there is none
};

/// Allowed angle weights.
inline constexpr core::Range kAngleWeights{0, 1e6, "0 to 1e6"};

/// Choices of a map.
struct MapOptions {
  /// Within `kAngleWeights`. 0: areas alone; more keeps faces nearer to equal corner angles, at the
  /// expense of areas, which 0.1 gets right to some percent.
  double angle_weight = 0;
  /// Wanted standard deviation of the logarithms of area over share; better ones are not sought.
  double tolerance = 1e-3;
  double max_time = 20;  ///< wall [s]; then the best map so far comes out, or the first
  int threads = 1;       ///< results do not depend on it, to the last bit, unless time runs out
  /// Called on the thread of the caller, several times a second in every phase. Returning false
  /// once ends the search with the best map so far, or with the first where there is none yet. What
  /// it throws comes out, but for std::bad_alloc, which is taken as a lack of memory.
  std::function<bool(const MapProgress&)> go_on = [](const MapProgress&) { return true; };
  /// Called once where memory has run out in the middle of the search, and what comes out is the
  /// best map so far. Where there is none yet, std::bad_alloc comes out instead.
  std::function<void()> out_of_memory = [] {};
};

/// One unit vector a vertex: a map of the mesh to the sphere on which every face is oriented as in
/// the mesh and whose faces cover the sphere once, with areas as near to `shares` as can be found.
/// @throw std::invalid_argument where `requireTopologicalSphere` does, or for shares that are not
/// one a face, positive and at most 45 % of the sphere, or for options outside their range; NoMap.
/// \snippet test_headers.cpp map
Points sphereMap(const TriangleMesh& mesh, const ValuesRef& shares, const MapOptions& options = {});

/// Maps a mesh from a start, one vector a vertex, whose directions count. A start that is folded,
/// or covers the sphere more than once, is passed over.
/// @throw std::invalid_argument also for a start of another size, or with a vector that is zero or
/// not finite.
Points sphereMap(const TriangleMesh& mesh, const ValuesRef& shares, const Points& start,
                 const MapOptions& options = {});

}  // namespace spherical_springs::mesh
