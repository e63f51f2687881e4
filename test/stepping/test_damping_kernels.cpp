// The kernels of damped springs for every instruction set that this processor has against the
// springs' own gradients.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "stepping/damper_layout.h"
#include "support/scenes.h"
#include "support/step_levels.h"

namespace spherical_springs::core {
namespace {

using testing::Random;
using testing::stepKernelsHere;

double widthOf(const AngleSpring&) { return 0; }
double widthOf(const SolidAngleSpring&) { return 0; }
double widthOf(const OrientedAngleSpring& spring) { return spring.width; }

void setWidth(double, ArcDampers&, std::uint32_t) {}
void setWidth(double, TriangleDampers&, std::uint32_t) {}
void setWidth(double width, OrientedArcDampers& group, std::uint32_t lane) {
  group.width[lane] = width;
}

/// Springs of one kind, each on particles of its own, so that sums are those of one spring, or all
/// on a few.
template <class Spring>
struct Bench {
  static constexpr std::uint32_t kCount = 5 * kGroup;
  static constexpr int kEnds = Spring::kParticles;
  using Dampers = DampersOf<Spring>;
  using Ends = std::array<Vector3, kEnds>;

  std::vector<Dampers> groups{kCount / kGroup};
  std::vector<GradientsOf<Dampers>> gradients{kCount / kGroup};
  std::vector<Row> positions = std::vector<Row>(kEnds * kCount, Row{}), velocities = positions;
  std::vector<Spring> springs = std::vector<Spring>(kCount);
  std::vector<std::uint32_t> hard;

  std::uint32_t crowd = kCount;  ///< so many particles are there for the ends of each number

  std::uint32_t row(std::uint32_t s, int end) const {
    return (7 * s + 13 + end) % crowd + end * kCount;
  }
  Dampers& groupOf(std::uint32_t s) { return groups[s / kGroup]; }

  Ends at(const std::vector<Row>& rows, std::uint32_t s) const {
    Ends result;
    for (int i = 0; i < kEnds; ++i) result[i] = Eigen::Map<const Vector3>(rows[row(s, i)].values);
    return result;
  }

  void put(std::uint32_t s, const Ends& points, Random& random) {
    springs[s] = random.spring<Spring>({});
    springs[s].damping = random.between(0.5, 2);
    if constexpr (std::is_same_v<Spring, OrientedAngleSpring>) {
      springs[s].width =
          random.between(0.3, 1) * (points[0] - points[1]).norm() * (points[1] - points[2]).norm();
    }
    const std::uint32_t lane = s % kGroup;
    groupOf(s).root_coefficient[lane] = std::sqrt(springs[s].damping);
    setWidth(widthOf(springs[s]), groupOf(s), lane);
    for (int i = 0; i < kEnds; ++i) {
      groupOf(s).ends[i][lane] = static_cast<std::uint32_t>(kRowLength * row(s, i));
      groupOf(s).root_mobility[i][lane] = random.between(0.5, 2);
      Eigen::Map<Vector3>(positions[row(s, i)].values) = points[i];
      Eigen::Map<Vector3>(velocities[row(s, i)].values) = random.unitVector();
    }
  }

  void fill(double size, unsigned seed) {
    Random random(seed);
    for (std::uint32_t s = 0; s < kCount; ++s) {
      const Vector3 first = random.unitVector();
      auto points = random.unitVectors<kEnds>();
      for (Vector3& p : points) p = (first + size * (p - first)).normalized();
      put(s, points, random);
    }
  }

  void run(const StepKernels& kernels) {
    hard.resize(kCount);
    hard.resize(of(kernels).gradients(groups.data(), kCount / kGroup, positions[0].values,
                                      gradients.data(), hard.data()));
  }
  static const DamperKernels<Dampers>& of(const StepKernels& kernels) {
    return std::get<DamperKernels<Dampers>>(kernels.damping.springs);
  }

  Ends gradientsOf(std::uint32_t s) const {
    Ends result;
    result[kEnds - 1].setZero();
    for (int i = 0; i < kEnds - 1; ++i) {
      for (int k = 0; k < 3; ++k) result[i][k] = gradients[s / kGroup].of[i][k][s % kGroup];
      result[kEnds - 1] -= result[i];
    }
    return result;
  }

  std::vector<DamperFlow> someFlows(unsigned seed) const {
    Random random(seed);
    std::vector<DamperFlow> flows(kEnds * kCount);
    for (DamperFlow& flow : flows) flow = {-random.between(0.1, 0.3), random.between(1, 2)};
    return flows;
  }

  /// Lets one damper act, by its flow or those of its ends. @return the energy.
  double damp(std::uint32_t s, const DamperFlow* flows, bool own) {
    const Ends gradients = gradientsOf(s), before = at(velocities, s);
    double whole = 0, taken = 0;
    for (int i = 0; i < kEnds; ++i) whole += gradients[i].dot(before[i]);
    for (int i = 0; i < kEnds; ++i) {
      const double root = groupOf(s).root_mobility[i][s % kGroup];
      const double rate = own ? gradients[i].dot(before[i]) : whole;
      const DamperFlow& flow = flows[own ? i : 0];
      Eigen::Map<Vector3>(velocities[row(s, i)].values) +=
          flow.impulse * rate * root * root * gradients[i];
      if (own || i == 0) taken += flow.energy * rate * rate;
    }
    return taken;
  }

  bool isHard(std::uint32_t s) const { return std::count(hard.begin(), hard.end(), s) > 0; }

  void expectGradients(double tolerance) const {
    for (std::uint32_t s = 0; s < kCount; ++s) {
      if (isHard(s)) continue;
      auto expected = condition(springs[s], at(positions, s)).gradient;
      for (Vector3& gradient : expected) gradient *= std::sqrt(springs[s].damping);
      const Ends result = gradientsOf(s);
      double largest = 0;
      for (const Vector3& g : expected) largest = std::max(largest, g.norm());
      for (int i = 0; i < kEnds; ++i) {
        EXPECT_LE((result[i] - expected[i]).norm(), tolerance * largest) << s << ", end " << i;
      }
    }
  }
};

template <class Spring>
class DamperKernelsOf : public ::testing::Test {
 protected:
  Bench<Spring> bench_;
};
using Springs = ::testing::Types<AngleSpring, SolidAngleSpring, OrientedAngleSpring>;
TYPED_TEST_SUITE(DamperKernelsOf, Springs);

TYPED_TEST(DamperKernelsOf, GiveTheGradientsAtAnySize) {
  for (const double size : {1., 0.5, 0.1, 1e-2, 1e-3, 1e-4}) {
    SCOPED_TRACE(size);
    for (unsigned seed = 1; seed <= 20; ++seed) {
      this->bench_.fill(size, seed);
      for (const StepKernels* kernels : stepKernelsHere()) {
        this->bench_.run(*kernels);
        this->bench_.expectGradients(1e-13);
        if (size < 0.3) {
          EXPECT_TRUE(this->bench_.hard.empty());
        }
      }
    }
  }
}

TYPED_TEST(DamperKernelsOf, LeaveTheHardOut) {
  constexpr int kEnds = TypeParam::kParticles;
  Random random(4);
  this->bench_.fill(0.2, 3);
  std::array<Vector3, kEnds> points;
  points.fill(Vector3(1, 0, 0));
  points[0] = Vector3(1, 2, 3).normalized();
  points[1] = -points[0];
  this->bench_.put(17, points, random);
  for (const StepKernels* kernels : stepKernelsHere()) {
    this->bench_.run(*kernels);
    this->bench_.expectGradients(1e-13);
    EXPECT_EQ(this->bench_.hard, std::vector<std::uint32_t>{17});
  }
}

TYPED_TEST(DamperKernelsOf, AddTheRatesOfWholeSpringsOrOfTheirEnds) {
  auto& bench = this->bench_;
  bench.fill(0.5, 5);
  for (const bool own : {false, true}) {
    for (const StepKernels* kernels : stepKernelsHere()) {
      bench.run(*kernels);
      std::vector<Row> rates(bench.positions.size(), Row{{1, 2, 3, 0}});
      bench.of(*kernels).add_rates(bench.groups.data(), bench.gradients.data(),
                                   std::uint32_t(bench.groups.size()), own,
                                   bench.velocities[0].values, rates[0].values);
      for (std::uint32_t s = 0; s < bench.kCount; ++s) {
        const auto gradients = bench.gradientsOf(s), velocities = bench.at(bench.velocities, s);
        double whole = 0;
        for (int i = 0; i < bench.kEnds; ++i) whole += gradients[i].dot(velocities[i]);
        for (int i = 0; i < bench.kEnds; ++i) {
          const double rate = own ? gradients[i].dot(velocities[i]) : whole;
          const Vector3 expected = Vector3(1, 2, 3) + rate * gradients[i];
          EXPECT_LT((bench.at(rates, s)[i] - expected).norm(), 1e-13 * (1 + expected.norm()));
        }
      }
    }
  }
}

TYPED_TEST(DamperKernelsOf, AddTheBoundsOfGershgorinsCircles) {
  auto& bench = this->bench_;
  bench.fill(0.5, 6);
  for (const bool own : {false, true}) {
    for (const StepKernels* kernels : stepKernelsHere()) {
      bench.run(*kernels);
      std::vector<Row> bounds(bench.positions.size(), Row{{1, 0, 0, 0}});
      bench.of(*kernels).add_bounds(bench.groups.data(), bench.gradients.data(),
                                    std::uint32_t(bench.groups.size()), own, bounds[0].values);
      for (std::uint32_t s = 0; s < bench.kCount; ++s) {
        const auto gradients = bench.gradientsOf(s);
        double levers[bench.kEnds], sum = 0;
        for (int i = 0; i < bench.kEnds; ++i) {
          levers[i] = gradients[i].norm() * bench.groupOf(s).root_mobility[i][s % kGroup];
          sum += levers[i];
        }
        for (int i = 0; i < bench.kEnds; ++i) {
          const double expected = 1 + levers[i] * (own ? levers[i] : sum);
          EXPECT_NEAR(bench.at(bounds, s)[i].x(), expected, 1e-13 * expected);
        }
      }
    }
  }
}

template <class Spring>
void expectTurns(Bench<Spring> bench, const StepKernels& kernels, bool own, bool backward) {
  constexpr auto kCount = Bench<Spring>::kCount, kActing = kCount - 7, kGroups = kCount / kGroup;
  const auto flows = bench.someFlows(8);
  std::vector<Row> velocities = bench.velocities;
  const auto& kernel = backward ? bench.of(kernels).backward : bench.of(kernels).forward;
  const double taken =
      kernel({bench.groups.data(), bench.gradients.data(), flows.data(), kGroups, kActing}, own,
             velocities[0].values);
  double expected = 0;
  for (std::uint32_t n = 0; n < kCount; ++n) {
    const std::uint32_t s = backward ? kCount - 1 - n : n;
    if (s % kGroup * kGroups + s / kGroup >= kActing) continue;
    expected += bench.damp(s, &flows[own ? s * Spring::kParticles : s], own);
  }
  EXPECT_NEAR(taken, expected, 1e-12 * expected);
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    const Eigen::Map<const Vector3> velocity(velocities[i].values);
    const Eigen::Map<const Vector3> in_turn(bench.velocities[i].values);
    EXPECT_LE((velocity - in_turn).norm(), 1e-12 * (1 + in_turn.norm())) << i;
  }
}

TYPED_TEST(DamperKernelsOf, ActInTurnThereAndBack) {
  auto& bench = this->bench_;
  bench.crowd = 5;  // so that some taken together meet
  bench.fill(0.5, 7);
  for (const StepKernels* kernels : stepKernelsHere()) {
    bench.run(*kernels);
    ASSERT_TRUE(bench.hard.empty());
    for (const bool own : {false, true}) {
      for (const bool backward : {false, true}) expectTurns(bench, *kernels, own, backward);
    }
  }
}

}  // namespace
}  // namespace spherical_springs::core
