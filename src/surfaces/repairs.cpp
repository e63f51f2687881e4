#include "surfaces/repairs.h"

#include <algorithm>
#include <array>
#include <utility>

#include "maps/mesh_pieces.h"

namespace spherical_springs::mesh {
namespace {

using Index = std::int32_t;

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// Keeps the faces that `keep` says yes to. Returns how many have gone.
template <class Keep>
std::size_t keepFaces(Surface& surface, const Keep& keep) {
  Index kept = 0;
  for (Index f = 0; f < surface.mesh.faces.cols(); ++f) {
    if (!keep(f)) continue;
    surface.mesh.faces.col(kept) = surface.mesh.faces.col(f).eval();
    surface.file_faces[kept] = surface.file_faces[f];
    ++kept;
  }
  const std::size_t gone = surface.file_faces.size() - kept;
  surface.mesh.faces.conservativeResize(3, kept);
  surface.file_faces.resize(kept);
  return gone;
}

std::size_t leaveOutUnusedVertices(Surface& surface) {
  std::vector<Index> places(surface.file_vertices.size(), 0);
  for (Index c = 0; c < surface.mesh.faces.size(); ++c) places[surface.mesh.faces(c)] = 1;
  Index kept = 0;
  for (std::size_t v = 0; v < places.size(); ++v) {
    if (places[v] == 0) continue;
    surface.mesh.vertices.col(kept) = surface.mesh.vertices.col(v).eval();
    surface.file_vertices[kept] = surface.file_vertices[v];
    places[v] = kept++;
  }
  const std::size_t gone = places.size() - kept;
  if (gone == 0) return 0;
  surface.mesh.vertices.conservativeResize(3, kept);
  surface.file_vertices.resize(kept);
  for (Index c = 0; c < surface.mesh.faces.size(); ++c) {
    surface.mesh.faces(c) = places[surface.mesh.faces(c)];
  }
  return gone;
}

using Spot = std::array<double, 3>;

/// Indices of vertices in the order of their coordinates; vertices on one spot follow each other.
std::vector<std::pair<Spot, Index>> sortedSpots(const Points& vertices) {
  std::vector<std::pair<Spot, Index>> spots;
  spots.reserve(vertices.cols());
  for (Index v = 0; v < vertices.cols(); ++v) {
    spots.push_back({{vertices(0, v), vertices(1, v), vertices(2, v)}, v});
  }
  std::sort(spots.begin(), spots.end());
  return spots;
}

/// Has faces use the first of the vertices on each spot. Returns how many others there are.
std::size_t weld(Surface& surface) {
  const auto spots = sortedSpots(surface.mesh.vertices);
  std::vector<Index> first(spots.size());
  std::size_t others = 0;
  for (std::size_t i = 0; i < spots.size(); ++i) {
    const bool is_other = i > 0 && spots[i].first == spots[i - 1].first;
    first[spots[i].second] = is_other ? first[spots[i - 1].second] : spots[i].second;
    others += is_other;
  }
  for (Index c = 0; c < surface.mesh.faces.size(); ++c) {
    surface.mesh.faces(c) = first[surface.mesh.faces(c)];
  }
  return others;
}

std::size_t leaveOutCollapsedFaces(Surface& surface) {
  const Faces& faces = surface.mesh.faces;
  return keepFaces(surface, [&](Index f) {
    return faces(0, f) != faces(1, f) && faces(1, f) != faces(2, f) && faces(2, f) != faces(0, f);
  });
}

/// Returns how many pieces there were.
std::size_t keepLargestPiece(Surface& surface) {
  const Pieces pieces = piecesOf(surface.mesh.faces);
  if (pieces.sizes.size() < 2) return pieces.sizes.size();
  const Values face_areas = faceAreas(surface.mesh);
  std::vector<double> areas(pieces.sizes.size(), 0);
  for (Index f = 0; f < face_areas.size(); ++f) areas[pieces.of_face[f]] += face_areas[f];
  const auto largest =
      static_cast<Index>(std::max_element(areas.begin(), areas.end()) - areas.begin());
  keepFaces(surface, [&](Index f) { return pieces.of_face[f] == largest; });
  leaveOutUnusedVertices(surface);
  return pieces.sizes.size();
}

/// Adds vertices and faces at the end of a surface.
class Additions {
 public:
  explicit Additions(Surface& surface) : surface_(surface) {}

  void fill(const HalfEdges& edges, const Hole& hole) {
    if (hole.size() == 3) {
      faces_.push_back({edges.target(hole[0]), edges.origin(hole[0]), edges.target(hole[1])});
      return;
    }
    Vector3 sum = Vector3::Zero();
    for (const Index h : hole) sum += surface_.mesh.vertices.col(edges.origin(h));
    const auto middle = static_cast<Index>(surface_.mesh.vertices.cols() + vertices_.size());
    vertices_.push_back(sum / static_cast<double>(hole.size()));
    for (const Index h : hole) faces_.push_back({edges.target(h), edges.origin(h), middle});
  }

  void apply() {
    TriangleMesh& mesh = surface_.mesh;
    const Eigen::Index vertices = mesh.vertices.cols(), faces = mesh.faces.cols();
    mesh.vertices.conservativeResize(3, vertices + static_cast<Eigen::Index>(vertices_.size()));
    mesh.faces.conservativeResize(3, faces + static_cast<Eigen::Index>(faces_.size()));
    for (std::size_t v = 0; v < vertices_.size(); ++v)
      mesh.vertices.col(vertices + v) = vertices_[v];
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      mesh.faces.col(faces + f) << faces_[f][0], faces_[f][1], faces_[f][2];
    }
    surface_.file_vertices.resize(mesh.vertices.cols(), Surface::kNone);
    surface_.file_faces.resize(mesh.faces.cols(), Surface::kNone);
  }

  std::size_t vertices() const { return vertices_.size(); }
  std::size_t faces() const { return faces_.size(); }

 private:
  Surface& surface_;
  std::vector<Vector3> vertices_;
  std::vector<std::array<Index, 3>> faces_;
};

/// Returns a sentence, or nothing where no hole is short enough.
std::string fillHoles(Surface& surface, int longest, const MeshNames& names) {
  const HalfEdges edges(surface.mesh.faces, names);
  Additions additions(surface);
  std::size_t filled = 0;
  for (const Hole& hole : holesOf(edges)) {
    if (hole.size() > static_cast<std::size_t>(longest)) continue;
    additions.fill(edges, hole);
    ++filled;
  }
  if (filled == 0) return "";
  additions.apply();
  return "filled " + counted(filled, "hole", "holes") + " with " +
         counted(additions.faces(), "face", "faces") + " and " +
         counted(additions.vertices(), "new vertex", "new vertices");
}

}  // namespace

bool hasVerticesOnOneSpot(const Surface& surface) {
  const auto spots = sortedSpots(surface.mesh.vertices);
  return std::adjacent_find(spots.begin(), spots.end(), [](const auto& a, const auto& b) {
           return a.first == b.first;
         }) != spots.end();
}

std::vector<std::string> repair(Surface& surface, const Repairs& repairs, const MeshNames& names) {
  std::vector<std::string> told;
  if (const std::size_t unused = leaveOutUnusedVertices(surface)) {
    told.push_back("left out " + counted(unused, "vertex that belongs", "vertices that belong") +
                   " to no face");
  }
  if (repairs.weld) {
    if (const std::size_t joined = weld(surface)) {
      told.push_back("welded " + counted(joined, "vertex to another", "vertices to others") +
                     " on the same spot");
    }
    if (const std::size_t collapsed = leaveOutCollapsedFaces(surface)) {
      told.push_back("left out " + counted(collapsed, "face", "faces") + " with one vertex twice");
    }
    leaveOutUnusedVertices(surface);
  }
  if (repairs.largest_piece) {
    const std::size_t pieces = keepLargestPiece(surface);
    if (pieces > 1) {
      told.push_back("kept the piece of the largest area, of " +
                     counted(surface.file_faces.size(), "face", "faces") + ", and left out " +
                     counted(pieces - 1, "other", "others"));
    }
  }
  if (repairs.longest_hole > 0) {
    const std::string filled = fillHoles(surface, repairs.longest_hole, names);
    if (!filled.empty()) told.push_back(filled);
  }
  return told;
}

}  // namespace spherical_springs::mesh
