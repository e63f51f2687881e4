#pragma once

#include <spherical_springs/MapMeshGoal.h>
#include <spherical_springs/MapMeshResult.h>

#include "node/map_turn.h"
#include "node/mesh_goal.h"
#include "node/news.h"
#include "simulation/runner.h"
#include "spherical_springs/maps/mesh_map.h"

namespace spherical_springs {

using MapFollower = core::Follower<mesh::MapProgress>;

/// The work of ~map_mesh: message in, map, message out. For many threads, one mapping at a time.
class MapHandler {
 public:
  /// The arguments must live longer. `threads`: of a mapping.
  MapHandler(core::Runner& runner, News& news, MapTurn& turn, const core::SceneLimits& limits,
             int threads)
      : runner_(runner), news_(news), turn_(turn), limits_(limits), threads_(threads) {}

  /// Maps a mesh, on the thread of the caller, beside all else that the node does. Only where the
  /// goal says `load` does it change the scene, in the end, whole or not at all.
  /// @param result filled as far as the work has come, even where it throws.
  /// @throw std::invalid_argument for a bad goal; what `MapTurn::Busy` throws; std::runtime_error
  /// where it was cancelled before there was a map, where none was found, or where the map could
  /// not be loaded; std::bad_alloc. Nothing has changed then.
  void map(const MapMeshGoal& message, MapMeshResult& result, MapFollower& follower);

 private:
  mesh::MeshMap mapped(const MeshGoal& goal, MapFollower& follower);
  void load(core::Scene scene);

  core::Runner& runner_;
  News& news_;
  MapTurn& turn_;
  const core::SceneLimits limits_;
  const int threads_;
};

}  // namespace spherical_springs
