#include "maps/decimation.h"

#include <algorithm>
#include <array>
#include <queue>
#include <tuple>
#include <utility>

namespace spherical_springs::mesh {
namespace {

using Index = std::int32_t;
using Ring = std::vector<Index>;

/// Removing a vertex takes as long as there are faces round it, but for a logarithm, however many
/// there are round its neighbours.
class Decimator {
 public:
  Decimator(const Faces& faces, const Eigen::VectorXd& shares, Index vertices,
            const core::Checkpoint& checkpoint)
      : checkpoint_(checkpoint),
        faces_of_(vertices),
        valences_(vertices, 0),
        proposed_valences_(vertices, 0),
        stamps_(vertices, 0),
        mark_(vertices, 0),
        left_(vertices) {
    for (Eigen::Index f = 0; f < faces.cols(); ++f) {
      faces_.push_back({{faces(0, f), faces(1, f), faces(2, f)}, shares[f]});
      for (int k = 0; k < 3; ++k) {
        faces_of_[faces(k, f)].push_back(static_cast<Index>(f));
        ++valences_[faces(k, f)];
      }
    }
    rings_.resize(vertices);
    addLevel();
  }

  Decimation run(Index coarsest) {
    constexpr double kRatio = 3;
    for (Index v = 0; v < static_cast<Index>(faces_of_.size()); ++v) propose(v);
    while (left_ > coarsest) {
      const auto target = std::max(coarsest, static_cast<Index>(left_ / kRatio));
      const Index before = left_;
      while (left_ > target && collapseNext()) {
      }
      if (left_ == before) break;
      addLevel();
    }
    return renumbered();
  }

 private:
  static constexpr Index kMany = 64;  // faces of a vertex, too many to be looked at often

  struct Face {
    std::array<Index, 3> vertices;
    double share;
    bool gone = false;
  };
  struct Proposal {
    double cost;
    Index vertex, onto;
    unsigned stamp;
    bool operator<(const Proposal& other) const {
      return std::tie(cost, vertex, onto) > std::tie(other.cost, other.vertex, other.onto);
    }
  };

  template <class Body>
  void forEachFace(Index v, const Body& body) const {
    for (const Index f : faces_of_[v]) {
      if (!faces_[f].gone) body(f);
    }
  }

  /// The corner of a face that follows `v`.
  Index after(Index face, Index v) const {
    const auto& [a, b, c] = faces_[face].vertices;
    return v == a ? b : v == b ? c : a;
  }

  /// Neighbours of `v` counter-clockwise, from `first` on or from any.
  Ring ringOf(Index v, Index first = -1) const {
    std::vector<std::pair<Index, Index>> pairs;
    forEachFace(v, [&](Index f) {
      const Index next = after(f, v);
      pairs.emplace_back(next, after(f, next));
    });
    Ring ring = {first < 0 ? pairs.front().first : first};
    std::sort(pairs.begin(), pairs.end());
    while (ring.size() < pairs.size()) {
      ring.push_back(
          std::lower_bound(pairs.begin(), pairs.end(), std::make_pair(ring.back(), Index(0)))
              ->second);
    }
    return ring;
  }

  bool areNeighbours(Index a, Index b) const {
    if (valences_[b] < valences_[a]) std::swap(a, b);
    const auto& faces = faces_of_[a];
    return std::any_of(faces.begin(), faces.end(),
                       [&](Index f) { return !faces_[f].gone && has(f, b); });
  }

  /// Marks the ring round a vertex for `mayCollapse`.
  void mark(const Ring& ring) {
    ++marks_;
    for (const Index w : ring) mark_[w] = marks_;
  }

  /// Whether moving `v`, whose ring is marked, onto `u` of that ring leaves a mesh: the link
  /// condition, T. Dey and others, 1999.
  bool mayCollapse(const Ring& ring_of_v, Index u) const {
    int common = 0;
    if (valences_[u] <= std::max(kMany, static_cast<Index>(ring_of_v.size()))) {
      forEachFace(u, [&](Index f) { common += mark_[after(f, u)] == marks_; });
    } else {
      for (const Index w : ring_of_v) common += w != u && areNeighbours(w, u);
    }
    return common == 2;
  }

  double cost(Index v, Index u, double star) const {
    constexpr double kMost = 7, kPenalty = 0.3;
    const double excess =
        std::max(0., static_cast<double>(valences_[u] + valences_[v]) - 4 - kMost);
    return star * (1 + kPenalty * excess * excess);
  }

  void propose(Index v) {
    checkpoint_();
    ++stamps_[v];
    proposed_valences_[v] = valences_[v];
    double star = 0;
    forEachFace(v, [&](Index f) { star += faces_[f].share; });
    const Ring ring = ringOf(v);
    mark(ring);
    std::vector<std::pair<double, std::size_t>> costs;
    for (std::size_t i = 0; i < ring.size(); ++i) costs.emplace_back(cost(v, ring[i], star), i);
    std::sort(costs.begin(), costs.end());
    for (const auto& [c, i] : costs) {
      if (!mayCollapse(ring, ring[i])) continue;
      proposals_.push({c, v, ring[i], stamps_[v]});
      return;
    }
  }

  /// Whether the proposal for a vertex is too old. A vertex of many faces is late in the queue, so
  /// that its proposal may stand until half of the faces are gone, or as many have come.
  bool isOutdated(Index v) const {
    const Index before = proposed_valences_[v];
    return valences_[v] <= kMany || valences_[v] < before / 2 || valences_[v] > 2 * before;
  }

  bool collapseNext() {
    while (!proposals_.empty()) {
      const Proposal next = proposals_.top();
      proposals_.pop();
      if (next.stamp != stamps_[next.vertex]) continue;
      // The rings of both ends may have changed since.
      const Ring ring = ringOf(next.vertex);
      mark(ring);
      if (mark_[next.onto] == marks_ && mayCollapse(ring, next.onto)) {
        collapse(next.vertex, next.onto);
        return true;
      }
      propose(next.vertex);
    }
    return false;
  }

  void collapse(Index v, Index u) {
    Ring& ring = rings_[v];
    ring = ringOf(v, u);
    const std::vector<Index> faces = std::move(faces_of_[v]);
    for (const Index f : faces) {
      if (!faces_[f].gone && has(f, u)) giveAway(f, v, u, faces);
    }
    for (const Index f : faces) {
      if (faces_[f].gone) continue;
      std::replace(faces_[f].vertices.begin(), faces_[f].vertices.end(), v, u);
      faces_of_[u].push_back(f);
      ++valences_[u];
    }
    faces_of_[v].clear();
    ++stamps_[v];
    removed_.push_back(v);
    --left_;
    for (const Index w : ring) {
      if (isOutdated(w)) propose(w);
    }
  }

  bool has(Index face, Index v) const {
    const auto& vertices = faces_[face].vertices;
    return std::find(vertices.begin(), vertices.end(), v) != vertices.end();
  }

  /// Leaves the share of a face between `v` and `u` to the next of the `faces` round `v`.
  void giveAway(Index face, Index v, Index u, const std::vector<Index>& faces) {
    Index third = -1;
    faces_[face].gone = true;
    for (const Index w : faces_[face].vertices) {
      if (w != v && w != u) third = w;
      if (w != v) loseFace(w);
    }
    for (const Index f : faces) {
      if (!faces_[f].gone && !has(f, u) && has(f, third)) {
        faces_[f].share += faces_[face].share;
        return;
      }
    }
  }

  /// Takes faces that are gone off a vertex's list when they are half of it.
  void loseFace(Index v) {
    --valences_[v];
    auto& list = faces_of_[v];
    if (list.size() < 2 * static_cast<std::size_t>(valences_[v])) return;
    list.erase(std::remove_if(list.begin(), list.end(), [&](Index f) { return faces_[f].gone; }),
               list.end());
  }

  void addLevel() {
    MeshLevel level;
    level.vertex_count = left_;
    Eigen::Index count = 0;
    for (const Face& face : faces_) count += !face.gone;
    level.faces.resize(3, count);
    level.shares.resize(count);
    Eigen::Index f = 0;
    for (const Face& face : faces_) {
      if (face.gone) continue;
      level.faces.col(f) << face.vertices[0], face.vertices[1], face.vertices[2];
      level.shares[f++] = face.share;
    }
    levels_.push_back(std::move(level));
  }

  Decimation renumbered() {
    Decimation result;
    for (Index v = 0; v < static_cast<Index>(rings_.size()); ++v) {
      if (rings_[v].empty()) result.vertices.push_back(v);
    }
    result.vertices.insert(result.vertices.end(), removed_.rbegin(), removed_.rend());
    std::vector<Index> numbers(rings_.size());
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      numbers[result.vertices[n]] = static_cast<Index>(n);
    }
    result.rings.resize(rings_.size());
    for (std::size_t v = 0; v < rings_.size(); ++v) {
      for (const Index w : rings_[v]) result.rings[numbers[v]].push_back(numbers[w]);
    }
    result.levels.assign(levels_.rbegin(), levels_.rend());
    for (MeshLevel& level : result.levels) {
      for (Eigen::Index c = 0; c < level.faces.size(); ++c) {
        level.faces(c) = numbers[level.faces(c)];
      }
    }
    return result;
  }

  const core::Checkpoint& checkpoint_;
  std::vector<Face> faces_;
  std::vector<std::vector<Index>> faces_of_;  // of each vertex, and some that are gone
  std::vector<Index> valences_;               // faces of each vertex that are not gone
  std::vector<Index> proposed_valences_;      // when there was the last proposal
  std::vector<unsigned> stamps_;              // of the last proposal for each vertex
  std::vector<unsigned> mark_;                // of each vertex: `marks_` in the ring marked last
  unsigned marks_ = 0;
  std::priority_queue<Proposal> proposals_;
  std::vector<Ring> rings_;
  std::vector<Index> removed_;
  std::vector<MeshLevel> levels_;
  Index left_;
};

}  // namespace

Decimation decimation(const Faces& faces, const Eigen::VectorXd& shares, Index vertices,
                      Index coarsest, const core::Checkpoint& checkpoint) {
  return Decimator(faces, shares, vertices, checkpoint).run(coarsest);
}

}  // namespace spherical_springs::mesh
