// The meshes that measurements and other tests stand on.
#include <gtest/gtest.h>

#include "meshes.h"

namespace spherical_springs::core {
namespace {

using benchmark_scenes::Mesh;

/// Triangles that cover the sphere once have its area, if none is turned over.
void expectToCoverTheSphereOnce(const Mesh& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.faces) {
    const double part = solidAngle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    EXPECT_GT(part, 0);
    area += part;
  }
  EXPECT_NEAR(area, 4 * kPi, 1e-12);
}

TEST(Meshes, GeodesicGridsHaveAllSizes) {
  for (const std::uint32_t n : {1u, 2u, 3u, 4u, 7u, 20u}) {
    const Mesh grid = benchmark_scenes::geodesicGrid(n);
    EXPECT_EQ(grid.vertices.size(), 10 * n * n + 2);
    EXPECT_EQ(grid.faces.size(), 20 * n * n);
    EXPECT_EQ(grid.edges.size(), 30 * n * n);
    expectToCoverTheSphereOnce(grid);
  }
}

}  // namespace
}  // namespace spherical_springs::core
