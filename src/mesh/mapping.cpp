#include "mapping.h"

#include <algorithm>
#include <stdexcept>

#include "coverage.h"
#include "fold_free_start.h"
#include "half_edges.h"

namespace spherical_springs::mesh {
namespace {

constexpr std::int32_t kCoarsest = 400;  // vertices
constexpr double kRoundest = 0.3;        // weight of the faces' shape before the finish
constexpr double kLowering = 0.3;        // of that weight from round to round of the finish
constexpr double kSlow = 1e-2;           // drop of the energy in one step that ends a round

}  // namespace

Points Mapping::fromNothing(const Faces& faces, const Eigen::VectorXd& shares,
                            std::int32_t vertices) {
  const Decimation meshes = decimation(faces, shares, vertices, kCoarsest);
  Points points = coarsest(meshes.levels.front());
  for (std::size_t l = 0; l < meshes.levels.size(); ++l) points = finer(meshes, l, points);
  Points result(3, vertices);
  for (std::int32_t v = 0; v < vertices; ++v) result.col(meshes.vertices[v]) = points.col(v);
  return result;
}

Points Mapping::fromStart(const Faces& faces, const Eigen::VectorXd& shares, const Points& start) {
  MapEnergy energy(faces, shares, start, options_.threads);
  MapDescent descent(energy, options_.threads);
  finish(energy, descent);
  return energy.points();
}

/// Whatever the time, since before this there is no map: only when the face that has been cut has
/// shrunk, it is one again.
Points Mapping::coarsest(const MeshLevel& level) {
  constexpr int kMostIterations = 1000;
  const FoldFreeStart start =
      foldFreeStart(level.faces, HalfEdges(level.faces), level.vertex_count, level.shares);
  MapEnergy energy(start.faces, start.shares, start.points, options_.threads);
  MapDescent descent(energy, options_.threads);
  double shape = 1;
  energy.setShape(shape);
  for (int i = 0; i < kMostIterations; ++i) {
    const bool slow = descent.iterate(FaceHessian::definite) < kSlow;
    if (!slow) continue;
    Points points = energy.points().leftCols(level.vertex_count);
    if (coversOnce(level.faces, points)) return points;
    energy.setShape(shape *= kLowering);
  }
  throw std::runtime_error("the map of the coarsest mesh does not even out");
}

Points Mapping::finer(const Decimation& meshes, std::size_t l, const Points& coarse) {
  const MeshLevel& level = meshes.levels[l];
  Points points = coarse;
  points.conservativeResize(3, level.vertex_count);
  for (auto v = static_cast<std::int32_t>(coarse.cols()); v < level.vertex_count; ++v) {
    points.col(v) = placeInside(meshes.rings[v], points);
  }
  MapEnergy energy(level.faces, level.shares, points, options_.threads);
  MapDescent descent(energy, options_.threads);
  energy.setShape(kRoundest);
  evenOut(descent);
  if (l + 1 == meshes.levels.size()) finish(energy, descent);
  return energy.points();
}

void Mapping::evenOut(MapDescent& descent) {
  while (goOn() && descent.iterate(FaceHessian::definite) > kSlow) {
  }
}

/// Lowers the weight of the faces' shape, then minimises the energy that is wanted.
void Mapping::finish(MapEnergy& energy, MapDescent& descent) {
  constexpr double kLeastShape = 1e-5;
  constexpr double kNothing = 1e-9;  // drop of the energy in one step that ends it all
  const double wanted = options_.angle_weight;
  const auto done = [&] { return wanted == 0 && energy.spread() <= options_.tolerance; };
  for (double shape = kRoundest; shape > std::max(wanted, kLeastShape); shape *= kLowering) {
    energy.setShape(shape);
    while (goOn() && !done() && descent.iterate(FaceHessian::gauss_newton) > kSlow) {
    }
  }
  energy.setShape(wanted);
  while (goOn() && !done() && descent.iterate(FaceHessian::exact) > kNothing) {
  }
}

bool Mapping::goOn() {
  const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
  if (elapsed >= options_.max_time) ended_ = true;
  if (!ended_ && !options_.go_on(elapsed / options_.max_time)) ended_ = true;
  return !ended_;
}

}  // namespace spherical_springs::mesh
