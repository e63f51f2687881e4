// Surfaces with faults: named by the file's numbers, and mended where that was asked for.
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "maps/topological_sphere.h"
#include "support/shapes.h"
#include "surfaces/repairs.h"

namespace spherical_springs::mesh {
namespace {

/// A file of OBJ's numbering with a mesh's vertices and faces.
PolygonMesh fileOf(const TriangleMesh& mesh) {
  PolygonMesh file;
  file.first_number = 1;
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v)
    file.vertices.push_back(mesh.vertices.col(v));
  for (Eigen::Index f = 0; f < mesh.faces.cols(); ++f) {
    for (int k = 0; k < 3; ++k) file.corners.push_back(mesh.faces(k, f));
    file.ends.push_back(file.corners.size());
  }
  return file;
}

TriangleMesh sphere(double radius = 1) {
  return testing::deformedSphere(1, [=](const Vector3& p) -> Vector3 { return radius * p; });
}

void removeFace(PolygonMesh& file, std::size_t face) {
  file.corners.erase(file.corners.begin() + 3 * face, file.corners.begin() + 3 * face + 3);
  file.ends.pop_back();
}

void append(PolygonMesh& file, const PolygonMesh& other) {
  const auto vertices = static_cast<std::int32_t>(file.vertices.size());
  const std::size_t corners = file.corners.size();
  for (const Vector3& vertex : other.vertices) file.vertices.push_back(vertex);
  for (const std::int32_t corner : other.corners) file.corners.push_back(corner + vertices);
  for (const std::size_t end : other.ends) file.ends.push_back(end + corners);
}

/// Gives every corner a vertex of its own, as STL files do.
PolygonMesh unwelded(const PolygonMesh& file) {
  PolygonMesh result;
  result.numbers_vertices = false;
  for (const std::int32_t corner : file.corners) {
    result.corners.push_back(static_cast<std::int32_t>(result.vertices.size()));
    result.vertices.push_back(file.vertices[corner]);
  }
  result.ends = file.ends;
  return result;
}

struct Result {
  Surface surface;
  std::vector<std::string> told;
  std::string refusal;
};

Result repaired(const PolygonMesh& file, const Repairs& repairs) {
  Result result{triangulated(file), {}, ""};
  const FileNames names(file, result.surface);
  try {
    result.told = repair(result.surface, repairs, names);
    requireTopologicalSphere(result.surface.mesh, names);
  } catch (const std::invalid_argument& fault) {
    result.refusal = fault.what();
  }
  return result;
}

using Told = std::vector<std::string>;

TEST(Repairs, LeaveASoundSurfaceAsItIs) {
  const TriangleMesh mesh = sphere();
  const Result result = repaired(fileOf(mesh), {true, true, 100});
  EXPECT_EQ("", result.refusal);
  EXPECT_EQ(Told{}, result.told);
  EXPECT_EQ(mesh.vertices, result.surface.mesh.vertices);
  EXPECT_EQ(mesh.faces, result.surface.mesh.faces);
}

TEST(Repairs, LeaveOutVerticesOfNoFaceAndKeepTheOrderOfTheOthers) {
  PolygonMesh file = fileOf(sphere());
  file.vertices.insert(file.vertices.begin() + 5, Vector3(9, 9, 9));
  for (std::int32_t& corner : file.corners) corner += corner >= 5;
  const Result result = repaired(file, {});
  EXPECT_EQ("", result.refusal);
  EXPECT_EQ(Told{"left out 1 vertex that belongs to no face"}, result.told);
  EXPECT_EQ(sphere().vertices, result.surface.mesh.vertices);
  EXPECT_EQ(sphere().faces, result.surface.mesh.faces);
  EXPECT_EQ(4, result.surface.file_vertices[4]);
  EXPECT_EQ(6, result.surface.file_vertices[5]);
}

TEST(Repairs, WeldCornersOnOneSpot) {
  const PolygonMesh loose = unwelded(fileOf(sphere()));
  const Result refused = repaired(loose, {});
  EXPECT_NE(std::string::npos, refused.refusal.find("--weld")) << refused.refusal;
  EXPECT_NE(std::string::npos, refused.refusal.find("80 holes, the largest of 3, 3 and 3 edges"))
      << refused.refusal;
  const Result result = repaired(loose, {true, false, 0});
  EXPECT_EQ("", result.refusal);
  EXPECT_EQ(Told{"welded 198 vertices to others on the same spot"}, result.told);
  EXPECT_EQ(42, result.surface.mesh.vertices.cols());
}

TEST(Repairs, WeldZerosOfEitherSign) {
  PolygonMesh file =
      fileOf(testing::meshOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-0., 0, -0.}},
                             {{0, 2, 1}, {4, 1, 3}, {1, 2, 3}, {2, 0, 3}}));
  EXPECT_EQ("", repaired(file, {true, false, 0}).refusal);
}

TEST(Repairs, WeldLeavesOutFacesThatCollapse) {
  PolygonMesh file = fileOf(sphere());
  const std::int32_t a = file.corners[0], b = file.corners[1];
  for (const std::int32_t corner : {a, b, b}) file.corners.push_back(corner);
  file.ends.push_back(file.corners.size());
  const Result refused = repaired(file, {});
  EXPECT_NE(std::string::npos,
            refused.refusal.find("face 81 has one vertex twice; --weld leaves such faces out"))
      << refused.refusal;
  const Result result = repaired(file, {true, false, 0});
  EXPECT_EQ("", result.refusal);
  EXPECT_EQ(Told{"left out 1 face with one vertex twice"}, result.told);
}

TEST(Repairs, KeepThePieceOfTheLargestArea) {
  PolygonMesh file = fileOf(sphere(0.1));
  append(file, fileOf(testing::tetrahedron()));
  append(file, fileOf(sphere(0.2)));
  const Result refused = repaired(file, {});
  EXPECT_NE(std::string::npos, refused.refusal.find("3 pieces, of 80, 80 and 4 faces"))
      << refused.refusal;
  EXPECT_NE(std::string::npos, refused.refusal.find("--largest-piece")) << refused.refusal;
  const Result result = repaired(file, {false, true, 0});
  EXPECT_EQ("", result.refusal);
  EXPECT_EQ(Told{"kept the piece of the largest area, of 4 faces, and left out 2 others"},
            result.told);
  EXPECT_EQ(testing::tetrahedron().vertices, result.surface.mesh.vertices);
  EXPECT_EQ(80, result.surface.file_faces[0]);
  EXPECT_EQ(42, result.surface.file_vertices[0]);
}

TEST(Repairs, FillAHoleOfThreeEdgesByATriangle) {
  PolygonMesh file = fileOf(sphere());
  removeFace(file, 7);
  const Result refused = repaired(file, {});
  EXPECT_NE(std::string::npos, refused.refusal.find("it has 1 hole, of 3 edges"))
      << refused.refusal;
  EXPECT_NE(std::string::npos, refused.refusal.find("--fill-holes 3 closes all holes"))
      << refused.refusal;
  const Result result = repaired(file, {false, false, 3});
  EXPECT_EQ("", result.refusal);
  EXPECT_EQ(Told{"filled 1 hole with 1 face and 0 new vertices"}, result.told);
  EXPECT_EQ(sphere().vertices, result.surface.mesh.vertices);
  EXPECT_EQ(Surface::kNone, result.surface.file_faces.back());
}

TEST(Repairs, FillLongerHolesRoundAVertexInTheirMiddle) {
  PolygonMesh file = fileOf(sphere());
  // All faces of vertex 0, which is an end of six edges or five.
  for (std::size_t f = file.ends.size(); f-- > 0;) {
    const auto corners = file.corners.begin() + 3 * f;
    if (std::find(corners, corners + 3, 0) != corners + 3) removeFace(file, f);
  }
  EXPECT_NE("", repaired(file, {false, false, 4}).refusal);
  const Result result = repaired(file, {false, false, 5});
  EXPECT_EQ("", result.refusal);
  EXPECT_EQ((Told{"left out 1 vertex that belongs to no face",
                  "filled 1 hole with 5 faces and 1 new vertex"}),
            result.told);
  const TriangleMesh& mesh = result.surface.mesh;
  EXPECT_EQ(sphere().vertices.rightCols(41), mesh.vertices.leftCols(41));
  EXPECT_EQ(80, mesh.faces.cols());
  EXPECT_GT(volume(mesh), 0);
}

TEST(Repairs, FillHolesThatMeetInAVertex) {
  const TriangleMesh whole = testing::deformedSphere(2, [](const Vector3& p) { return p; });
  PolygonMesh file = fileOf(whole);
  // Two faces that share vertex 0 alone.
  std::vector<std::size_t> at_vertex;
  for (std::size_t f = 0; f < file.ends.size(); ++f) {
    const auto corners = file.corners.begin() + 3 * f;
    if (std::find(corners, corners + 3, 0) != corners + 3) at_vertex.push_back(f);
  }
  ASSERT_EQ(5u, at_vertex.size());
  const auto shared = [&](std::size_t f, std::size_t g) {
    int count = 0;
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) count += file.corners[3 * f + j] == file.corners[3 * g + k];
    }
    return count;
  };
  std::size_t other = 1;
  while (shared(at_vertex[0], at_vertex[other]) > 1) ++other;
  removeFace(file, at_vertex[other]);
  removeFace(file, at_vertex[0]);
  const Result result = repaired(file, {false, false, 3});
  EXPECT_EQ("", result.refusal);
  EXPECT_EQ(Told{"filled 2 holes with 2 faces and 0 new vertices"}, result.told);
}

TEST(Repairs, NameAPlaceOnAHandle) {
  // A block with a square hole through it, far from the origin of numbers.
  std::vector<Vector3> vertices;
  std::vector<std::array<std::uint32_t, 3>> faces;
  constexpr std::uint32_t kAround = 40, kAcross = 6;
  for (std::uint32_t i = 0; i < kAround; ++i) {
    for (std::uint32_t j = 0; j < kAcross; ++j) {
      const double t = 2 * core::kPi * i / kAround, s = 2 * core::kPi * j / kAcross;
      vertices.push_back(
          {(5 + std::cos(s)) * std::cos(t), (5 + std::cos(s)) * std::sin(t), std::sin(s)});
      const auto at = [&](std::uint32_t a, std::uint32_t b) {
        return a % kAround * kAcross + b % kAcross;
      };
      faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  const std::string refusal = repaired(fileOf(testing::meshOf(vertices, faces)), {}).refusal;
  EXPECT_NE(std::string::npos,
            refusal.find("of genus 1; allowed: 0; a path of 6 edges round a handle passes vertex "))
      << refusal;
  EXPECT_NE(std::string::npos, refusal.find(" at (")) << refusal;
}

TEST(Repairs, NameVerticesOfAFileWithoutNumbersByPlace) {
  PolygonMesh file = unwelded(fileOf(testing::tetrahedron()));
  removeFace(file, 0);
  const std::string refusal = repaired(file, {true, false, 0}).refusal;
  EXPECT_EQ("the number of faces is 3; allowed: 4 or more", refusal);
  PolygonMesh open = unwelded(fileOf(sphere()));
  removeFace(open, 0);
  const std::string hole = repaired(open, {true, false, 0}).refusal;
  EXPECT_NE(std::string::npos, hole.find("; edge from (")) << hole;
}

}  // namespace
}  // namespace spherical_springs::mesh
