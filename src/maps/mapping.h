#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "maps/basin_hopping.h"
#include "maps/decimation.h"
#include "maps/map_clock.h"
#include "maps/map_descent.h"
#include "spherical_springs/maps/sphere_map.h"

namespace spherical_springs::mesh {

/// One map under way, of a mesh that `requireTopologicalSphere` lets pass.
class Mapping {
 public:
  /// The arguments must live longer.
  Mapping(const Faces& faces, const Eigen::VectorXd& shares, std::int32_t vertices,
          const MapOptions& options)
      : faces_(faces), shares_(shares), vertices_(vertices), options_(options), clock_(options) {}

  /// `start`, if any, must cover the sphere once.
  Points run(std::optional<Points> start);

 private:
  struct Candidate {
    Points points;
    double spread = std::numeric_limits<double>::infinity();
  };
  using Candidates = std::vector<Candidate>;

  template <class Work>
  void unlessItEnds(const Work& work);
  void search(std::optional<Points> start);
  void add(Candidate candidate);
  void tellOfMap(double spread);
  std::optional<Points> coarsestMap(const MeshLevel& level);
  std::optional<Points> coarsestMap(const MeshLevel& level, Eigen::Index cut);
  std::optional<Points> evenedOut(const Decimation& meshes);
  std::optional<Candidate> prepared(std::int32_t size);
  Candidate roundedOff(Points points);
  Candidate finished(Candidate candidate);
  template <class Improve>
  Candidate improved(Candidate map, const Improve& improve);
  void finishAreas(MapEnergy& energy, MapDescent& descent);
  bool hopped(BasinHopping& hopping, MapEnergy& energy, double worthwhile);
  double wantedSpread() const;
  double wantedShape() const;
  bool wanting(const MapEnergy& energy);

  const Faces& faces_;
  const Eigen::VectorXd& shares_;
  const std::int32_t vertices_;
  const MapOptions& options_;
  MapClock clock_;
  const core::Checkpoint checkpoint_ = [this] { clock_.check(); };
  Candidates candidates_;  // that are not finished, the best last
  Candidate best_;         // of those that are
};

}  // namespace spherical_springs::mesh
