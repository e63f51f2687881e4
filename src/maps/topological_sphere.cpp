#include "maps/topological_sphere.h"

#include <stdexcept>
#include <string>
#include <vector>

#include "maps/half_edges.h"

namespace spherical_springs::mesh {
namespace {

using Index = HalfEdges::Index;

[[noreturn]] void refuse(const std::string& reason) { throw std::invalid_argument(reason); }

void requireVertices(const TriangleMesh& mesh) {
  if (mesh.vertices.cols() > 2'000'000) {
    refuse("the mesh has " + std::to_string(mesh.vertices.cols()) +
           " vertices; allowed: up to 2000000");
  }
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) {
    if (!mesh.vertices.col(v).allFinite()) {
      refuse("vertex " + std::to_string(v) + " is not finite");
    }
  }
}

void requireFaces(const TriangleMesh& mesh) {
  const Eigen::Index count = mesh.vertices.cols();
  if (mesh.faces.cols() < 4) {
    refuse("the number of faces is " + std::to_string(mesh.faces.cols()) + "; allowed: 4 or more");
  }
  for (Eigen::Index f = 0; f < mesh.faces.cols(); ++f) {
    const auto face = mesh.faces.col(f);
    for (int k = 0; k < 3; ++k) {
      const std::int32_t v = face[k];
      if (v < 0 || v >= count) {
        refuse("face " + std::to_string(f) + " has vertex " + std::to_string(v) +
               "; allowed: 0 to " + std::to_string(count - 1));
      }
    }
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) {
      refuse("face " + std::to_string(f) + " has one vertex twice");
    }
  }
}

void requireClosed(const HalfEdges& edges) {
  for (Index h = 0; h < edges.size(); ++h) {
    if (edges.twin(h) != HalfEdges::kNone) continue;
    refuse("the mesh is open: edge " + std::to_string(edges.origin(h)) + "-" +
           std::to_string(edges.target(h)) + " has no face but face " +
           std::to_string(HalfEdges::face(h)));
  }
}

/// Every vertex in use, its faces all round it.
void requireDiscs(const HalfEdges& edges, Eigen::Index vertices) {
  std::vector<Index> degrees(vertices, 0), any(vertices, HalfEdges::kNone);
  for (Index h = 0; h < edges.size(); ++h) {
    ++degrees[edges.origin(h)];
    any[edges.origin(h)] = h;
  }
  for (Eigen::Index v = 0; v < vertices; ++v) {
    if (degrees[v] == 0) refuse("vertex " + std::to_string(v) + " belongs to no face");
    Index round = 0, h = any[v];
    do {
      ++round;
      h = edges.turned(h);
    } while (h != any[v]);
    if (round < degrees[v]) {
      refuse("vertex " + std::to_string(v) + " joins parts of the mesh that share no edge there");
    }
  }
}

void requireOnePiece(const HalfEdges& edges) {
  std::vector<bool> reached(edges.size() / 3, false);
  std::vector<Index> front = {0};
  reached[0] = true;
  Index count = 1;
  while (!front.empty()) {
    const Index face = front.back();
    front.pop_back();
    for (Index h = 3 * face; h < 3 * face + 3; ++h) {
      const Index other = HalfEdges::face(edges.twin(h));
      if (reached[other]) continue;
      reached[other] = true;
      ++count;
      front.push_back(other);
    }
  }
  for (std::size_t f = 0; f < reached.size(); ++f) {
    if (!reached[f]) {
      refuse("the mesh has several pieces: face " + std::to_string(f) +
             " is not connected with face 0");
    }
  }
}

}  // namespace

void requireTopologicalSphere(const TriangleMesh& mesh) {
  requireVertices(mesh);
  requireFaces(mesh);
  const HalfEdges edges(mesh.faces);
  requireClosed(edges);
  requireOnePiece(edges);
  requireDiscs(edges, mesh.vertices.cols());
  const Eigen::Index euler = mesh.vertices.cols() - edges.size() / 2 + mesh.faces.cols();
  if (euler != 2) {
    refuse("the mesh is of genus " + std::to_string((2 - euler) / 2) + "; allowed: 0");
  }
}

}  // namespace spherical_springs::mesh
