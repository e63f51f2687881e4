#include "maps/topological_sphere.h"

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "maps/handle.h"
#include "maps/mesh_pieces.h"

namespace spherical_springs::mesh {
namespace {

using Index = HalfEdges::Index;

[[noreturn]] void refuse(const std::string& reason) { throw std::invalid_argument(reason); }

void requireVertices(const TriangleMesh& mesh, const MeshNames& names) {
  if (mesh.vertices.cols() > 2'000'000) {
    refuse("the mesh has " + std::to_string(mesh.vertices.cols()) +
           " vertices; allowed: up to 2000000");
  }
  for (Index v = 0; v < mesh.vertices.cols(); ++v) {
    if (!mesh.vertices.col(v).allFinite()) {
      refuse(names.vertex(v) + " is not finite");
    }
  }
}

void requireFaces(const TriangleMesh& mesh, const MeshNames& names) {
  const Eigen::Index count = mesh.vertices.cols();
  if (mesh.faces.cols() < 4) {
    refuse("the number of faces is " + std::to_string(mesh.faces.cols()) + "; allowed: 4 or more");
  }
  for (Index f = 0; f < mesh.faces.cols(); ++f) {
    const auto face = mesh.faces.col(f);
    for (int k = 0; k < 3; ++k) {
      const std::int32_t v = face[k];
      if (v < 0 || v >= count) {
        refuse(names.face(f) + " has vertex " + std::to_string(v) + "; allowed: 0 to " +
               std::to_string(count - 1));
      }
    }
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) {
      refuse(names.face(f) + " has one vertex twice" + names.remedy(MeshFault::repeated_vertex, 0));
    }
  }
}

/// Counts in words: "3 holes, of 12, 5 and 4 edges"; the largest three of them where there are
/// more.
std::string counted(std::vector<Index> sizes, const char* what, const char* parts) {
  constexpr std::size_t kMost = 3;
  const std::size_t named = std::min(sizes.size(), kMost);
  std::partial_sort(sizes.begin(), sizes.begin() + named, sizes.end(), std::greater<>());
  std::string text = std::to_string(sizes.size()) + " " + what + (sizes.size() == 1 ? "" : "s");
  text += sizes.size() > kMost ? ", the largest of " : ", of ";
  for (std::size_t i = 0; i < named; ++i) {
    if (i > 0) text += i + 1 < named ? ", " : " and ";
    text += std::to_string(sizes[i]);
  }
  return text + " " + parts;
}

void requireClosed(const HalfEdges& edges, const MeshNames& names) {
  const std::vector<Hole> holes = holesOf(edges);
  if (holes.empty()) return;
  std::vector<Index> sizes;
  sizes.reserve(holes.size());
  for (const Hole& hole : holes) sizes.push_back(static_cast<Index>(hole.size()));
  const Index h = holes.front().front();
  refuse("the mesh is open: it has " + counted(sizes, "hole", "edges") + "; " +
         names.edge(edges.origin(h), edges.target(h)) + " has no face but " +
         names.face(HalfEdges::face(h)) +
         names.remedy(MeshFault::open, *std::max_element(sizes.begin(), sizes.end())));
}

void requireOnePiece(const Faces& faces, const MeshNames& names) {
  const Pieces pieces = piecesOf(faces);
  if (pieces.sizes.size() == 1) return;
  const auto other = std::find(pieces.of_face.begin(), pieces.of_face.end(), 1);
  refuse("the mesh has " + counted(pieces.sizes, "piece", "faces") + "; " +
         names.face(static_cast<Index>(other - pieces.of_face.begin())) +
         " is not connected with " + names.face(0) + names.remedy(MeshFault::several_pieces, 0));
}

/// Every vertex in use, its faces all round it.
void requireDiscs(const HalfEdges& edges, Index vertices, const MeshNames& names) {
  std::vector<Index> degrees(vertices, 0), any(vertices, HalfEdges::kNone);
  for (Index h = 0; h < edges.size(); ++h) {
    ++degrees[edges.origin(h)];
    any[edges.origin(h)] = h;
  }
  for (Index v = 0; v < vertices; ++v) {
    if (degrees[v] == 0) {
      refuse(names.vertex(v) + " belongs to no face" + names.remedy(MeshFault::unused_vertex, 0));
    }
    Index round = 0, h = any[v];
    do {
      ++round;
      h = edges.turned(h);
    } while (h != any[v]);
    if (round < degrees[v]) {
      refuse(names.vertex(v) + " joins parts of the mesh that share no edge there");
    }
  }
}

void requireNoHandle(const HalfEdges& edges, const TriangleMesh& mesh, const MeshNames& names) {
  const Eigen::Index euler = mesh.vertices.cols() - edges.size() / 2 + mesh.faces.cols();
  if (euler == 2) return;
  const std::vector<Index> path = pathRoundAHandle(edges);
  refuse("the mesh is of genus " + std::to_string((2 - euler) / 2) + "; allowed: 0; a path of " +
         std::to_string(path.size()) + " edges round a handle passes " +
         names.vertex(path.front()));
}

}  // namespace

void requireTopologicalSphere(const TriangleMesh& mesh, const MeshNames& names) {
  requireVertices(mesh, names);
  requireFaces(mesh, names);
  const HalfEdges edges(mesh.faces, names);
  requireClosed(edges, names);
  requireOnePiece(mesh.faces, names);
  requireDiscs(edges, static_cast<Index>(mesh.vertices.cols()), names);
  requireNoHandle(edges, mesh, names);
}

}  // namespace spherical_springs::mesh
