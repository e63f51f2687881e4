// Files of other formats than OBJ, and files that only say so.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "surfaces/surface_file.h"

namespace spherical_springs::mesh {
namespace {

namespace fs = std::filesystem;

const std::vector<Vector3> kVertices = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 0.5}};
const std::vector<std::int32_t> kCorners = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};

class SurfaceFile : public ::testing::Test {
 protected:
  void TearDown() override { fs::remove_all(directory_); }

  fs::path write(const std::string& name, const std::string& content) const {
    std::ofstream(directory_ / name, std::ios::binary) << content;
    return directory_ / name;
  }

  std::string reasonAgainst(const std::string& name, const std::string& content) const {
    try {
      readPolygons(write(name, content));
    } catch (const std::invalid_argument& fault) {
      return fault.what();
    }
    return "taken";
  }

  void expectRefused(const std::string& name, const std::string& content,
                     const std::string& reason) const {
    const std::string found = reasonAgainst(name, content);
    EXPECT_NE(std::string::npos, found.find(name + ": " + reason)) << found;
  }

 private:
  static fs::path made() {
    const fs::path path =
        fs::temp_directory_path() / ("spherical_springs" + std::to_string(::getpid()));
    fs::create_directory(path);
    return path;
  }

  const fs::path directory_ = made();
};

std::string numbersOf(const Vector3& v) {
  return std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]);
}

std::string vertexLines() {
  std::string text;
  for (const Vector3& vertex : kVertices) text += numbersOf(vertex) + "\n";
  return text;
}

std::string faceLines() { return "3 0 1 2\n3 0 2 3\n3 0 3 1\n3 1 3 2\n"; }

std::string plyHead(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\n"
         "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string ply() { return plyHead("ascii") + vertexLines() + faceLines(); }

std::string off() { return "OFF\n# by hand\n4 4 6\n" + vertexLines() + faceLines(); }

template <class Number>
std::string bytes(Number number, bool big_end_first = false) {
  std::string text(sizeof number, '\0');
  std::memcpy(&text[0], &number, sizeof number);
  return big_end_first ? std::string(text.rbegin(), text.rend()) : text;
}

std::string binaryPly(bool big_end_first) {
  std::string text = plyHead(big_end_first ? "binary_big_endian" : "binary_little_endian");
  for (const Vector3& vertex : kVertices) {
    for (int k = 0; k < 3; ++k) text += bytes(static_cast<float>(vertex[k]), big_end_first);
  }
  for (std::size_t c = 0; c < kCorners.size(); ++c) {
    if (c % 3 == 0) text += '\3';
    text += bytes(kCorners[c], big_end_first);
  }
  return text;
}

std::string stl() {
  std::string text = "solid by hand\n";
  for (std::size_t c = 0; c < kCorners.size(); ++c) {
    if (c % 3 == 0) text += "facet normal 0 0 0\nouter loop\n";
    text += "vertex " + numbersOf(kVertices[kCorners[c]]) + "\n";
    if (c % 3 == 2) text += "endloop\nendfacet\n";
  }
  return text + "endsolid by hand\n";
}

std::string binaryStl() {
  std::string text(80, ' ');
  text.replace(0, 5, "solid");
  text += bytes(std::uint32_t(4));
  for (std::size_t c = 0; c < kCorners.size(); ++c) {
    if (c % 3 == 0) text += std::string(12, '\0');
    for (int k = 0; k < 3; ++k) text += bytes(static_cast<float>(kVertices[kCorners[c]][k]));
    if (c % 3 == 2) text += std::string(2, '\0');
  }
  return text;
}

TEST_F(SurfaceFile, OfIndexedFormatsKeepsTheOrderOfVerticesAndFaces) {
  for (const fs::path& path : {write("a.ply", ply()), write("b.PLY", binaryPly(false)),
                               write("c.ply", binaryPly(true)), write("a.off", off()),
                               write("no_ending",
                                     "v 1 1 1\nv 1 -1 -1\nv -1 1 -1\nv -1 -1 0.5\n"
                                     "f 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n")}) {
    const PolygonMesh mesh = readPolygons(path);
    EXPECT_EQ(kVertices, mesh.vertices) << path;
    EXPECT_EQ(kCorners, mesh.corners) << path;
    EXPECT_EQ((std::vector<std::size_t>{3, 6, 9, 12}), mesh.ends) << path;
    EXPECT_TRUE(mesh.numbers_vertices) << path;
  }
}

TEST_F(SurfaceFile, OfStlHasAVertexEachCorner) {
  for (const fs::path& path : {write("a.stl", stl()), write("b.STL", binaryStl())}) {
    const PolygonMesh mesh = readPolygons(path);
    ASSERT_EQ(kCorners.size(), mesh.vertices.size()) << path;
    for (std::size_t c = 0; c < kCorners.size(); ++c) {
      EXPECT_EQ(kVertices[kCorners[c]], mesh.vertices[mesh.corners[c]]) << path;
    }
    EXPECT_FALSE(mesh.numbers_vertices) << path;
  }
}

TEST_F(SurfaceFile, OfSeveralSolidsHasAllTheirFaces) {
  EXPECT_EQ(8, readPolygons(write("a.stl", stl() + stl())).faces());
}

TEST_F(SurfaceFile, MayHavePolygons) {
  const PolygonMesh mesh =
      readPolygons(write("a.off", "OFF\n4 2 0\n" + vertexLines() + "4 0 1 2 3\n3 0 1 2\n"));
  EXPECT_EQ((std::vector<std::size_t>{4, 7}), mesh.ends);
}

TEST_F(SurfaceFile, IsRefusedWithTheFileAndAReason) {
  const auto replaced = [](std::string text, const std::string& old, const std::string& by) {
    return text.replace(text.rfind(old), old.size(), by);
  };
  expectRefused("a.ply", replaced(ply(), "3 1 3 2", "3 1 3 77"), "face 3 has vertex 77");
  expectRefused("a.ply", replaced(ply(), "3 1 3 2", "3 1 3 -2"), "face 3 has vertex -2");
  expectRefused("a.off", replaced(off(), "3 1 3 2", "3 1 3 77"),
                "OFF: Vertex index is out of range");
  expectRefused("a.ply", plyHead("ascii").replace(0, 3, "plx"), "");
  expectRefused("a.ply", "", "");
  expectRefused("a.stl", binaryStl().substr(0, 250), "");
  expectRefused("a.stl", std::string(3000, '\1'), "");
  expectRefused("a.off", "OFF BINARY\n" + std::string(100, '\2'), "");
  const std::string points =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n0 0 0\n";
  expectRefused("a.ply", points, "it has no face");
}

TEST_F(SurfaceFile, IsRefusedWhereACoordinateIsNotFinite) {
  std::string text = binaryPly(false);
  const std::string infinite = bytes(std::numeric_limits<float>::infinity());
  text.replace(plyHead("binary_little_endian").size() + 16, infinite.size(), infinite);
  expectRefused("a.ply", text, "vertex 1 is not finite");
}

}  // namespace
}  // namespace spherical_springs::mesh
