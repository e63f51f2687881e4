#include "maps/mapping.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "maps/basin_hopping.h"
#include "maps/coverage.h"
#include "maps/fold_free_start.h"
#include "maps/half_edges.h"
#include "maps/insertion.h"

namespace spherical_springs::mesh {
namespace {

constexpr double kRoundest = 0.1;   // weight of the faces' shape before the finish
constexpr double kLowering = 0.3;   // of that weight from round to round
constexpr double kSlow = 1e-2;      // drop of the energy in one step that ends a round
constexpr double kNothing = 1e-9;   // drop that ends the finish
constexpr double kFaint = 1e-9;     // shape that holds edges below pi, and hardly anything else
constexpr double kOfAngles = 0.15;  // weight of the faces' shape where the angle weight is 1

constexpr std::int32_t kMostCoarsest = 5000;  // vertices of a coarsest mesh

/// Sizes of coarsest meshes to begin with, one after another while the map is not good enough. The
/// way from a small one is short; one that is too small has lost thin limbs. Each leads to a
/// minimum of its own, so that more of them help where there is time.
std::vector<std::int32_t> coarsestSizes(std::int32_t vertices) {
  constexpr std::int32_t kLeast = 100;
  constexpr int kMore = 24;
  constexpr double kGoldenRatio = 0.618033988749895;
  const std::int32_t most = std::min(vertices, kMostCoarsest), least = std::min(most, kLeast);
  std::vector<std::int32_t> sizes;
  const auto add = [&](std::int32_t size) {
    if (std::find(sizes.begin(), sizes.end(), size) == sizes.end()) sizes.push_back(size);
  };
  for (const std::int32_t size : {400, most, 1000, 2500}) add(std::min(size, most));
  const double ratio = static_cast<double>(most) / least;
  for (int i = 1; i <= kMore; ++i) {
    const double place = i * kGoldenRatio - std::floor(i * kGoldenRatio);
    add(static_cast<std::int32_t>(least * std::pow(ratio, place)));
  }
  return sizes;
}

}  // namespace

Points Mapping::run(std::optional<Points> start) {
  unlessItEnds([&] { search(std::move(start)); });
  if (best_.points.size() == 0 && !candidates_.empty()) best_ = std::move(candidates_.back());
  if (best_.points.size() == 0) throw NoMap("no map without folds was found");
  if (clock_.outOfMemory()) options_.out_of_memory();
  return std::move(best_.points);
}

/// Works until time or memory is over, which ends the search where there is a map.
template <class Work>
void Mapping::unlessItEnds(const Work& work) {
  try {
    work();
  } catch (const TimeIsOver&) {
  } catch (const std::bad_alloc&) {
    if (!clock_.hasMap()) throw;
    clock_.endWithoutMemory();
  }
}

/// A candidate is moved into its place, which takes no memory, so that none is lost.
void Mapping::search(std::optional<Points> start) {
  constexpr double kPromising = 10;  // tolerances
  // Where starts are cheap, the best of several is finished: of some twenty for 800 vertices, and
  // of a small coarsest mesh and the mesh itself wherever that is one to begin with.
  const double several =
      std::max(vertices_ > kMostCoarsest ? 1. : 2., std::pow(4000. / vertices_, 2));
  std::vector<std::int32_t> sizes = coarsestSizes(vertices_);
  candidates_.reserve(sizes.size() + 1);
  if (start) add(roundedOff(std::move(*start)));
  int tried = 0;
  while (!clock_.hasMap() || (best_.spread > wantedSpread() && clock_.goOn())) {
    const bool promising =
        !candidates_.empty() && (candidates_.back().spread < kPromising * wantedSpread() ||
                                 tried >= several || clock_.ended());
    if (!promising && !sizes.empty()) {
      if (auto next = prepared(sizes.front())) add(std::move(*next));
      sizes.erase(sizes.begin());
      ++tried;
    } else if (!candidates_.empty()) {
      Candidate chosen = std::move(candidates_.back());
      candidates_.pop_back();
      Candidate next = finished(std::move(chosen));
      tried = 0;
      if (best_.points.size() == 0 || next.spread < best_.spread) best_ = std::move(next);
    } else {
      break;
    }
  }
}

/// Best last.
void Mapping::add(Candidate candidate) {
  candidates_.push_back(std::move(candidate));
  std::sort(candidates_.begin(), candidates_.end(),
            [](const Candidate& a, const Candidate& b) { return a.spread > b.spread; });
}

/// Tells the clock of the map that would come out now, where one under way has a spread.
void Mapping::tellOfMap(double spread) {
  spread = std::min(spread, best_.spread);
  if (!candidates_.empty()) spread = std::min(spread, candidates_.back().spread);
  clock_.haveMap(spread);
}

/// Where areas are not all that counts, the first map is as good as any.
double Mapping::wantedSpread() const {
  return options_.angle_weight > 0 ? std::numeric_limits<double>::max() : options_.tolerance;
}

double Mapping::wantedShape() const { return kOfAngles * options_.angle_weight; }

/// A map that begins without the largest face, or, where that does not become one again, without
/// the next largest.
std::optional<Points> Mapping::coarsestMap(const MeshLevel& level) {
  constexpr std::size_t kMostCuts = 8;
  std::vector<Eigen::Index> faces(level.shares.size());
  std::iota(faces.begin(), faces.end(), 0);
  std::stable_sort(faces.begin(), faces.end(), [&](Eigen::Index a, Eigen::Index b) {
    return level.shares[a] > level.shares[b];
  });
  faces.resize(std::min(faces.size(), kMostCuts));
  for (const Eigen::Index cut : faces) {
    if (auto points = coarsestMap(level, cut)) return points;
    if (clock_.ended()) break;
  }
  return {};
}

/// Whatever the time, while there is no other map: only when the face that has been cut has shrunk,
/// it is one again.
std::optional<Points> Mapping::coarsestMap(const MeshLevel& level, Eigen::Index cut) {
  constexpr int kMostIterations = 600;
  constexpr double kLeastShape = 1e-4;
  const FoldFreeStart start =
      foldFreeStart(level.faces, HalfEdges(level.faces), level.vertex_count, level.shares, cut);
  MapEnergy energy(start.faces, start.shares, start.points, options_.threads, checkpoint_);
  energy.setWeights(FaceWeights::root_of_share);
  MapDescent descent(energy, options_.threads, checkpoint_);
  int iterations = 0;
  const auto given_up = [&] { return iterations >= kMostIterations || clock_.ended(); };
  for (double shape = 1; shape > kLeastShape && !given_up(); shape *= kLowering) {
    energy.setShape(shape);
    descent.runWithSweeps(FaceHessian::definite, kSlow, [&] {
      return ++iterations < kMostIterations && (clock_.goOn() || !clock_.hasMap());
    });
    Points points = energy.points().leftCols(level.vertex_count);
    if (coversOnce(level.faces, points)) return points;
  }
  return {};
}

/// From a map of the coarsest mesh to one of the mesh itself, if none of its faces folds.
std::optional<Points> Mapping::evenedOut(const Decimation& meshes) {
  constexpr int kSweepsBefore = 10;  // the first step of all vertices together
  std::optional<Points> start = coarsestMap(meshes.levels.front());
  if (!start) return {};
  Points points = std::move(*start);
  for (const MeshLevel& level : meshes.levels) {
    auto v = static_cast<std::int32_t>(points.cols());
    points.conservativeResize(3, level.vertex_count);
    for (; v < level.vertex_count; ++v) {
      clock_.check();
      points.col(v) = placeInside(meshes.rings[v], points);
    }
    MapEnergy energy(level.faces, level.shares, points, options_.threads, checkpoint_);
    MapDescent descent(energy, options_.threads, checkpoint_);
    energy.setWeights(FaceWeights::root_of_share);
    energy.setShape(kRoundest);
    for (int i = 0; i < kSweepsBefore && clock_.goOn(); ++i) energy.sweep();
    descent.runWithSweeps(FaceHessian::definite, kSlow, [&] { return clock_.goOn(); });
    points = energy.points();
  }
  if (!coversOnce(meshes.levels.back().faces, points)) return {};
  Points result(3, vertices_);
  for (std::int32_t v = 0; v < vertices_; ++v) result.col(meshes.vertices[v]) = points.col(v);
  return result;
}

/// Everything but the last phase, which is the longest, from a coarsest mesh of a size. While there
/// is no map, on the way there with shares that differ less and less.
std::optional<Mapping::Candidate> Mapping::prepared(std::int32_t size) {
  constexpr int kMostRoots = 5;  // from a range of 1e6 to 1.5
  Decimation meshes = decimation(faces_, shares_, vertices_, size, checkpoint_);
  for (int root = 0; root <= kMostRoots; ++root) {
    if (auto points = evenedOut(meshes)) return roundedOff(std::move(*points));
    if (clock_.hasMap()) break;
    for (MeshLevel& level : meshes.levels) {
      level.shares = level.shares.cwiseSqrt();
      level.shares *= 4 * core::kPi / level.shares.sum();
    }
  }
  return {};
}

/// Lowers the weight of the faces' shape, as long as that is quick.
Mapping::Candidate Mapping::roundedOff(Points points) {
  constexpr double kLeastShape = 1e-5;
  constexpr double kAlikeFrom = 1e-3;  // where areas are right enough for all faces to count alike
  Candidate start{std::move(points)};
  start.spread = spreadOf(faces_, shares_, start.points);
  tellOfMap(start.spread);
  return improved(std::move(start), [&](MapEnergy& energy, MapDescent& descent) {
    for (double shape = kRoundest; shape > std::max(wantedShape(), kLeastShape);
         shape *= kLowering) {
      energy.setShape(shape);
      energy.setWeights(shape > kAlikeFrom ? FaceWeights::root_of_share : FaceWeights::equal);
      descent.runWithSweeps(FaceHessian::gauss_newton, kSlow, [&] { return wanting(energy); });
    }
  });
}

/// Minimises the energy that is wanted.
Mapping::Candidate Mapping::finished(Candidate candidate) {
  return improved(std::move(candidate), [&](MapEnergy& energy, MapDescent& descent) {
    if (options_.angle_weight > 0) {
      energy.setShape(wantedShape());
      descent.run(FaceHessian::exact, kNothing, [&] { return wanting(energy); });
    } else {
      finishAreas(energy, descent);
    }
  });
}

/// Returns how far `improve(energy, descent)` comes from a map before time or memory is over.
template <class Improve>
Mapping::Candidate Mapping::improved(Candidate map, const Improve& improve) {
  std::optional<MapEnergy> energy;
  unlessItEnds([&] {
    energy.emplace(faces_, shares_, map.points, options_.threads, checkpoint_);
    MapDescent descent(*energy, options_.threads, checkpoint_);
    improve(*energy, descent);
  });
  if (!energy) return map;
  energy->writePoints(map.points);
  unlessItEnds([&] { map.spread = energy->spread(); });
  return map;
}

/// Steps of all vertices and hops of patches in turn, more of what lowers the energy more: what is
/// left is the matter of a few patches mostly, which would hold all others up.
void Mapping::finishAreas(MapEnergy& energy, MapDescent& descent) {
  constexpr int kFewSteps = 8, kManySteps = 64, kMostInVain = 10;
  constexpr double kLittle = 1e-3;  // fall of the energy, as a share
  energy.setShape(kFaint);
  BasinHopping hopping(faces_, shares_, vertices_, kFaint, options_.threads, checkpoint_);
  int steps = kFewSteps, in_vain = 0;
  while (wanting(energy) && in_vain < kMostInVain) {
    const double before = energy.valueHere();
    int step = 0;
    descent.run(FaceHessian::exact, kNothing, [&] { return wanting(energy) && step++ < steps; });
    const double fall = 1 - energy.valueHere() / before;

    const bool worthwhile = hopped(hopping, energy, std::max(fall / 8, kLittle));
    steps = worthwhile ? kFewSteps : std::min(2 * steps, kManySteps);
    in_vain = worthwhile || fall > kLittle ? 0 : in_vain + 1;
  }
}

/// Hops as long as each round lowers the energy by the share `worthwhile`.
/// @return whether the first has done so.
bool Mapping::hopped(BasinHopping& hopping, MapEnergy& energy, double worthwhile) {
  constexpr int kMostRounds = 5;
  Points map = energy.points();
  for (int round = 0; round < kMostRounds && wanting(energy); ++round) {
    const double fall = hopping.hop(map);
    energy.place(map);
    if (fall < worthwhile) return round > 0;
  }
  return true;
}

/// Whether to go on, towards the tolerance unless areas are not all that counts.
bool Mapping::wanting(const MapEnergy& energy) {
  const double spread = energy.spread();
  tellOfMap(spread);
  return clock_.goOn() && (options_.angle_weight > 0 || spread > options_.tolerance);
}

}  // namespace spherical_springs::mesh
