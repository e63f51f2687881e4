// Polygons cut into triangles, ear by ear.
#include <algorithm>
#include <limits>
#include <queue>
#include <stdexcept>
#include <tuple>

#include "surfaces/surface.h"

namespace spherical_springs::mesh {
namespace {

using Index = std::int32_t;
using Vector2 = Eigen::Vector2d;

double cross(const Vector2& a, const Vector2& b) { return a[0] * b[1] - a[1] * b[0]; }

/// Whether a point lies in a triangle that turns counter-clockwise, or on its border.
bool isInside(const Vector2& p, const Vector2& a, const Vector2& b, const Vector2& c) {
  return cross(b - a, p - a) >= 0 && cross(c - b, p - b) >= 0 && cross(a - c, p - c) >= 0;
}

/// A polygon from which corners are cut.
class Ears {
 public:
  explicit Ears(const std::vector<Vector3>& corners)
      : places_(inPlane(corners)),
        before_(corners.size()),
        after_(corners.size()),
        versions_(corners.size(), 0),
        is_cut_(corners.size(), false) {
    const auto count = static_cast<Index>(corners.size());
    for (Index i = 0; i < count; ++i) {
      before_[i] = (i + count - 1) % count;
      after_[i] = (i + 1) % count;
    }
    for (Index i = 0; i < count; ++i) {
      if (turn(i) < 0) reflex_.push_back(i);
    }
    for (Index i = 0; i < count; ++i) offer(i);
  }

  /// Appends (before, corner, after) for every triangle.
  template <class Append>
  void cutAll(const Append& append) {
    for (Index left = static_cast<Index>(places_.size()); left > 3; --left) {
      const Index ear = next();
      append(before_[ear], ear, after_[ear]);
      remove(ear);
    }
    append(before_[remaining_], remaining_, after_[remaining_]);
  }

 private:
  using Offer = std::tuple<double, Index, int>;  // squared length of the cut, corner, version

  /// Projects along the sum of the cross products of edges (Newell's normal).
  static std::vector<Vector2> inPlane(const std::vector<Vector3>& corners) {
    Vector3 normal = Vector3::Zero();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      normal += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
    }
    int axis;
    normal.cwiseAbs().maxCoeff(&axis);
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    const double sign = normal[axis] < 0 ? -1 : 1;
    std::vector<Vector2> places;
    places.reserve(corners.size());
    for (const Vector3& corner : corners) places.push_back({corner[x], sign * corner[y]});
    return places;
  }

  double turn(Index i) const {
    return cross(places_[i] - places_[before_[i]], places_[after_[i]] - places_[i]);
  }

  /// Whether the triangle at a corner has an area, and no other corner in it. Only corners that
  /// were reflex at first can be.
  bool isEar(Index i) const {
    constexpr double kFlat = 1e-9;  // sine of the turn
    const Index first = before_[i], last = after_[i];
    const double sides = (places_[i] - places_[first]).norm() * (places_[last] - places_[i]).norm();
    if (turn(i) <= kFlat * sides) return false;
    return std::none_of(reflex_.begin(), reflex_.end(), [&](Index j) {
      return j != first && j != i && j != last && !is_cut_[j] && turn(j) < 0 &&
             isInside(places_[j], places_[first], places_[i], places_[last]);
    });
  }

  void offer(Index i) {
    const double cut = (places_[after_[i]] - places_[before_[i]]).squaredNorm();
    if (isEar(i)) offers_.emplace(-cut, -i, versions_[i]);
  }

  /// Returns the corner to cut; any where rounding leaves none that may be.
  Index next() {
    while (!offers_.empty()) {
      const Index corner = -std::get<1>(offers_.top());
      const bool holds = std::get<2>(offers_.top()) == versions_[corner];
      offers_.pop();
      if (holds) return corner;
    }
    return remaining_;
  }

  void remove(Index i) {
    const Index first = before_[i], last = after_[i];
    after_[first] = last;
    before_[last] = first;
    remaining_ = last;
    is_cut_[i] = true;
    ++versions_[i];
    for (const Index neighbour : {first, last}) {
      ++versions_[neighbour];
      offer(neighbour);
    }
  }

  std::vector<Vector2> places_;
  std::vector<Index> before_, after_;
  std::vector<Index> reflex_;
  std::vector<int> versions_;  // of each corner: how often its neighbours have changed
  std::vector<bool> is_cut_;
  std::priority_queue<Offer> offers_;
  Index remaining_ = 0;
};

}  // namespace

Surface triangulated(const PolygonMesh& file) {
  const std::size_t count = file.corners.size() - 2 * file.ends.size();
  if (count > std::numeric_limits<Index>::max() / 3) {
    throw std::invalid_argument("it has " + std::to_string(count) + " triangles; allowed: up to " +
                                std::to_string(std::numeric_limits<Index>::max() / 3));
  }
  Surface surface;
  surface.mesh.vertices.resize(3, static_cast<Eigen::Index>(file.vertices.size()));
  for (std::size_t v = 0; v < file.vertices.size(); ++v) {
    surface.mesh.vertices.col(v) = file.vertices[v];
    surface.file_vertices.push_back(static_cast<Index>(v));
  }
  surface.mesh.faces.resize(3, static_cast<Eigen::Index>(count));
  std::vector<Vector3> corners;
  for (Index f = 0; f < file.faces(); ++f) {
    const std::int32_t* const face = file.corners.data() + file.begin(f);
    corners.clear();
    for (std::size_t c = file.begin(f); c < file.ends[f]; ++c) {
      corners.push_back(file.vertices[file.corners[c]]);
    }
    const auto append = [&](Index a, Index b, Index c) {
      surface.mesh.faces.col(surface.file_faces.size()) << face[a], face[b], face[c];
      surface.file_faces.push_back(f);
    };
    if (corners.size() == 3) {
      append(0, 1, 2);
    } else {
      Ears(corners).cutAll(append);
    }
  }
  return surface;
}

}  // namespace spherical_springs::mesh
