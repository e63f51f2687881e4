#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "support/mesh_scenes.h"
#include "surfaces/obj_file.h"
#include "surfaces/surface.h"
#include "surfaces/surface_file.h"

namespace spherical_springs::mesh {
namespace {

TriangleMesh meshOf(const std::string& text) {
  std::istringstream in(text);
  return triangulated(readObj(in)).mesh;
}

std::string reasonAgainst(const std::string& text) {
  try {
    meshOf(text);
  } catch (const std::invalid_argument& fault) {
    return fault.what();
  }
  return "taken";
}

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

/// Throws when it is passed more often than that.
core::Checkpoint checkpointAfter(int times) {
  return [times]() mutable {
    if (--times < 0) throw std::domain_error("enough");
  };
}

TEST(ObjFile, PassesACheckpointWithEachLine) {
  std::istringstream in(kCorners + "f 1 2 3\n");
  EXPECT_THROW(readObj(in, checkpointAfter(3)), std::domain_error);
  const TriangleMesh sphere = mesh_scenes::icosphere(0);
  std::ostringstream out;
  EXPECT_NO_THROW(writeObj(out, sphere, checkpointAfter(12 + 20)));
  EXPECT_THROW(writeObj(out, sphere, checkpointAfter(12 + 19)), std::domain_error);
  const TexturedSurface texture{sphere, Eigen::Matrix2Xd::Zero(2, 5), sphere.faces};
  EXPECT_NO_THROW(writeObj(out, texture, checkpointAfter(12 + 5 + 20)));
  EXPECT_THROW(writeObj(out, texture, checkpointAfter(12 + 5 + 19)), std::domain_error);
}

TEST(ObjFile, KeepsOrderAndEveryBit) {
  const TriangleMesh sphere = mesh_scenes::icosphere(2);
  std::stringstream file;
  writeObj(file, sphere);
  const TriangleMesh again = triangulated(readObj(file)).mesh;
  EXPECT_EQ(sphere.vertices, again.vertices);
  EXPECT_EQ(sphere.faces, again.faces);
}

TEST(ObjFile, WithTextureCoordinatesNamesPlaceAndVertexOfEachCorner) {
  TexturedSurface texture{
      {Points::Identity(3, 3), Faces(3, 1)}, Eigen::Matrix2Xd(2, 4), Faces(3, 1)};
  texture.surface.faces << 2, 0, 1;
  texture.places << 0, 0.25, 0.5, 1.5, 0, 0.125, 1, 0.75;
  texture.corners << 3, 0, 1;
  std::ostringstream file;
  writeObj(file, texture);
  EXPECT_EQ(
      "v 1 0 0\nv 0 1 0\nv 0 0 1\n"
      "vt 0 0\nvt 0.25 0.125\nvt 0.5 1\nvt 1.5 0.75\nf 3/4 1/1 2/2\n",
      file.str());
}

TEST(ObjFile, IsReadWhateverElseItHolds) {
  const TriangleMesh mesh = meshOf(
      "# a comment\r\nmtllib x.mtl\r\no head\r\n"
      "v 1 2e-1 -.5\r\n  v\t0 0 0 1.0\r\nv 3 0 0 0.1 0.2 0.3\r\n"
      "vn 0 0 1\r\nvt 0 0\r\nl 1 2\r\n"
      "f 1/1 2/1 3/1 \r\nf -3 -1//1 -2/1/1\r\ns off\r\nf 4 1 2\r\nv 7 8 9");
  ASSERT_EQ(4, mesh.vertices.cols());
  EXPECT_EQ(Vector3(1, 0.2, -0.5), mesh.vertices.col(0));
  EXPECT_EQ(Vector3(7, 8, 9), mesh.vertices.col(3));
  Faces faces(3, 3);
  faces << 0, 0, 3, 1, 2, 0, 2, 1, 1;
  EXPECT_EQ(faces, mesh.faces);
}

TEST(ObjFile, MayBeginWithAByteOrderMark) {
  const char* const text = "v 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\nf 1 2 3\n";
  const TriangleMesh mesh = meshOf(std::string("\xEF\xBB\xBF") + text);
  EXPECT_EQ(meshOf(text).vertices, mesh.vertices);
  EXPECT_EQ(meshOf(text).faces, mesh.faces);
}

TEST(ObjFile, MayHaveAnyLineEndsCommentsAndContinuedLines) {
  const TriangleMesh expected = meshOf(kCorners + "v 0 0 1\nf 1 2 3\nf 2 3 4\n");
  for (const char* text : {"v 0 0 0\rv 1 0 0\rv 0 1 0\rv 0 0 1\rf 1 2 3\rf 2 3 4",
                           "v 0 0 0 # of C:\\\nv 1 0 0# here\r\nv 0 1 0\nv 0 \\\n0 1\nf 1 2 3 # "
                           "4\nf 2\\\r\n3\\\r\n4\r\n"}) {
    EXPECT_EQ(expected.vertices, meshOf(text).vertices) << text;
    EXPECT_EQ(expected.faces, meshOf(text).faces) << text;
  }
  EXPECT_EQ("line 3: a vertex is not three finite numbers", reasonAgainst("v 0 \\\n0 0\rv 1 0\r"));
}

TEST(ObjFile, MayHavePolygons) {
  std::istringstream in(kCorners + "v 1 1 0\nv 9 9 9\nf 1/1 2/2 -2/3 3/4\nf 1 2 3\n");
  const PolygonMesh mesh = readObj(in);
  EXPECT_EQ((std::vector<std::int32_t>{0, 1, 3, 2, 0, 1, 2}), mesh.corners);
  EXPECT_EQ((std::vector<std::size_t>{4, 7}), mesh.ends);
  EXPECT_EQ((std::vector<std::uint32_t>{6, 7}), mesh.lines);
}

TEST(ObjFile, RefusesWhatIsNoVertex) {
  for (const char* line : {"v nan 0 0", "v 0 inf 0", "v 0 0 1e999", "v 1 2", "v 1 2 ", "v",
                           "v 1 2 x", "v 1 2 3x", "v 1,5 2 3"}) {
    const std::string reason = reasonAgainst(kCorners + line + " \nf 1 2 3\n");
    EXPECT_EQ("line 4: a vertex is not three finite numbers", reason) << line;
  }
}

TEST(ObjFile, RefusesWhatIsNoFace) {
  const auto reason = [](const std::string& line) { return reasonAgainst(kCorners + line + "\n"); };
  EXPECT_EQ("line 4: a corner of a face is not the number of a vertex", reason("f 1 2 x"));
  EXPECT_EQ("line 4: a corner of a face is not the number of a vertex", reason("f 1 2 3.5"));
  EXPECT_EQ("line 4: a corner of a face is not the number of a vertex", reason("f 1 2 /3"));
  EXPECT_EQ("line 4: a face has vertex 0, which is not there", reason("f 1 2 0"));
  EXPECT_EQ("line 4: a face has vertex -4, which is not there", reason("f -4 2 3"));
  EXPECT_EQ("line 4: a face has vertex 4; allowed: 1 to 3", reason("f 1 2 4"));
  EXPECT_NE("taken", reason("f 1 2 99999999999999999999"));
  EXPECT_NE("taken", reason("f 1 2 -99999999999999999999"));
  EXPECT_EQ("line 4: a face has 1 corner; allowed: 3 or more", reason("f 1"));
  EXPECT_EQ("line 4: a face has 2 corners; allowed: 3 or more", reason("f 1 2"));
}

TEST(ObjFile, RefusesWhatIsNoMesh) {
  EXPECT_EQ("not an OBJ file: it has no line 'v x y z'", reasonAgainst(""));
  EXPECT_EQ("not an OBJ file: it has no line 'v x y z'", reasonAgainst("OFF\n3 1 0\n"));
  EXPECT_EQ("not an OBJ file: it has no line 'v x y z'",
            reasonAgainst(std::string("\x7f"
                                      "ELF\0\0\1\xff\n\n\0",
                                      12)));
  EXPECT_EQ("it has vertices, and no face", reasonAgainst(kCorners));
}

TEST(ObjFile, RefusesWhatIsNoFile) {
  EXPECT_THROW(readPolygons("/nowhere/x.obj"), std::runtime_error);
  EXPECT_THROW(readPolygons(std::filesystem::temp_directory_path()), std::runtime_error);
}

TEST(ObjFile, IsNamedOnOneLine) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("a\nb" + std::to_string(::getpid()));
  std::ofstream(path) << "v 0 0 0\n";
  try {
    readPolygons(path);
    ADD_FAILURE() << "taken";
  } catch (const std::invalid_argument& fault) {
    EXPECT_EQ(std::string(fault.what()).find('\n'), std::string::npos) << fault.what();
    EXPECT_NE(std::string(fault.what()).find("/a?b"), std::string::npos) << fault.what();
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace spherical_springs::mesh
