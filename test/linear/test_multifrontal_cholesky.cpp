// Exact solutions of sparse systems along a nested dissection.
#include <gtest/gtest.h>

#include <numeric>

#include "linear/minimum_degree.h"
#include "linear/multifrontal_cholesky.h"
#include "maps/fold_free_start.h"
#include "maps/map_energy.h"
#include "spherical_springs/maps/sphere_map.h"
#include "support/hub_shapes.h"

namespace spherical_springs::core {
namespace {

/// A definite matrix on the edges of a mesh, and one like it that is not.
struct Case {
  explicit Case(int level) {
    const auto mesh = mesh::testing::deformedSphere(level, [](const Vector3& p) { return p; });
    mesh::MapEnergy energy(mesh.faces, mesh::faceShares(mesh::faceAreas(mesh)), mesh.vertices, 1);
    energy.setShape(0.3);
    energy.evaluate(mesh::FaceHessian::definite);
    pattern = energy.pattern();
    values = energy.hessian();
    for (std::size_t i = 0; i < pattern.rows(); ++i) {
      values[pattern.diagonal[i]] += 0.1 * Eigen::Matrix2d::Identity();
    }
  }
  BlockPattern pattern;
  Blocks<double, 2> values;
};

VectorOf<double> product(const BlockPattern& pattern, const Blocks<double, 2>& values,
                         const VectorOf<double>& x) {
  VectorOf<double> result(x.size());
  for (std::size_t i = 0; i < pattern.rows(); ++i) {
    part<2>(result, i) = rowProduct<double, 2>(pattern.graph, values, x, pattern.graph.first[i],
                                               pattern.graph.first[i + 1]);
  }
  return result;
}

BlockPattern patternOf(const mesh::TriangleMesh& mesh) {
  const auto start = mesh::foldFreeStart(mesh.faces, mesh::HalfEdges(mesh.faces),
                                         mesh.vertices.cols(), mesh::testing::sharesOf(mesh), 0);
  return mesh::MapEnergy(start.faces, start.shares, start.points, 1).pattern();
}

/// A matrix on a pattern whose diagonal is more than the sum of the others of each row.
Blocks<double, 2> dominantMatrix(const BlockPattern& pattern) {
  testing::Random random(4);
  Blocks<double, 2> values(pattern.graph.neighbours.size(), Eigen::Matrix2d::Zero());
  for (std::uint32_t i = 0; i < pattern.rows(); ++i) {
    values[pattern.diagonal[i]] += 0.1 * Eigen::Matrix2d::Identity();
    for (std::uint32_t e = pattern.graph.first[i]; e < pattern.graph.first[i + 1]; ++e) {
      const std::uint32_t j = pattern.graph.neighbours[e];
      if (j <= i) continue;
      values[e] << random.between(-1, 1), random.between(-1, 1), random.between(-1, 1),
          random.between(-1, 1);
      values[pattern.place(j, i)] = values[e].transpose();
      for (const std::uint32_t n : {i, j}) {
        values[pattern.diagonal[n]] += values[e].norm() * Eigen::Matrix2d::Identity();
      }
    }
  }
  return values;
}

VectorOf<double> randomVector(std::size_t size) {
  testing::Random random(3);
  VectorOf<double> result(size);
  for (Eigen::Index i = 0; i < result.size(); ++i) result[i] = random.between(-1, 1);
  return result;
}

/// Blocks of the factor.
double entries(const NestedDissection& dissection) {
  double sum = 0;
  for (const auto& part : dissection.parts) {
    const double own = part.end - part.first;
    sum += own * (own + part.boundary.size());
  }
  return sum;
}

TEST(NestedDissection, OrdersEveryNodeOnceAndBoundsFill) {
  const Case scene(4);
  const NestedDissection dissection = nestedDissection(scene.pattern.graph);
  std::vector<bool> seen(scene.pattern.rows(), false);
  for (const std::uint32_t i : dissection.order) {
    EXPECT_FALSE(seen[i]);
    seen[i] = true;
  }
  EXPECT_EQ(dissection.order.size(), seen.size());
  EXPECT_LT(entries(dissection), 100 * seen.size());  // a band along a curve takes some 250 a row
}

TEST(NestedDissection, BoundsFillWhereAllNodesAreClose) {
  for (const auto& shape : mesh::testing::shapesWithHubs(10'000)) {
    const Graph graph = patternOf(shape.mesh).graph;
    const NestedDissection dissection = nestedDissection(graph);
    EXPECT_LT(entries(dissection), 50 * graph.size()) << shape.name;
  }
}

TEST(NestedDissection, TakesAnyNumberOfPieces) {
  constexpr std::uint32_t kAlone = 200'010, kChain = 1000;  // not whole parts
  Graph graph;
  graph.first = {0};
  for (std::uint32_t i = 0; i < kAlone + kChain; ++i) {
    if (i > kAlone) graph.neighbours.push_back(i - 1);
    graph.neighbours.push_back(i);
    if (i >= kAlone && i + 1 < kAlone + kChain) graph.neighbours.push_back(i + 1);
    graph.first.push_back(static_cast<std::uint32_t>(graph.neighbours.size()));
  }
  const NestedDissection dissection = nestedDissection(graph);
  std::vector<std::uint32_t> order = dissection.order, all(graph.size());
  std::sort(order.begin(), order.end());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(order, all);
  for (const auto& part : dissection.parts) {
    EXPECT_LE(part.end - part.first, 48);
    EXPECT_LE(part.boundary.size(), 2);
  }
}

/// Legs that meet in node 0: cut across, they leave pieces, each of which is large.
Graph spider(std::uint32_t legs, std::uint32_t length) {
  Graph graph;
  graph.first = {0};
  for (std::uint32_t i = 0; i <= legs * length; ++i) {
    if (i > 0) graph.neighbours.push_back(i > legs ? i - legs : 0);
    graph.neighbours.push_back(i);
    const std::uint32_t next = i > 0 ? i + legs : 1, last = std::min(i + legs, legs * length);
    for (std::uint32_t j = next; j <= last; ++j) graph.neighbours.push_back(j);
    graph.first.push_back(static_cast<std::uint32_t>(graph.neighbours.size()));
  }
  return graph;
}

TEST(NestedDissection, HandsOnTheBoundariesOfPieces) {
  const NestedDissection dissection = nestedDissection(spider(5, 100));
  std::vector<int> parents(dissection.parts.size(), 0);
  for (const auto& part : dissection.parts) {
    for (const std::uint32_t child : part.children) ++parents[child];
  }
  for (std::size_t p = 0; p < parents.size(); ++p) {
    EXPECT_EQ(parents[p], dissection.parts[p].boundary.empty() ? 0 : 1);
  }
}

TEST(MultifrontalCholesky, Solves) {
  for (const int level : {0, 1, 2, 3, 4}) {
    const Case scene(level);
    MultifrontalCholesky inverse(scene.pattern, 1);
    ASSERT_TRUE(inverse.refresh(scene.values));
    const VectorOf<double> x = randomVector(2 * scene.pattern.rows());
    VectorOf<double> found;
    inverse.apply(product(scene.pattern, scene.values, x), found);
    EXPECT_LT((found - x).norm(), 1e-9 * x.norm()) << level;
  }
}

TEST(MultifrontalCholesky, SolvesWhereAllNodesAreClose) {
  for (const auto& shape : mesh::testing::shapesWithHubs(3000)) {
    const BlockPattern pattern = patternOf(shape.mesh);
    const Blocks<double, 2> values = dominantMatrix(pattern);
    const VectorOf<double> x = randomVector(2 * pattern.rows());
    MultifrontalCholesky inverse(pattern, 2);
    ASSERT_TRUE(inverse.refresh(values));
    VectorOf<double> found;
    inverse.apply(product(pattern, values, x), found);
    EXPECT_LT((found - x).norm(), 1e-9 * x.norm()) << shape.name;
  }
}

TEST(MultifrontalCholesky, EndsAtACheckpointAndBeginsAnew) {
  const Case scene(4);
  int left = 1 << 30;
  const auto checkpoint = [&] {
    if (--left < 0) throw std::domain_error("enough");
  };
  MultifrontalCholesky inverse(scene.pattern, 1, checkpoint), undisturbed(scene.pattern, 1);
  const VectorOf<double> b = randomVector(2 * scene.pattern.rows());
  VectorOf<double> expected, found;
  ASSERT_TRUE(undisturbed.refresh(scene.values));
  undisturbed.apply(b, expected);
  for (const int checks : {0, 1, 40}) {
    left = checks;
    EXPECT_THROW(inverse.refresh(scene.values), std::domain_error);
    left = 1 << 30;
    ASSERT_TRUE(inverse.refresh(scene.values));
    left = checks;
    EXPECT_THROW(inverse.apply(b, found), std::domain_error);
    left = 1 << 30;
    inverse.apply(b, found);
    EXPECT_EQ(found, expected);
  }
  left = 10;
  EXPECT_THROW(nestedDissection(scene.pattern.graph, checkpoint), std::domain_error);
}

Graph withoutEdges(std::uint32_t nodes) {
  Graph graph;
  graph.first = {0};
  for (std::uint32_t i = 0; i < nodes; ++i) {
    graph.neighbours.push_back(i);
    graph.first.push_back(i + 1);
  }
  return graph;
}

/// All nodes joined with each other.
Graph complete(std::uint32_t nodes) {
  Graph graph;
  graph.first = {0};
  for (std::uint32_t i = 0; i < nodes; ++i) {
    for (std::uint32_t j = 0; j < nodes; ++j) graph.neighbours.push_back(j);
    graph.first.push_back(static_cast<std::uint32_t>(graph.neighbours.size()));
  }
  return graph;
}

TEST(MinimumDegree, OrdersEveryNodeOnceInPostorder) {
  std::vector<Graph> graphs = {withoutEdges(0), withoutEdges(100), complete(1),
                               complete(30),    spider(5, 100),    spider(1000, 2)};
  for (const auto& shape : mesh::testing::shapesWithHubs(2000)) {
    graphs.push_back(patternOf(shape.mesh).graph);
  }
  for (const Graph& graph : graphs) {
    SCOPED_TRACE(graph.size());
    const auto groups = minimumDegree(graph);
    std::vector<std::uint32_t> order, all(graph.size());
    std::vector<std::size_t> first(groups.size());  // of the groups below each, and itself
    for (std::size_t g = 0; g < groups.size(); ++g) {
      order.insert(order.end(), groups[g].nodes.begin(), groups[g].nodes.end());
      std::size_t expected = g;  // the root of what comes before
      for (auto child = groups[g].children.rbegin(); child != groups[g].children.rend(); ++child) {
        EXPECT_EQ(*child + 1, expected);
        expected = first[*child];
      }
      first[g] = expected;
    }
    EXPECT_EQ(first.back(), 0u);
    std::sort(order.begin(), order.end());
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(order, all);
  }
}

TEST(MultifrontalCholesky, TellsOfAMatrixThatIsNotDefinite) {
  Case scene(3);
  MultifrontalCholesky inverse(scene.pattern, 1);
  const Eigen::Matrix2d block = scene.values[scene.pattern.diagonal[77]];
  scene.values[scene.pattern.diagonal[77]] -= 2 * block;
  EXPECT_FALSE(inverse.refresh(scene.values));
  scene.values[scene.pattern.diagonal[77]] = block;
  EXPECT_TRUE(inverse.refresh(scene.values));
}

TEST(MultifrontalCholesky, DoesNotDependOnThreads) {
  const Case scene(5);
  const VectorOf<double> b = randomVector(2 * scene.pattern.rows());
  VectorOf<double> one, three;
  for (const int threads : {1, 3}) {
    MultifrontalCholesky inverse(scene.pattern, threads);
    ASSERT_TRUE(inverse.refresh(scene.values));
    inverse.apply(b, threads == 1 ? one : three);
  }
  EXPECT_EQ(one, three);
}

}  // namespace
}  // namespace spherical_springs::core
