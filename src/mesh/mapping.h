#pragma once

#include <chrono>
#include <limits>
#include <optional>

#include "decimation.h"
#include "map_descent.h"
#include "spherical_springs/mesh/sphere_map.h"

namespace spherical_springs::mesh {

/// One map under way, of a mesh that `requireTopologicalSphere` lets pass.
class Mapping {
 public:
  /// `options` must live longer.
  explicit Mapping(const MapOptions& options) : options_(options) {}

  Points fromNothing(const Faces& faces, const Eigen::VectorXd& shares, std::int32_t vertices);
  /// `start` must cover the sphere once.
  Points fromStart(const Faces& faces, const Eigen::VectorXd& shares, const Points& start);

 private:
  using Clock = std::chrono::steady_clock;

  struct Candidate {
    Points points;
    double spread = std::numeric_limits<double>::infinity();
  };

  std::optional<Points> coarsest(const MeshLevel& level);
  std::optional<Candidate> prepared(const Decimation& meshes);
  void roundOff(MapEnergy& energy, MapDescent& descent);
  Candidate finished(const Faces& faces, const Eigen::VectorXd& shares, const Points& points);
  bool wanting(const MapEnergy& energy);
  bool goOn();

  const MapOptions& options_;
  const Clock::time_point begin_ = Clock::now();
  bool ended_ = false;
  bool has_map_ = false;
};

}  // namespace spherical_springs::mesh
