// The kernels of each instruction set of this processor against the definition.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "base/instruction_set.h"
#include "geometry/tangent_place.h"
#include "maps/coverage.h"
#include "maps/face_energy.h"
#include "maps/face_kernels.h"
#include "support/scenes.h"

namespace spherical_springs::mesh {

extern const FaceKernels kPlainFaceKernels;
#if defined(__x86_64__)
extern const FaceKernels kAvx2FaceKernels, kAvx512FaceKernels;
#endif

namespace {

using core::TangentPlace;
using core::testing::Random;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

std::vector<FaceKernels> kernelsHere() {
  std::vector<FaceKernels> kernels = {kPlainFaceKernels};
#if defined(__x86_64__)
  if (core::hasAvx2()) kernels.push_back(kAvx2FaceKernels);
  if (core::hasAvx512()) kernels.push_back(kAvx512FaceKernels);
#endif
  return kernels;
}

/// Faces, each on three places of its own.
struct Bench {
  std::vector<TangentPlace> places;
  std::vector<std::int32_t> corners;
  std::vector<double> over_shares, weights;
  double shape = 0;
  AreaCost cost = AreaCost::barrier;

  std::uint32_t count() const { return static_cast<std::uint32_t>(corners.size() / 3); }
  FaceLists lists() const {
    return {corners.data(), over_shares.data(), weights.data(), shape, cost};
  }
  PointRows rows() const { return {places.front().point.data(), core::kPlaceSize}; }
  const double* firstPlace() const { return places.front().frame.data(); }

  void add(const FaceEnergy::Corners& points, double share, double weight) {
    for (const Vector3& point : points) {
      corners.push_back(static_cast<std::int32_t>(places.size()));
      places.push_back({core::tangentFrame(point), point});
    }
    over_shares.push_back(1 / share);
    weights.push_back(weight);
  }
  void pad() {
    over_shares.resize(count() + kLanePadding, 1);
    weights.resize(count() + kLanePadding, 1);
  }

  FaceEnergy energy(std::uint32_t f) const { return {1 / over_shares[f], weights[f], shape, cost}; }
  FaceEnergy::Corners at(std::uint32_t f) const {
    return {places[3 * f].point, places[3 * f + 1].point, places[3 * f + 2].point};
  }
  FaceEnergy::Terms terms(std::uint32_t f, FaceHessian hessian) const {
    const FaceEnergy::Frames frames = {places[3 * f].frame, places[3 * f + 1].frame,
                                       places[3 * f + 2].frame};
    return energy(f).terms(at(f), frames, hessian);
  }
};

/// Corners of a triangle that is about `size` large and as high as `height` of its first side.
FaceEnergy::Corners triangleOf(double size, double height, double along, Random& random) {
  const Vector3 a = random.unitVector();
  const core::TangentFrame frame = core::tangentFrame(a);
  const Vector3 b = (a + size * frame.col(0)).normalized();
  const Vector3 c = (a + along * size * frame.col(0) + height * size * frame.col(1)).normalized();
  return {a, b, c};
}

/// Corners of a triangle that has half of the sphere but for what is above `depth`.
FaceEnergy::Corners wideTriangle(double depth, Random& random) {
  const Vector3 axis = random.unitVector();
  const core::TangentFrame frame = core::tangentFrame(axis);
  FaceEnergy::Corners corners;
  for (int k = 0; k < 3; ++k) {
    const double angle = (k + random.between(0, 0.2)) * 2 * core::kPi / 3;
    corners[k] = depth * axis + frame * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    corners[k].normalize();
  }
  return corners;
}

/// Tiny faces to such as have nearly half of the sphere; needles, blunt ones, folded ones where the
/// cost allows; with shares that differ from their areas by up to 50 times.
Bench mixedBench(std::uint32_t count, double shape, AreaCost cost) {
  Random random(3);
  Bench bench;
  bench.shape = shape;
  bench.cost = cost;
  for (std::uint32_t f = 0; f < count; ++f) {
    const double size = std::exp(random.between(-14, 1));
    const bool thin = f % 7 == 0, folded = cost == AreaCost::square && f % 3 == 0;
    const double height = std::exp(thin ? random.between(-14, -7) : random.between(-7, 0.5));
    const double along = thin ? height * random.between(-1, 1) : random.between(-2, 3);
    const auto points = f % 20 == 0 ? wideTriangle(random.between(0.01, 1), random)
                                    : triangleOf(size, folded ? -height : height, along, random);
    const double area = std::abs(core::solidAngle(points[0], points[1], points[2]));
    bench.add(points, area * std::exp(random.between(-4, 4)), random.between(0.1, 2));
  }
  bench.pad();
  return bench;
}

std::vector<Bench> benches() {
  std::vector<Bench> result;
  for (const double shape : {0., 1e-4, 0.3}) {
    for (const AreaCost cost : {AreaCost::barrier, AreaCost::square}) {
      result.push_back(mixedBench(1003, shape, cost));
    }
  }
  return result;
}

struct Rest {
  explicit Rest(const Bench& bench) : faces(bench.count()), list{faces.data(), 0} {}
  bool has(std::uint32_t f) const {
    return std::find(faces.begin(), faces.begin() + list.count, f) != faces.begin() + list.count;
  }

  std::vector<std::uint32_t> faces;
  LeftOut list;
};

Matrix6 hessianOf(const FaceTerms& terms) {
  Matrix6 result;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const Eigen::Map<const Eigen::Matrix2d> own(terms.diagonal[i]), pair(terms.coupling[i]);
    result.block<2, 2>(2 * i, 2 * i) = own;
    result.block<2, 2>(2 * i, 2 * j) = pair;
    result.block<2, 2>(2 * j, 2 * i) = pair.transpose();
  }
  return result;
}

TEST(FaceKernels, SumTheEnergiesAndAreasOfFaces) {
  for (const FaceKernels& kernels : kernelsHere()) {
    for (const Bench& bench : benches()) {
      Rest rest(bench), rest_of_areas(bench);
      const FaceSums sums = kernels.sums(bench.lists(), bench.rows(), 3, bench.count(), rest.list);
      std::vector<double> areas(bench.count(), 0);
      kernels.areas(bench.lists(), bench.rows(), 3, bench.count(), areas.data(),
                    rest_of_areas.list);
      EXPECT_EQ(rest.list.count, rest_of_areas.list.count);
      EXPECT_GT(rest.list.count, 5u);
      EXPECT_LT(rest.list.count, bench.count() / 5);
      double energy = 0, area = 0, size = 0;
      for (std::uint32_t f = 3; f < bench.count(); ++f) {
        if (rest.has(f)) continue;
        const auto [a, b, c] = bench.at(f);
        const double expected = core::solidAngle(a, b, c);
        EXPECT_NEAR(areas[f], expected, 1e-11 * std::abs(expected));
        const double value = bench.energy(f).value(bench.at(f));
        energy += value;
        size += std::abs(value);
        area += expected;
      }
      EXPECT_NEAR(sums.energy, energy, 1e-11 * size);
      EXPECT_NEAR(sums.area, area, 1e-11);
    }
  }
}

TEST(FaceKernels, HaveTheDerivativesOfFaces) {
  for (const FaceKernels& kernels : kernelsHere()) {
    for (const Bench& bench : benches()) {
      for (const auto hessian :
           {FaceHessian::exact, FaceHessian::gauss_newton, FaceHessian::definite}) {
        Rest rest(bench);
        std::vector<FaceTerms> terms(bench.count());
        const double energy = kernels.terms(bench.lists(), bench.firstPlace(), 0, bench.count(),
                                            hessian, terms.data(), rest.list);
        double expected_energy = 0;
        for (std::uint32_t f = 0; f < bench.count(); ++f) {
          if (rest.has(f)) continue;
          const FaceEnergy::Terms expected = bench.terms(f, hessian);
          expected_energy += expected.value;
          const Eigen::Map<const Eigen::Matrix<double, 6, 1>> gradient(terms[f].gradient[0]);
          EXPECT_LT((gradient - expected.gradient).norm(), 1e-10 * expected.gradient.norm());
          const Matrix6 matrix = hessianOf(terms[f]);
          const double size = expected.hessian.norm();
          EXPECT_LT((matrix - expected.hessian).norm(), 1e-10 * size);
          if (hessian != FaceHessian::definite) continue;
          const Eigen::SelfAdjointEigenSolver<Matrix6> solver(matrix, Eigen::EigenvaluesOnly);
          EXPECT_GT(solver.eigenvalues()[0], -1e-12 * size);
        }
        EXPECT_NEAR(energy, expected_energy, 1e-10 * std::abs(expected_energy));
      }
    }
  }
}

/// Rings of several lengths; the negative one is on the far side, so that faces are large.
TEST(FaceKernels, HaveThePartOfAVertexInTheFacesRoundIt) {
  for (const FaceKernels& kernels : kernelsHere()) {
    for (const int size_of_ring : {3, 4, 5, 6, 8, 9, 17, -3}) {
      const int length = std::abs(size_of_ring);
      const bool small = size_of_ring > 0;
      Random random(static_cast<unsigned>(length));
      const double size = small ? 0.1 : 2, height = small ? 1 : -0.8;
      const Vector3 centre = random.unitVector();
      const core::TangentFrame frame = core::tangentFrame(centre);
      Bench bench;
      bench.shape = 0.2;
      std::vector<Vector3> ring;
      for (int k = 0; k < length; ++k) {
        const double angle = (k + random.between(0, 0.5)) * 2 * core::kPi / length;
        const Eigen::Vector2d offset(std::cos(angle), std::sin(angle));
        ring.push_back(
            (height * centre + size * random.between(0.5, 1) * frame * offset).normalized());
      }
      for (int k = 0; k < length; ++k) {
        bench.add({centre, ring[k], ring[(k + 1) % length]}, 0.005 * random.between(0.3, 2), 0.5);
      }
      bench.pad();
      std::vector<std::int32_t> next, last;
      RingTerms expected = {};
      for (int k = 0; k < length; ++k) {
        next.push_back(3 * k + 1);
        last.push_back(3 * k + 2);
        const auto of_face = bench.terms(k, FaceHessian::exact);
        expected.value += bench.energy(k).value(bench.at(k));
        for (int i = 0; i < 2; ++i) expected.gradient[i] += of_face.gradient[i];
        expected.hessian[0] += of_face.hessian(0, 0);
        expected.hessian[1] += of_face.hessian(0, 1);
        expected.hessian[2] += of_face.hessian(1, 1);
      }
      const RingLists lists = {next.data(),          last.data(), bench.over_shares.data(),
                               bench.weights.data(), bench.shape, AreaCost::barrier};
      RingTerms terms;
      double value = 0;
      const std::uint32_t end = length;
      EXPECT_EQ(small,
                kernels.ring_terms(lists, bench.firstPlace(), 0, end, bench.firstPlace(), terms));
      EXPECT_EQ(small, kernels.ring_value(lists, bench.rows(), 0, end, centre.data(), value));
      if (!small) continue;
      EXPECT_NEAR(terms.value, expected.value, 1e-11 * expected.value);
      EXPECT_NEAR(value, expected.value, 1e-11 * expected.value);
      const double steepest = std::abs(expected.hessian[0]) + std::abs(expected.hessian[2]);
      for (int i = 0; i < 2; ++i) {
        EXPECT_NEAR(terms.gradient[i], expected.gradient[i], 1e-10 * steepest);
      }
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(terms.hessian[i], expected.hessian[i], 1e-10 * steepest);
      }
      const Vector3 outside = (centre + 2 * size * frame.col(0)).normalized();
      EXPECT_TRUE(kernels.ring_value(lists, bench.rows(), 0, end, outside.data(), value));
      EXPECT_EQ(value, std::numeric_limits<double>::infinity());
    }
  }
}

/// The sign in long double numbers, whose rounding is 2,000 times smaller.
bool isPositive(const FaceEnergy::Corners& corners) {
  using Exact = Eigen::Matrix<long double, 3, 1>;
  const Exact a = corners[0].cast<long double>(), b = corners[1].cast<long double>(),
              c = corners[2].cast<long double>();
  return a.dot((b - a).cross(c - a)) > 0;
}

TEST(FaceKernels, TakeNoFoldedFaceForAPositiveOne) {
  for (const FaceKernels& kernels : kernelsHere()) {
    Random random(11);
    int finite = 0, folded = 0;
    for (int i = 0; i < 4000; ++i) {
      const double size = std::exp(random.between(-10, -1));
      const double height = random.between(-1, 1) * std::exp(random.between(-37, -30));
      Bench bench;
      bench.add(triangleOf(size, height, random.between(-2, 3), random), size * size, 1);
      bench.pad();
      Rest rest(bench);
      const FaceSums sums = kernels.sums(bench.lists(), bench.rows(), 0, 1, rest.list);
      ASSERT_EQ(rest.list.count, 0u);
      const bool positive = isPositive(bench.at(0));
      folded += positive ? 0 : 1;
      if (sums.energy == std::numeric_limits<double>::infinity()) continue;
      ++finite;
      EXPECT_TRUE(positive);
    }
    EXPECT_GT(finite, 200);
    EXPECT_GT(folded, 1000);
  }
}

}  // namespace
}  // namespace spherical_springs::mesh
