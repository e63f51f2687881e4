#include <cstdio>

#include "surfaces/repairs.h"
#include "surfaces/surface.h"

namespace spherical_springs::mesh {
namespace {

std::string coordinates(const Vector3& p) {
  char text[80];
  const Vector3 shown = p.array() + 0.;  // without the sign of zeros
  std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g)", shown[0], shown[1], shown[2]);
  return text;
}

}  // namespace

/// The file's number of a vertex, or nothing where the file gives none.
std::string FileNames::numbered(std::int32_t index) const {
  const std::int32_t number = surface_.file_vertices[index];
  if (number == Surface::kNone || !file_.numbers_vertices) return "";
  return std::to_string(number + file_.first_number);
}

std::string FileNames::vertex(std::int32_t index) const {
  const std::string number = numbered(index);
  return "vertex " + (number.empty() ? "" : number + " ") + "at " +
         coordinates(surface_.mesh.vertices.col(index));
}

std::string FileNames::face(std::int32_t index) const {
  const std::int32_t face = surface_.file_faces[index];
  if (face == Surface::kNone) return "a face that fills a hole";
  if (!file_.lines.empty()) return "the face of line " + std::to_string(file_.lines[face]);
  return "face " + std::to_string(face + file_.first_number);
}

std::string FileNames::edge(std::int32_t from, std::int32_t to) const {
  const std::string first = numbered(from), last = numbered(to);
  const std::string numbers = first.empty() || last.empty() ? "" : first + "-" + last + " ";
  return "edge " + numbers + "from " + coordinates(surface_.mesh.vertices.col(from)) + " to " +
         coordinates(surface_.mesh.vertices.col(to));
}

std::string FileNames::remedy(MeshFault fault, std::int32_t size) const {
  switch (fault) {
    case MeshFault::open:
      if (hasVerticesOnOneSpot(surface_)) {
        return "; --weld makes vertices on one spot one vertex";
      }
      return "; --fill-holes " + std::to_string(size) + " closes all holes";
    case MeshFault::several_pieces:
      return "; --largest-piece keeps the one of the largest area";
    case MeshFault::repeated_vertex:
      return "; --weld leaves such faces out";
    case MeshFault::unused_vertex:
      break;
  }
  return "";
}

}  // namespace spherical_springs::mesh
