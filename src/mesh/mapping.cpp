#include "mapping.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "coverage.h"
#include "fold_free_start.h"
#include "half_edges.h"

namespace spherical_springs::mesh {
namespace {

constexpr double kRoundest = 0.3;  // weight of the faces' shape before the finish
constexpr double kLowering = 0.3;  // of that weight from round to round
constexpr double kSlow = 1e-2;     // drop of the energy in one step that ends a round

/// Sizes of coarsest meshes to begin with, one after another while the map is not good enough. The
/// way from a small one is short; one that is too small has lost thin limbs.
std::vector<std::int32_t> coarsestSizes(std::int32_t vertices) {
  constexpr std::int32_t kManageable = 5000;
  std::vector<std::int32_t> sizes = {std::min(400, vertices)};
  for (const std::int32_t size : {std::min(vertices, kManageable), 1000, 200, 2500}) {
    if (size <= vertices && std::find(sizes.begin(), sizes.end(), size) == sizes.end()) {
      sizes.push_back(size);
    }
  }
  return sizes;
}

}  // namespace

Points Mapping::fromNothing(const Faces& faces, const Eigen::VectorXd& shares,
                            std::int32_t vertices) {
  constexpr double kPromising = 10;  // tolerances
  std::vector<std::int32_t> sizes = coarsestSizes(vertices);
  std::vector<Candidate> candidates;
  Candidate best;
  const auto worse = [](const Candidate& a, const Candidate& b) { return a.spread > b.spread; };
  while (best.spread > options_.tolerance && (best.points.size() == 0 || goOn())) {
    const bool promising = !candidates.empty() &&
                           (candidates.back().spread < kPromising * options_.tolerance || ended_);
    if (!promising && !sizes.empty()) {
      const Decimation meshes = decimation(faces, shares, vertices, sizes.front());
      sizes.erase(sizes.begin());
      if (auto next = prepared(meshes)) candidates.push_back(std::move(*next));
      has_map_ = !candidates.empty() || best.points.size() > 0;
      std::sort(candidates.begin(), candidates.end(), worse);
    } else if (!candidates.empty()) {
      Candidate next = finished(faces, shares, candidates.back().points);
      candidates.pop_back();
      if (worse(best, next)) best = std::move(next);
    } else {
      break;
    }
  }
  if (best.points.size() == 0) throw std::runtime_error("no start evens out");
  return best.points;
}

Points Mapping::fromStart(const Faces& faces, const Eigen::VectorXd& shares, const Points& start) {
  MapEnergy energy(faces, shares, start, options_.threads);
  MapDescent descent(energy, options_.threads);
  roundOff(energy, descent);
  return finished(faces, shares, energy.points()).points;
}

/// Whatever the time, while there is no other map: only when the face that has been cut has shrunk,
/// it is one again.
std::optional<Points> Mapping::coarsest(const MeshLevel& level) {
  constexpr int kMostIterations = 600;
  const FoldFreeStart start =
      foldFreeStart(level.faces, HalfEdges(level.faces), level.vertex_count, level.shares);
  MapEnergy energy(start.faces, start.shares, start.points, options_.threads);
  MapDescent descent(energy, options_.threads);
  int iterations = 0;
  for (double shape = 1; iterations < kMostIterations && !(has_map_ && ended_);
       shape *= kLowering) {
    energy.setShape(shape);
    descent.run(FaceHessian::definite, kSlow,
                [&] { return ++iterations < kMostIterations && (!has_map_ || goOn()); });
    Points points = energy.points().leftCols(level.vertex_count);
    if (coversOnce(level.faces, points)) return points;
  }
  return {};
}

/// Everything but the last phase, which is the longest.
std::optional<Mapping::Candidate> Mapping::prepared(const Decimation& meshes) {
  std::optional<Points> start = coarsest(meshes.levels.front());
  if (!start) return {};
  Points points = std::move(*start);
  for (const MeshLevel& level : meshes.levels) {
    auto v = static_cast<std::int32_t>(points.cols());
    points.conservativeResize(3, level.vertex_count);
    for (; v < level.vertex_count; ++v) points.col(v) = placeInside(meshes.rings[v], points);
    MapEnergy energy(level.faces, level.shares, points, options_.threads);
    MapDescent descent(energy, options_.threads);
    energy.setShape(kRoundest);
    descent.run(FaceHessian::definite, kSlow, [&] { return goOn(); });
    if (&level == &meshes.levels.back()) roundOff(energy, descent);
    points = energy.points();
  }
  Candidate result;
  const MeshLevel& whole = meshes.levels.back();
  result.spread = MapEnergy(whole.faces, whole.shares, points, options_.threads).spread();
  result.points.resize(3, points.cols());
  for (Eigen::Index v = 0; v < points.cols(); ++v) {
    result.points.col(meshes.vertices[v]) = points.col(v);
  }
  return result;
}

/// Lowers the weight of the faces' shape, as long as that is quick.
void Mapping::roundOff(MapEnergy& energy, MapDescent& descent) {
  constexpr double kLeastShape = 1e-5;
  for (double shape = kRoundest; shape > std::max(options_.angle_weight, kLeastShape);
       shape *= kLowering) {
    energy.setShape(shape);
    descent.run(FaceHessian::gauss_newton, kSlow, [&] { return wanting(energy); });
  }
}

/// Minimises the energy that is wanted.
Mapping::Candidate Mapping::finished(const Faces& faces, const Eigen::VectorXd& shares,
                                     const Points& points) {
  constexpr double kNothing = 1e-9;  // drop of the energy in one step that ends it
  MapEnergy energy(faces, shares, points, options_.threads);
  MapDescent descent(energy, options_.threads);
  energy.setShape(options_.angle_weight);
  descent.run(FaceHessian::exact, kNothing, [&] { return wanting(energy); });
  return {energy.points(), energy.spread()};
}

/// Whether to go on, towards the tolerance unless areas are not all that counts.
bool Mapping::wanting(const MapEnergy& energy) {
  return goOn() && (options_.angle_weight > 0 || energy.spread() > options_.tolerance);
}

bool Mapping::goOn() {
  const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
  if (elapsed >= options_.max_time) ended_ = true;
  if (!ended_ && !options_.go_on(elapsed / options_.max_time)) ended_ = true;
  return !ended_;
}

}  // namespace spherical_springs::mesh
