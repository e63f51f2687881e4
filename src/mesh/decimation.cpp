#include "decimation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <tuple>

#include "coverage.h"

namespace spherical_springs::mesh {
namespace {

using Index = std::int32_t;
using Ring = std::vector<Index>;

class Decimator {
 public:
  Decimator(const Faces& faces, const Eigen::VectorXd& shares, Index vertices)
      : faces_of_(vertices), stamps_(vertices, 0), left_(vertices) {
    for (Eigen::Index f = 0; f < faces.cols(); ++f) {
      faces_.push_back({{faces(0, f), faces(1, f), faces(2, f)}, shares[f]});
      for (const Index v : faces_.back().vertices) {
        faces_of_[v].push_back(static_cast<Index>(f));
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

  /// Neighbours of `v` counter-clockwise, from `first` on or from any.
  Ring ringOf(Index v, Index first = -1) const {
    std::vector<std::pair<Index, Index>> pairs;
    for (const Index f : faces_of_[v]) {
      const auto& vertices = faces_[f].vertices;
      const auto k = std::find(vertices.begin(), vertices.end(), v) - vertices.begin();
      pairs.emplace_back(vertices[(k + 1) % 3], vertices[(k + 2) % 3]);
    }
    Ring ring = {first < 0 ? pairs.front().first : first};
    while (ring.size() < pairs.size()) {
      for (const auto& [a, b] : pairs) {
        if (a != ring.back()) continue;
        ring.push_back(b);
        break;
      }
    }
    return ring;
  }

  std::size_t valence(Index v) const { return faces_of_[v].size(); }

  /// Whether moving `v` onto `u` leaves a mesh: the link condition, T. Dey and others, 1999.
  bool mayCollapse(const Ring& ring_of_v, Index u) const {
    const Ring ring_of_u = ringOf(u);
    int common = 0;
    for (const Index w : ring_of_u) {
      common += std::count(ring_of_v.begin(), ring_of_v.end(), w);
    }
    return common == 2;
  }

  double cost(Index v, Index u, double star) const {
    constexpr double kMost = 7, kPenalty = 0.3;
    const double excess = std::max(0., static_cast<double>(valence(u) + valence(v)) - 4 - kMost);
    return star * (1 + kPenalty * excess * excess);
  }

  void propose(Index v) {
    ++stamps_[v];
    double star = 0;
    for (const Index f : faces_of_[v]) star += faces_[f].share;
    const Ring ring = ringOf(v);
    Proposal best = {-1, v, -1, stamps_[v]};
    for (const Index u : ring) {
      const double c = cost(v, u, star);
      if ((best.onto < 0 || c < best.cost) && mayCollapse(ring, u)) {
        best.cost = c;
        best.onto = u;
      }
    }
    if (best.onto >= 0) proposals_.push(best);
  }

  bool collapseNext() {
    while (!proposals_.empty()) {
      const Proposal next = proposals_.top();
      proposals_.pop();
      if (next.stamp != stamps_[next.vertex]) continue;
      // The ring of the other end may have changed since.
      if (mayCollapse(ringOf(next.vertex), next.onto)) {
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
    const std::vector<Index> faces = faces_of_[v];
    for (const Index f : faces) {
      if (has(f, u)) giveAway(f, v, u);
    }
    for (const Index f : faces) {
      if (faces_[f].gone) continue;
      std::replace(faces_[f].vertices.begin(), faces_[f].vertices.end(), v, u);
      faces_of_[u].push_back(f);
    }
    faces_of_[v].clear();
    ++stamps_[v];
    removed_.push_back(v);
    --left_;
    for (const Index w : ring) propose(w);
  }

  bool has(Index face, Index v) const {
    const auto& vertices = faces_[face].vertices;
    return std::find(vertices.begin(), vertices.end(), v) != vertices.end();
  }

  /// Leaves the share of a face between `v` and `u` to the next face round `v`.
  void giveAway(Index face, Index v, Index u) {
    Index third = -1;
    for (const Index w : faces_[face].vertices) {
      if (w != v && w != u) third = w;
      if (w != v) {
        auto& list = faces_of_[w];
        list.erase(std::find(list.begin(), list.end(), face));
      }
    }
    faces_[face].gone = true;
    for (const Index f : faces_of_[v]) {
      if (!faces_[f].gone && !has(f, u) && has(f, third)) {
        faces_[f].share += faces_[face].share;
        return;
      }
    }
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

  std::vector<Face> faces_;
  std::vector<std::vector<Index>> faces_of_;  // of each vertex
  std::vector<unsigned> stamps_;              // of the last proposal for each vertex
  std::priority_queue<Proposal> proposals_;
  std::vector<Ring> rings_;
  std::vector<Index> removed_;
  std::vector<MeshLevel> levels_;
  Index left_;
};

double angleAt(const Vector3& p, const Vector3& from, const Vector3& to) {
  return std::atan2(core::tripleProduct(p, from, to), p.cross(from).dot(p.cross(to)));
}

/// Area of the smallest face that `p` makes with its ring; negative where one may be folded.
double leastFace(const Vector3& p, const Ring& ring, const Points& points) {
  double least = 4 * core::kPi;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector3 a = points.col(ring[i]), b = points.col(ring[(i + 1) % ring.size()]);
    if (!surelyPositive(p, a, b)) return -1;
    least = std::min(least, core::solidAngle(p, a, b));
  }
  return least;
}

}  // namespace

Decimation decimation(const Faces& faces, const Eigen::VectorXd& shares, Index vertices,
                      Index coarsest) {
  return Decimator(faces, shares, vertices).run(coarsest);
}

/// Close enough to the first of the ring, on the bisector of the ring's angle there, all faces are
/// positive.
Vector3 placeInside(const Ring& ring, const Points& points) {
  const Vector3 corner = points.col(ring[0]);
  double angle = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    angle += angleAt(corner, points.col(ring[i]), points.col(ring[i + 1]));
  }
  const Vector3 second = points.col(ring[1]);
  const Vector3 along = (second - second.dot(corner) * corner).normalized();
  const Vector3 inward =
      std::cos(0.5 * angle) * along + std::sin(0.5 * angle) * corner.cross(along);
  Vector3 centre = Vector3::Zero();
  double length = 0;
  for (const Index w : ring) {
    centre += points.col(w);
    length = std::max(length, (points.col(w) - corner).norm());
  }
  Vector3 best = centre.normalized();
  double least = leastFace(best, ring, points);
  for (int halving = 0; halving < 50; ++halving, length *= 0.6) {
    const Vector3 place = (corner + length * inward).normalized();
    const double smallest = leastFace(place, ring, points);
    if (smallest > least) {
      least = smallest;
      best = place;
    }
  }
  return best;
}

}  // namespace spherical_springs::mesh
