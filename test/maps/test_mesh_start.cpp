// The start that cannot fold, and the way to it and from it through coarser meshes.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <set>

#include "maps/coverage.h"
#include "maps/decimation.h"
#include "maps/fold_free_start.h"
#include "maps/insertion.h"
#include "maps/schnyder_wood.h"
#include "maps/topological_sphere.h"
#include "spherical_springs/maps/sphere_map.h"
#include "support/hub_shapes.h"

namespace spherical_springs::mesh {
namespace {

Eigen::VectorXd sharesOf(const TriangleMesh& mesh) { return faceShares(faceAreas(mesh)); }

FoldFreeStart startOf(const TriangleMesh& mesh, const Eigen::VectorXd& shares) {
  Eigen::Index largest = 0;
  shares.maxCoeff(&largest);
  return foldFreeStart(mesh.faces, HalfEdges(mesh.faces), mesh.vertices.cols(), shares, largest);
}

TEST(SchnyderWood, HasThreeTreesThatHoldEveryInnerEdgeOnce) {
  const TriangleMesh mesh = testing::bumps(2, 1);
  const HalfEdges edges(mesh.faces);
  const auto wood = schnyderWood(edges, mesh.vertices.cols(), 17);
  std::set<std::pair<int, int>> held;
  for (int v = 0; v < mesh.vertices.cols(); ++v) {
    for (int tree = 0; tree < 3; ++tree) {
      int steps = 0, u = v;
      for (; wood.parents[u][tree] != HalfEdges::kNone; u = wood.parents[u][tree]) {
        ASSERT_LT(++steps, mesh.vertices.cols()) << "a circle";
      }
      if (wood.parents[v][tree] == HalfEdges::kNone) continue;
      EXPECT_EQ(u, wood.roots[tree]);
      const int parent = wood.parents[v][tree];
      EXPECT_TRUE(held.emplace(std::min(v, parent), std::max(v, parent)).second);
    }
  }
  EXPECT_EQ(held.size(), static_cast<std::size_t>(edges.size() / 2 - 3));
}

TEST(FoldFreeStart, OfFiftyShapesDoesNotFold) {
  for (const auto& shape : testing::fiftyShapes()) {
    const FoldFreeStart start = startOf(shape.mesh, sharesOf(shape.mesh));
    EXPECT_TRUE(coversOnce(start.faces, start.points)) << shape.name;
    EXPECT_NEAR(start.shares.sum(), 4 * core::kPi, 1e-9);
  }
}

TEST(FoldFreeStart, OfTheSmallestMeshDoesNotFold) {
  const FoldFreeStart start =
      startOf(testing::tetrahedron(), Eigen::VectorXd::Constant(4, core::kPi));
  EXPECT_TRUE(coversOnce(start.faces, start.points));
}

TEST(FoldFreeStart, BearsSharesOfEveryMagnitude) {
  testing::Random random(5);
  const TriangleMesh mesh = testing::bumps(4, 2);
  Eigen::VectorXd weights(mesh.faces.cols());
  for (Eigen::Index f = 0; f < weights.size(); ++f) {
    weights[f] = std::pow(10, random.between(-12, 0));
  }
  const FoldFreeStart start = startOf(mesh, faceShares(weights));
  EXPECT_TRUE(coversOnce(start.faces, start.points));
}

// In the barycentre of the regions' shares: mapped back to the plane, three faces that share the
// whole between them have areas in proportion.
TEST(FoldFreeStart, OfATetrahedronHasTheSharesAsAreas) {
  const FoldFreeStart start =
      startOf(testing::tetrahedron(), faceShares(Eigen::Vector4d(1, 2, 3, 10)));
  const Eigen::Matrix3d corners = start.points.middleCols(1, 3);
  const Eigen::Vector3d inner = corners.inverse() * start.points.col(0);
  std::multiset<int> parts;
  for (Eigen::Index i = 0; i < inner.size(); ++i) {
    parts.insert(static_cast<int>(std::lround(6 * inner[i] / inner.sum())));
  }
  EXPECT_EQ(parts, (std::multiset<int>{1, 2, 3}));
}

std::set<std::array<int, 3>> facesOf(const MeshLevel& level) {
  std::set<std::array<int, 3>> result;
  for (Eigen::Index f = 0; f < level.faces.cols(); ++f) {
    std::array<int, 3> face = {level.faces(0, f), level.faces(1, f), level.faces(2, f)};
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    result.insert(face);
  }
  return result;
}

std::array<int, 3> turned(std::array<int, 3> face) {
  std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  return face;
}

TEST(Decimation, UndoneGivesBackEveryLevel) {
  for (const auto& mesh : {testing::star(4, 1, false, 3), testing::coil(200, 8, 2, 0.1)}) {
    const auto count = static_cast<std::int32_t>(mesh.vertices.cols());
    const Decimation meshes = decimation(mesh.faces, sharesOf(mesh), count, 100);
    ASSERT_GT(meshes.levels.size(), 2u);
    EXPECT_LE(meshes.levels.front().vertex_count, 100);
    auto faces = facesOf(meshes.levels.front());
    for (std::size_t l = 1; l < meshes.levels.size(); ++l) {
      for (int v = meshes.levels[l - 1].vertex_count; v < meshes.levels[l].vertex_count; ++v) {
        const auto& ring = meshes.rings[v];
        for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
          EXPECT_EQ(faces.erase(turned({ring[0], ring[i], ring[i + 1]})), 1u);
        }
        for (std::size_t i = 0; i < ring.size(); ++i) {
          faces.insert(turned({v, ring[i], ring[(i + 1) % ring.size()]}));
        }
      }
      EXPECT_EQ(faces, facesOf(meshes.levels[l]));
      EXPECT_NEAR(meshes.levels[l].shares.sum(), 4 * core::kPi, 1e-9);
    }
    Faces original = meshes.levels.back().faces;
    for (Eigen::Index c = 0; c < original.size(); ++c) original(c) = meshes.vertices[original(c)];
    EXPECT_EQ(original, mesh.faces);
  }
}

TEST(Decimation, LevelsAreSpheresDownToTheSmallest) {
  for (const auto& shape : testing::fiftyShapes()) {
    const auto count = static_cast<std::int32_t>(shape.mesh.vertices.cols());
    const Decimation meshes = decimation(shape.mesh.faces, sharesOf(shape.mesh), count, 4);
    for (const MeshLevel& level : meshes.levels) {
      EXPECT_NO_THROW(requireTopologicalSphere({Points::Zero(3, level.vertex_count), level.faces}))
          << shape.name;
    }
  }
}

TEST(Decimation, TakesVerticesOfManyFaces) {
  for (const auto& shape : testing::shapesWithHubs(20'000)) {
    const auto count = static_cast<std::int32_t>(shape.mesh.vertices.cols());
    const Decimation meshes = decimation(shape.mesh.faces, sharesOf(shape.mesh), count, 100);
    EXPECT_EQ(meshes.levels.front().vertex_count, 100) << shape.name;
    for (const MeshLevel& level : meshes.levels) {
      EXPECT_NO_THROW(requireTopologicalSphere({Points::Zero(3, level.vertex_count), level.faces}))
          << shape.name;
    }
  }
}

TEST(Decimation, PassesACheckpointWithEachVertex) {
  const TriangleMesh mesh = testing::doublePyramid(1000);
  const Eigen::VectorXd shares = sharesOf(mesh);
  int left = 2000;
  EXPECT_NO_THROW(decimation(mesh.faces, shares, 1002, 900, [&] { --left; }));
  EXPECT_LT(left, 900);
  EXPECT_THROW(decimation(mesh.faces, shares, 1002, 4,
                          [&] {
                            if (--left < 0) throw std::domain_error("enough");
                          }),
               std::domain_error);
}

TEST(Decimation, StopsAtATetrahedron) {
  const TriangleMesh mesh = testing::bumps(2, 1);
  const auto count = static_cast<std::int32_t>(mesh.vertices.cols());
  EXPECT_EQ(decimation(mesh.faces, sharesOf(mesh), count, 4).levels.front().vertex_count, 4);
}

TEST(Decimation, PlacesInsideRingsOfAnyShape) {
  testing::Random random(7);
  for (int run = 0; run < 300; ++run) {
    // A fan round its first vertex, with angles that may sum to nearly a whole turn.
    const int others = 3 + run % 6;
    std::vector<std::int32_t> ring = {0};
    Points points(3, others + 1);
    points.col(0) = random.unitVector();
    const auto frame = core::tangentFrame(points.col(0));
    double angle = random.between(0, 6);
    const double whole = random.between(0.01, 6);
    for (int i = 1; i <= others; ++i) {
      ring.push_back(i);
      const double distance = random.between(0.001, 1);
      points.col(i) = core::rotated(points.col(0), distance * (std::cos(angle) * frame.col(0) +
                                                               std::sin(angle) * frame.col(1)));
      angle += std::min(whole / (others - 1), 3.);
    }
    const Vector3 place = placeInside(ring, points);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      EXPECT_TRUE(
          surelyPositive(place, points.col(ring[i]), points.col(ring[(i + 1) % ring.size()])))
          << run;
    }
  }
}

TEST(Coverage, KnowsFoldsAndDoubleCovers) {
  const TriangleMesh mesh = testing::deformedSphere(2, [](const Vector3& p) { return p; });
  EXPECT_TRUE(coversOnce(mesh.faces, mesh.vertices));
  EXPECT_FALSE(coversOnce(mesh.faces, -mesh.vertices));
  Points folded = mesh.vertices;
  const std::int32_t v = mesh.faces(0, 7), w = mesh.faces(1, 7);
  folded.col(v) = (1.5 * folded.col(w) - 0.5 * folded.col(v)).normalized();
  EXPECT_FALSE(coversOnce(mesh.faces, folded));
  // An octahedron with its equator cut finer and wound twice.
  std::vector<Vector3> vertices = {Vector3::UnitZ(), -Vector3::UnitZ()};
  std::vector<std::array<std::uint32_t, 3>> faces;
  for (std::uint32_t i = 0; i < 8; ++i) {
    vertices.push_back({std::cos(core::kPi * i / 2), std::sin(core::kPi * i / 2), 0});
    const std::uint32_t here = 2 + i, next = 2 + (i + 1) % 8;
    faces.push_back({0, here, next});
    faces.push_back({1, next, here});
  }
  const TriangleMesh twice = testing::meshOf(vertices, faces);
  for (Eigen::Index f = 0; f < twice.faces.cols(); ++f) {
    ASSERT_TRUE(surelyPositive(twice.vertices.col(twice.faces(0, f)),
                               twice.vertices.col(twice.faces(1, f)),
                               twice.vertices.col(twice.faces(2, f))));
  }
  EXPECT_FALSE(coversOnce(twice.faces, twice.vertices));
}

}  // namespace
}  // namespace spherical_springs::mesh
