#include "surfaces/obj_file.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iomanip>
#include <limits>
#include <stdexcept>
#include <string>

#include "surfaces/text_lines.h"

// Read by code of this package: doc/history/obj_readers.md says what libraries do with wrong files.

namespace spherical_springs::mesh {
namespace {

constexpr std::size_t kLeastCorners = 3;

[[noreturn]] void refuse(std::size_t line, const std::string& reason) {
  throw std::invalid_argument("line " + std::to_string(line) + ": " + reason);
}

bool isBlank(char c) { return c == ' ' || c == '\t'; }

const char* skipBlanks(const char* text) {
  while (isBlank(*text)) ++text;
  return text;
}

/// Returns what follows a word at the beginning of a line, or nullptr where another one stands
/// there.
const char* after(const char* word, const std::string& line) {
  const char* text = skipBlanks(line.c_str());
  const std::size_t length = std::strlen(word);
  return std::strncmp(text, word, length) == 0 && isBlank(text[length]) ? text + length : nullptr;
}

Vector3 parseVertex(std::size_t line, const char* text) {
  Vector3 vertex;
  for (int k = 0; k < 3; ++k) {
    double& coordinate = vertex[k];
    char* end;
    coordinate = std::strtod(text, &end);
    if (end == text || (*end != '\0' && !isBlank(*end)) || !std::isfinite(coordinate)) {
      refuse(line, "a vertex is not three finite numbers");
    }
    text = end;
  }
  return vertex;
}

/// Adds a face. Its corners are numbered from 1, or negative where counted back from the last
/// vertex so far.
void parseFace(std::size_t line, const char* text, PolygonMesh& mesh) {
  const std::size_t begin = mesh.corners.size();
  for (text = skipBlanks(text); *text != '\0'; text = skipBlanks(text)) {
    char* end;
    const long number = std::strtol(text, &end, 10);
    if (end == text || (*end != '\0' && *end != '/' && !isBlank(*end))) {
      refuse(line, "a corner of a face is not the number of a vertex");
    }
    const long index = number < 0 ? static_cast<long>(mesh.vertices.size()) + number : number - 1;
    if (index < 0 || index >= std::numeric_limits<int>::max()) {
      refuse(line, "a face has vertex " + std::to_string(number) + ", which is not there");
    }
    mesh.corners.push_back(static_cast<std::int32_t>(index));
    text = end;
    while (*text != '\0' && !isBlank(*text)) ++text;
  }
  const std::size_t corners = mesh.corners.size() - begin;
  if (corners < kLeastCorners) {
    refuse(line, "a face has " + std::to_string(corners) + (corners == 1 ? " corner" : " corners") +
                     "; allowed: 3 or more");
  }
  mesh.ends.push_back(mesh.corners.size());
  mesh.lines.push_back(static_cast<std::uint32_t>(line));
}

void requireVertices(const PolygonMesh& mesh) {
  const auto count = static_cast<std::int32_t>(mesh.vertices.size());
  for (std::int32_t f = 0; f < mesh.faces(); ++f) {
    for (std::size_t c = mesh.begin(f); c < mesh.ends[f]; ++c) {
      if (mesh.corners[c] < count) continue;
      refuse(mesh.lines[f], "a face has vertex " + std::to_string(mesh.corners[c] + 1L) +
                                "; allowed: 1 to " + std::to_string(count));
    }
  }
}

void writeVertices(std::ostream& out, const Points& vertices, const core::Checkpoint& checkpoint) {
  for (Eigen::Index i = 0; i < vertices.cols(); ++i) {
    checkpoint();
    out << "v " << vertices(0, i) << ' ' << vertices(1, i) << ' ' << vertices(2, i) << '\n';
  }
}

}  // namespace

PolygonMesh readObj(std::istream& in, const core::Checkpoint& checkpoint) {
  PolygonMesh mesh;
  mesh.first_number = 1;
  TextLines lines(in);
  for (std::string line; lines.next(line);) {
    checkpoint();
    if (const char* vertex = after("v", line)) {
      mesh.vertices.push_back(parseVertex(lines.number(), vertex));
    } else if (const char* face = after("f", line)) {
      parseFace(lines.number(), face, mesh);
    }
  }
  if (mesh.vertices.empty()) {
    throw std::invalid_argument("not an OBJ file: it has no line 'v x y z'");
  }
  if (mesh.ends.empty()) throw std::invalid_argument("it has vertices, and no face");
  requireVertices(mesh);
  return mesh;
}

void writeObj(std::ostream& out, const TriangleMesh& mesh, const core::Checkpoint& checkpoint) {
  out << std::setprecision(std::numeric_limits<double>::max_digits10);
  writeVertices(out, mesh.vertices, checkpoint);
  for (Eigen::Index f = 0; f < mesh.faces.cols(); ++f) {
    checkpoint();
    const Eigen::Vector3i face = mesh.faces.col(f).array() + 1;
    out << "f " << face[0] << ' ' << face[1] << ' ' << face[2] << '\n';
  }
}

void writeObj(std::ostream& out, const TexturedSurface& textured,
              const core::Checkpoint& checkpoint) {
  out << std::setprecision(std::numeric_limits<double>::max_digits10);
  writeVertices(out, textured.surface.vertices, checkpoint);
  for (Eigen::Index i = 0; i < textured.places.cols(); ++i) {
    checkpoint();
    out << "vt " << textured.places(0, i) << ' ' << textured.places(1, i) << '\n';
  }
  const Faces& faces = textured.surface.faces;
  for (Eigen::Index f = 0; f < faces.cols(); ++f) {
    checkpoint();
    out << 'f';
    for (int i = 0; i < 3; ++i) out << ' ' << faces(i, f) + 1 << '/' << textured.corners(i, f) + 1;
    out << '\n';
  }
}

}  // namespace spherical_springs::mesh
