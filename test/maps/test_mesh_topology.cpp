// Which meshes are refused, and why.
#include <gtest/gtest.h>

#include <limits>

#include "maps/half_edges.h"
#include "maps/topological_sphere.h"
#include "spherical_springs/maps/sphere_map.h"
#include "support/shapes.h"

namespace spherical_springs::mesh {
namespace {

std::string refusal(const TriangleMesh& mesh) {
  try {
    requireTopologicalSphere(mesh);
  } catch (const std::invalid_argument& fault) {
    return fault.what();
  }
  return "";
}

void expectRefusal(const TriangleMesh& mesh, const std::string& reason) {
  EXPECT_NE(refusal(mesh).find(reason), std::string::npos)
      << "'" << refusal(mesh) << "' does not contain '" << reason << "'";
}

TriangleMesh sphere() {
  return testing::deformedSphere(1, [](const Vector3& p) { return p; });
}

TriangleMesh withoutFace(TriangleMesh mesh, Eigen::Index face) {
  Faces kept(3, mesh.faces.cols() - 1);
  kept << mesh.faces.leftCols(face), mesh.faces.rightCols(mesh.faces.cols() - face - 1);
  mesh.faces = kept;
  return mesh;
}

TriangleMesh twoOf(const TriangleMesh& mesh) {
  TriangleMesh both;
  both.vertices.resize(3, 2 * mesh.vertices.cols());
  both.vertices << mesh.vertices, mesh.vertices;
  both.faces.resize(3, 2 * mesh.faces.cols());
  const auto count = static_cast<std::int32_t>(mesh.vertices.cols());
  both.faces << mesh.faces, mesh.faces.array() + count;
  return both;
}

TriangleMesh torus() {
  constexpr int kAround = 8, kAcross = 6;
  TriangleMesh mesh;
  mesh.vertices = Points::Random(3, kAround * kAcross);
  mesh.faces.resize(3, 2 * kAround * kAcross);
  const auto at = [](int i, int j) { return i % kAround * kAcross + j % kAcross; };
  for (int i = 0; i < kAround; ++i) {
    for (int j = 0; j < kAcross; ++j) {
      mesh.faces.col(2 * at(i, j)) << at(i, j), at(i + 1, j), at(i + 1, j + 1);
      mesh.faces.col(2 * at(i, j) + 1) << at(i, j), at(i + 1, j + 1), at(i, j + 1);
    }
  }
  return mesh;
}

TEST(MeshTopology, SpheresPass) {
  EXPECT_EQ(refusal(sphere()), "");
  EXPECT_EQ(refusal(testing::tetrahedron()), "");
  for (const auto& shape : testing::fiftyShapes()) EXPECT_EQ(refusal(shape.mesh), "") << shape.name;
}

TEST(MeshTopology, OpenMeshesAreRefused) {
  expectRefusal(withoutFace(sphere(), 7), "the mesh is open: it has 1 hole, of 3 edges; edge ");
}

TEST(MeshTopology, FacesTurnedOverAreRefused) {
  TriangleMesh mesh = sphere();
  std::swap(mesh.faces(0, 7), mesh.faces(1, 7));
  expectRefusal(mesh, "runs the same way in face ");
  expectRefusal(mesh, "7");
}

TEST(MeshTopology, EdgesOfThreeFacesAreRefused) {
  TriangleMesh mesh = sphere();
  mesh.faces.conservativeResize(3, mesh.faces.cols() + 1);
  mesh.faces.col(mesh.faces.cols() - 1) << mesh.faces(0, 7), mesh.faces(1, 7), 40;
  expectRefusal(mesh, "runs the same way in face 7 and face 80");
}

TEST(MeshTopology, TwoPiecesAreRefused) {
  expectRefusal(twoOf(sphere()),
                "the mesh has 2 pieces, of 80 and 80 faces; face 80 is not connected with face 0");
}

TEST(MeshTopology, PiecesThatMeetInAVertexAreRefused) {
  TriangleMesh mesh = sphere();
  // Bridges two far vertices into one.
  const std::int32_t far = 3;
  for (Eigen::Index c = 0; c < mesh.faces.size(); ++c) {
    if (mesh.faces(c) == far) mesh.faces(c) = 0;
  }
  mesh.vertices.col(far) = mesh.vertices.col(41);
  for (Eigen::Index c = 0; c < mesh.faces.size(); ++c) {
    if (mesh.faces(c) == 41) mesh.faces(c) = far;
  }
  mesh.vertices.conservativeResize(3, 41);
  expectRefusal(mesh, "vertex 0 joins parts of the mesh that share no edge there");
}

TEST(MeshTopology, ATorusIsRefused) { expectRefusal(torus(), "of genus 1; allowed: 0"); }

TEST(MeshTopology, FaultyFacesAreRefused) {
  TriangleMesh mesh = sphere();
  mesh.faces(1, 5) = mesh.faces(0, 5);
  expectRefusal(mesh, "face 5 has one vertex twice");
  mesh.faces(1, 5) = 42;
  expectRefusal(mesh, "face 5 has vertex 42; allowed: 0 to 41");
  mesh.faces(1, 5) = -1;
  expectRefusal(mesh, "face 5 has vertex -1");
  mesh.faces.resize(3, 0);
  expectRefusal(mesh, "the number of faces is 0");
}

TEST(MeshTopology, FaultyVerticesAreRefused) {
  TriangleMesh mesh = sphere();
  mesh.vertices(1, 9) = std::numeric_limits<double>::quiet_NaN();
  expectRefusal(mesh, "vertex 9 is not finite");
  mesh = sphere();
  mesh.vertices.conservativeResize(3, 43);
  mesh.vertices.col(42).setZero();
  expectRefusal(mesh, "vertex 42 belongs to no face");
}

TEST(MeshTopology, TwinsRunOppositeWays) {
  const TriangleMesh mesh = sphere();
  const HalfEdges edges(mesh.faces);
  for (HalfEdges::Index h = 0; h < edges.size(); ++h) {
    EXPECT_EQ(edges.twin(edges.twin(h)), h);
    EXPECT_EQ(edges.origin(edges.twin(h)), edges.target(h));
    EXPECT_EQ(edges.origin(edges.turned(h)), edges.origin(h));
  }
}

TEST(FaceShares, AreInProportionAndSumToTheSphere) {
  const Eigen::VectorXd shares = faceShares(Eigen::Vector4d(1, 2, 3, 4));
  EXPECT_NEAR(shares.sum(), 4 * core::kPi, 1e-12);
  EXPECT_NEAR(shares[3], 4 * shares[0], 1e-12);
}

TEST(FaceShares, HaveAFloor) {
  const Eigen::VectorXd shares = faceShares(Eigen::Vector4d(0, 2e300, 3e300, 4e300));
  EXPECT_NEAR(shares[0], 1e-6 * core::kPi, 1e-9);
  EXPECT_NEAR(shares.sum(), 4 * core::kPi, 1e-12);
}

TEST(Volume, IsThatOfTheBodyAndNegativeInsideOut) {
  TriangleMesh mesh = testing::tetrahedron();
  const Vector3 a = mesh.vertices.col(0);
  const auto edge = [&](int i) -> Vector3 { return mesh.vertices.col(i) - a; };
  const double expected = std::abs(edge(1).dot(edge(2).cross(edge(3)))) / 6;
  mesh.vertices.colwise() += Vector3(1e3, 2e3, -3e3);
  EXPECT_NEAR(volume(mesh), expected, 1e-9);
  mesh.faces.row(0).swap(mesh.faces.row(1));
  EXPECT_NEAR(volume(mesh), -expected, 1e-9);
}

TEST(FaceShares, RefuseFaultyAreas) {
  EXPECT_THROW(faceShares(Eigen::Vector2d(1, -1)), std::invalid_argument);
  EXPECT_THROW(faceShares(Eigen::Vector2d(0, 0)), std::invalid_argument);
  EXPECT_THROW(faceShares(Eigen::Vector2d(1, std::numeric_limits<double>::infinity())),
               std::invalid_argument);
}

}  // namespace
}  // namespace spherical_springs::mesh
