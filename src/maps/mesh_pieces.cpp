#include "maps/mesh_pieces.h"

#include <algorithm>
#include <array>

#include "base/disjoint_sets.h"

namespace spherical_springs::mesh {
namespace {

using Index = HalfEdges::Index;

/// Edges as (lower vertex, upper vertex, face), sorted.
std::vector<std::array<Index, 3>> sortedEdges(const Faces& faces) {
  std::vector<std::array<Index, 3>> edges;
  edges.reserve(faces.size());
  for (Index f = 0; f < faces.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const auto ends = std::minmax(faces(k, f), faces((k + 1) % 3, f));
      edges.push_back({ends.first, ends.second, f});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

bool isBoundary(const HalfEdges& edges, Index h) { return edges.twin(h) == HalfEdges::kNone; }

/// Returns the boundary half-edge that begins where `h` ends, of the faces that follow each other
/// round that vertex from the face of `h` on.
Index sameFanAfter(const HalfEdges& edges, Index h) {
  Index g = HalfEdges::next(h);
  while (!isBoundary(edges, g)) g = HalfEdges::next(edges.twin(g));
  return g;
}

/// Returns for each boundary half-edge the next one round its hole. The parts that meet in a vertex
/// are taken in turn: behind the end of one begins the next.
std::vector<Index> nextRoundHoles(const HalfEdges& edges) {
  std::vector<std::array<Index, 2>> ends;  // (vertex, half-edge that ends there)
  for (Index h = 0; h < edges.size(); ++h) {
    if (isBoundary(edges, h)) ends.push_back({edges.target(h), h});
  }
  std::sort(ends.begin(), ends.end());
  std::vector<Index> next(edges.size(), HalfEdges::kNone);
  for (std::size_t begin = 0, end; begin < ends.size(); begin = end) {
    end = begin;
    while (end < ends.size() && ends[end][0] == ends[begin][0]) ++end;
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t following = i + 1 < end ? i + 1 : begin;
      next[ends[i][1]] = sameFanAfter(edges, ends[following][1]);
    }
  }
  return next;
}

}  // namespace

Pieces piecesOf(const Faces& faces) {
  core::DisjointSets sets(faces.cols());
  const auto edges = sortedEdges(faces);
  for (std::size_t e = 1; e < edges.size(); ++e) {
    const auto &one = edges[e - 1], &other = edges[e];
    if (one[0] == other[0] && one[1] == other[1]) sets.join(one[2], other[2]);
  }
  Pieces pieces;
  pieces.of_face.resize(faces.cols());
  std::vector<Index> piece_of_root(faces.cols(), HalfEdges::kNone);
  for (Index f = 0; f < faces.cols(); ++f) {
    Index& piece = piece_of_root[sets.rootOf(f)];
    if (piece == HalfEdges::kNone) {
      piece = static_cast<Index>(pieces.sizes.size());
      pieces.sizes.push_back(0);
    }
    pieces.of_face[f] = piece;
    ++pieces.sizes[piece];
  }
  return pieces;
}

std::vector<Hole> holesOf(const HalfEdges& edges) {
  std::vector<Index> next = nextRoundHoles(edges);
  std::vector<Hole> holes;
  for (Index h = 0; h < edges.size(); ++h) {
    if (next[h] == HalfEdges::kNone) continue;
    Hole hole;
    for (Index g = h; next[g] != HalfEdges::kNone;) {
      hole.push_back(g);
      const Index following = next[g];
      next[g] = HalfEdges::kNone;
      g = following;
    }
    holes.push_back(std::move(hole));
  }
  return holes;
}

}  // namespace spherical_springs::mesh
