#include "maps/patch.h"

#include <algorithm>

namespace spherical_springs::mesh {

Points Patch::of(const Points& map) const {
  Points result(3, static_cast<Eigen::Index>(vertices.size()));
  for (std::size_t n = 0; n < vertices.size(); ++n) result.col(n) = map.col(vertices[n]);
  return result;
}

void Patch::putInto(Points& map, const Points& points) const {
  for (std::int32_t n = 0; n < free; ++n) map.col(vertices[n]) = points.col(n);
}

PatchCutter::PatchCutter(const Faces& faces, const Eigen::VectorXd& shares, std::int32_t vertices)
    : faces_(faces),
      shares_(shares),
      half_edges_(faces),
      outgoing_(vertices),
      valences_(vertices, 0),
      taken_(vertices, false) {
  for (HalfEdges::Index h = 0; h < half_edges_.size(); ++h) {
    outgoing_[half_edges_.origin(h)] = h;
    ++valences_[half_edges_.origin(h)];
  }
}

void PatchCutter::begin() { std::fill(taken_.begin(), taken_.end(), false); }

template <class Body>
void PatchCutter::forEachNeighbour(std::int32_t vertex, const Body& body) const {
  HalfEdges::Index h = outgoing_[vertex];
  do {
    body(h);
    h = half_edges_.turned(h);
  } while (h != outgoing_[vertex]);
}

Patch PatchCutter::cut(Eigen::Index face, std::size_t size) {
  constexpr std::int32_t kOutside = -1;
  Patch patch;
  std::vector<std::int32_t> numbers(outgoing_.size(), kOutside);
  const auto add = [&](std::int32_t vertex) {
    if (numbers[vertex] != kOutside) return;
    numbers[vertex] = static_cast<std::int32_t>(patch.vertices.size());
    patch.vertices.push_back(vertex);
  };
  const auto addFree = [&](std::int32_t vertex) {
    if (!taken_[vertex] && valences_[vertex] <= size) add(vertex);
  };
  for (int k = 0; k < 3; ++k) addFree(faces_(k, face));
  for (std::size_t n = 0; n < patch.vertices.size() && patch.vertices.size() < size; ++n) {
    forEachNeighbour(patch.vertices[n], [&](auto h) { addFree(half_edges_.target(h)); });
  }
  patch.free = static_cast<std::int32_t>(patch.vertices.size());

  std::vector<Eigen::Index> faces;
  for (std::int32_t n = 0; n < patch.free; ++n) {
    forEachNeighbour(patch.vertices[n], [&](auto h) {
      add(half_edges_.target(h));
      faces.push_back(HalfEdges::face(h));
    });
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  patch.faces.resize(3, static_cast<Eigen::Index>(faces.size()));
  patch.shares.resize(patch.faces.cols());
  for (Eigen::Index f = 0; f < patch.faces.cols(); ++f) {
    for (int k = 0; k < 3; ++k) patch.faces(k, f) = numbers[faces_(k, faces[f])];
    patch.shares[f] = shares_[faces[f]];
  }
  for (const std::int32_t vertex : patch.vertices) taken_[vertex] = true;
  return patch;
}

}  // namespace spherical_springs::mesh
