#include "relax_mesh/obj_file.h"

#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/files.h"
#include "relax_mesh/byte_order_mark.h"

// A reader of our own: doc/history/obj_readers.md says what libraries do with files at fault.

namespace spherical_springs::mesh {
namespace {

constexpr int kCorners = 3;

[[noreturn]] void refuse(std::size_t line, const std::string& reason) {
  throw std::invalid_argument("line " + std::to_string(line) + ": " + reason);
}

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

const char* skipBlanks(const char* text) {
  while (isBlank(*text)) ++text;
  return text;
}

/// Whether the line begins with this word; then `rest` is what follows.
bool begins(const std::string& line, char word, const char*& rest) {
  const char* text = skipBlanks(line.c_str());
  if (*text != word || !isBlank(text[1])) return false;
  rest = text + 1;
  return true;
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

/// The file's numbers of the corners: from 1, or negative where counted back from `vertices`.
Eigen::Vector3i parseFace(std::size_t line, const char* text, std::size_t vertices) {
  Eigen::Vector3i face;
  int corners = 0;
  for (text = skipBlanks(text); *text != '\0'; text = skipBlanks(text)) {
    char* end;
    const long number = std::strtol(text, &end, 10);
    if (end == text || (*end != '\0' && *end != '/' && !isBlank(*end))) {
      refuse(line, "a corner of a face is not the number of a vertex");
    }
    const long index = number < 0 ? static_cast<long>(vertices) + number : number - 1;
    if (index < 0 || index > std::numeric_limits<int>::max()) {
      refuse(line, "a face has vertex " + std::to_string(number) + ", which is not there");
    }
    if (corners < kCorners) face[corners] = static_cast<int>(index);
    ++corners;
    text = end;
    while (*text != '\0' && !isBlank(*text)) ++text;
  }
  if (corners != kCorners) {
    const char* advice =
        corners < kCorners ? "which a face needs" : "so cut it into triangles first";
    refuse(line, "a face has " + std::to_string(corners) + (corners == 1 ? " corner" : " corners") +
                     "; allowed: 3, " + advice);
  }
  return face;
}

template <class Matrix, class Column>
Matrix columns(const std::vector<Column>& list) {
  Matrix result(3, list.size());
  for (std::size_t i = 0; i < list.size(); ++i) result.col(i) = list[i];
  return result;
}

void writeVertices(std::ostream& out, const Points& vertices, const core::Checkpoint& checkpoint) {
  for (Eigen::Index i = 0; i < vertices.cols(); ++i) {
    checkpoint();
    out << "v " << vertices(0, i) << ' ' << vertices(1, i) << ' ' << vertices(2, i) << '\n';
  }
}

}  // namespace

TriangleMesh readObj(std::istream& in, const core::Checkpoint& checkpoint) {
  std::vector<Vector3> vertices;
  std::vector<Eigen::Vector3i> faces;
  std::size_t last_line = 0, line_of_highest = 0;
  int highest = -1;
  std::string line;
  const char* rest;
  skipByteOrderMark(in);
  while (std::getline(in, line)) {
    checkpoint();
    ++last_line;
    if (begins(line, 'v', rest)) {
      vertices.push_back(parseVertex(last_line, rest));
    } else if (begins(line, 'f', rest)) {
      faces.push_back(parseFace(last_line, rest, vertices.size()));
      if (faces.back().maxCoeff() > highest) {
        highest = faces.back().maxCoeff();
        line_of_highest = last_line;
      }
    }
  }
  if (vertices.empty()) throw std::invalid_argument("not an OBJ file: it has no line 'v x y z'");
  if (faces.empty()) throw std::invalid_argument("it has vertices, and no face");
  if (highest >= static_cast<int>(vertices.size())) {
    refuse(line_of_highest, "a face has vertex " + std::to_string(highest + 1L) +
                                "; allowed: 1 to " + std::to_string(vertices.size()));
  }
  return {columns<Points>(vertices), columns<Faces>(faces)};
}

TriangleMesh readObj(const std::filesystem::path& path, const core::Checkpoint& checkpoint) {
  std::ifstream in = core::openToRead(path);
  try {
    return readObj(in, checkpoint);
  } catch (const std::invalid_argument& fault) {
    throw std::invalid_argument(core::onOneLine(path) + ": " + fault.what());
  }
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

void writeObj(std::ostream& out, const TriangleMesh& mesh, const TextureCoordinates& texture,
              const core::Checkpoint& checkpoint) {
  out << std::setprecision(std::numeric_limits<double>::max_digits10);
  writeVertices(out, mesh.vertices, checkpoint);
  for (Eigen::Index i = 0; i < texture.places.cols(); ++i) {
    checkpoint();
    out << "vt " << texture.places(0, i) << ' ' << texture.places(1, i) << '\n';
  }
  for (Eigen::Index f = 0; f < mesh.faces.cols(); ++f) {
    checkpoint();
    out << 'f';
    for (int i = 0; i < kCorners; ++i) {
      out << ' ' << mesh.faces(i, f) + 1 << '/' << texture.corners(i, f) + 1;
    }
    out << '\n';
  }
}

}  // namespace spherical_springs::mesh
