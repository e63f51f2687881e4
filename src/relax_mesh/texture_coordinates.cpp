#include "relax_mesh/texture_coordinates.h"

#include <cmath>
#include <vector>

namespace spherical_springs::mesh {
namespace {

using Place = Eigen::Vector2d;

Place placeOf(const Vector3& p) {
  const double longitude = std::atan2(p.y(), p.x());
  const double latitude = std::atan2(p.z(), std::hypot(p.x(), p.y()));
  return {0.5 + longitude / (2 * core::kPi), 0.5 + latitude / core::kPi};
}

bool isPole(const Vector3& p) { return p.x() == 0 && p.y() == 0; }

class Chart {
 public:
  explicit Chart(const Points& sphere) : sphere_(sphere), raised_(sphere.cols(), kNone) {
    for (Eigen::Index i = 0; i < sphere.cols(); ++i) places_.push_back(placeOf(sphere.col(i)));
  }

  Eigen::Vector3i corners(const Eigen::Vector3i& face) {
    Eigen::Vector3i result = face;
    double easternmost = 0;
    for (int k = 0; k < 3; ++k) {
      const int vertex = face[k];
      if (!isPole(sphere_.col(vertex))) {
        easternmost = std::max(easternmost, places_[vertex].x());
      }
    }
    // No edge spans more than half a turn.
    for (int k = 0; k < 3; ++k) {
      int& corner = result[k];
      if (!isPole(sphere_.col(corner)) && places_[corner].x() < easternmost - 0.5) {
        corner = raised(corner);
      }
    }
    for (int i = 0; i < 3; ++i) {
      if (!isPole(sphere_.col(face[i]))) continue;
      const double u = (places_[result[(i + 1) % 3]].x() + places_[result[(i + 2) % 3]].x()) / 2;
      result[i] = add({u, places_[face[i]].y()});
    }
    return result;
  }

  Eigen::Matrix2Xd places() const {
    return Eigen::Map<const Eigen::Matrix2Xd>(places_.front().data(), 2, places_.size());
  }

 private:
  static constexpr int kNone = -1;

  int add(const Place& place) {
    places_.push_back(place);
    return static_cast<int>(places_.size()) - 1;
  }

  /// The vertex's place a whole turn further east.
  int raised(int vertex) {
    if (raised_[vertex] == kNone) raised_[vertex] = add(places_[vertex] + Place(1, 0));
    return raised_[vertex];
  }

  const Points& sphere_;
  std::vector<Place> places_;  // the vertices' first
  std::vector<int> raised_;    // by vertex
};

}  // namespace

TextureCoordinates longitudeLatitude(const Points& sphere, const Faces& faces) {
  Chart chart(sphere);
  Faces corners(3, faces.cols());
  for (Eigen::Index f = 0; f < faces.cols(); ++f) corners.col(f) = chart.corners(faces.col(f));
  return {chart.places(), corners};
}

}  // namespace spherical_springs::mesh
