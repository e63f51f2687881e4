#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "relaxation/spring_sweeps.h"
#include "spherical_springs/relaxation.h"
#include "support/rigs.h"

namespace spherical_springs::core {
namespace {

using testing::mirrorImage;
using testing::misfit;
using testing::Rig;
using testing::rigOf;

constexpr double kDegree = kPi / 180;
constexpr double kNear = 0.05;  // [rad] of the truth, beside some of another arrangement

RelaxationOptions globally(std::uint32_t starts) {
  RelaxationOptions options;
  options.method = RelaxationMethod::global;
  options.starts = starts;
  return options;
}

RelaxationResult relaxed(const Scene& scene, const RelaxationOptions& options, int threads = 1) {
  return relax(System(scene, {SpringDamping::relative, threads}), testing::positionsOf(scene),
               options);
}

struct Sort {
  std::uint32_t directions;
  double sigma;
  unsigned rigs;
};

const std::vector<Sort> kSorts = {{6, 0.2 * kDegree, 30},
                                  {10, 0.5 * kDegree, 30},
                                  {20, 0.5 * kDegree, 10},
                                  {60, 0.5 * kDegree, 2}};

TEST(GlobalSearch, FindsRigsUpToTheirMirrorImage) {
  for (const auto& [directions, sigma, rigs] : kSorts) {
    for (unsigned seed = 0; seed < rigs; ++seed) {
      const Rig rig = rigOf(directions, sigma, seed);
      const auto result = relaxed(rig.scene(), globally(4));
      EXPECT_TRUE(result.converged) << result.message;
      EXPECT_LT(std::min(misfit(result.positions, rig.truth),
                         misfit(result.positions, mirrorImage(rig.truth))),
                kNear)
          << directions << " directions, seed " << seed;
      EXPECT_TRUE(result.mirror_ambiguous);
      EXPECT_EQ(result.free_rotations, 1);
    }
  }
}

/// Three directions whose triple product is far from 0, the least pinned one of them last.
std::array<std::uint32_t, 3> openTriple(const Points& points) {
  std::array<std::uint32_t, 3> best{};
  double largest = 0;
  for (std::uint32_t a = 0; a < points.cols(); ++a) {
    for (std::uint32_t b = a + 1; b < points.cols(); ++b) {
      for (std::uint32_t c = b + 1; c < points.cols(); ++c) {
        const double size = std::abs(tripleProduct(points.col(a), points.col(b), points.col(c)));
        if (size <= largest) continue;
        largest = size;
        best = {a, b, c};
      }
    }
  }
  return best;
}

void addOriented(Rig& rig) {
  OrientedAngleSpring spring;
  spring.particles = openTriple(rig.truth);
  const auto& [a, b, c] = spring.particles;
  rest(spring, {rig.truth.col(a), rig.truth.col(b), rig.truth.col(c)});
  spring.stiffness = rig.springs.get<AngleSpring>().front().stiffness;
  rig.springs.get<OrientedAngleSpring>().push_back(spring);
}

void addTriangle(Rig& rig) {
  const auto [a, b, c] = openTriple(rig.truth);
  rig.springs.get<SolidAngleSpring>().push_back(testing::solidAngleSpring(
      a, b, c, solidAngle(rig.truth.col(a), rig.truth.col(b), rig.truth.col(c))));
}

void addPins(Rig& rig) {
  for (const std::uint32_t i : openTriple(rig.truth)) {
    rig.particles[i].position = rig.truth.col(i);
    rig.particles[i].pinned = true;
  }
}

TEST(GlobalSearch, FindsTheRightOneOfTwoMirrorImages) {
  for (const auto& tell : {addOriented, addTriangle, addPins}) {
    for (const auto& [directions, sigma, rigs] : kSorts) {
      for (unsigned seed = 0; seed < rigs; ++seed) {
        Rig rig = rigOf(directions, sigma, seed);
        tell(rig);
        const auto result = relaxed(rig.scene(), globally(4));
        EXPECT_TRUE(result.converged) << result.message;
        EXPECT_LT(misfit(result.positions, rig.truth), kNear)
            << directions << " directions, seed " << seed;
        EXPECT_FALSE(result.mirror_ambiguous);
      }
    }
  }
}

// One start is enough where the mirror image alone is in the way.
TEST(GlobalSearch, MirrorsWhatNewtonsMethodFinds) {
  Rig rig = rigOf(8, 0.2 * kDegree, 3);
  addOriented(rig);
  for (std::size_t i = 1; i < rig.particles.size(); ++i) {
    const Vector3 pin = rig.truth.col(0), normal = perpendicular(pin);
    rig.particles[i].position =
        Vector3(rig.truth.col(i)) - 2 * normal.dot(rig.truth.col(i)) * normal;
  }
  const auto newton = relaxed(rig.scene(), {});
  EXPECT_GT(misfit(newton.positions, rig.truth), 0.5);
  EXPECT_LT(misfit(relaxed(rig.scene(), globally(1)).positions, rig.truth), kNear);
}

/// Springs between all pairs of the vertices of a tree, at rest at the lengths of their paths.
Scene treeScene(std::uint32_t count, unsigned seed) {
  testing::Random random(seed);
  std::vector<std::vector<double>> paths(count, std::vector<double>(count, 0));
  double longest = 0;
  for (std::uint32_t j = 1; j < count; ++j) {
    const std::uint32_t parent = random.below(j);
    for (std::uint32_t i = 0; i < j; ++i) {
      paths[i][j] = paths[j][i] = paths[i][parent] + 1;
      longest = std::max(longest, paths[i][j]);
    }
  }
  std::vector<Particle> particles;
  SpringLists springs;
  for (std::uint32_t j = 0; j < count; ++j) {
    particles.push_back(testing::particleAt(random.unitVector()));
    for (std::uint32_t i = 0; i < j; ++i) {
      springs.get<AngleSpring>().push_back(testing::angleSpring(i, j, kPi * paths[i][j] / longest));
    }
  }
  return testing::sceneOf(particles, springs);
}

TEST(GlobalSearch, IsNeverAboveNewtonsMethodAndOftenBelow) {
  int below = 0;
  for (unsigned seed = 0; seed < 8; ++seed) {
    const Scene scene = treeScene(30, seed);
    const double newton = relaxed(scene, {}).energy_after;
    const auto result = relaxed(scene, globally(2));
    EXPECT_TRUE(result.converged) << result.message;
    EXPECT_LE(result.energy_after, newton * (1 + 1e-12));
    below += result.energy_after < 0.999 * newton;
  }
  EXPECT_GE(below, 3);
}

TEST(GlobalSearch, DoesNotDependOnThreads) {
  const Scene scene = treeScene(100, 1);
  const auto one = relaxed(scene, globally(2), 1);
  const auto three = relaxed(scene, globally(2), 3);
  EXPECT_EQ(one.positions, three.positions);
  EXPECT_EQ(one.message, three.message);
}

TEST(GlobalSearch, DependsOnTheSeed) {
  const Scene scene = treeScene(60, 2);
  RelaxationOptions options = globally(1);
  const auto first = relaxed(scene, options);
  EXPECT_EQ(first.positions, relaxed(scene, options).positions);
  bool differs = false;
  for (options.seed = 1; options.seed < 6 && !differs; ++options.seed) {
    differs = relaxed(scene, options).positions != first.positions;
  }
  EXPECT_TRUE(differs);
}

// The lowest minimum stays where it is, to the last bit.
TEST(GlobalSearch, KeepsWhatIsRelaxed) {
  const Rig rig = rigOf(12, 0.5 * kDegree, 5);
  Rig found = rig;
  const auto first = relaxed(rig.scene(), globally(4));
  for (std::size_t i = 0; i < found.particles.size(); ++i) {
    found.particles[i].position = first.positions.col(i);
  }
  EXPECT_EQ(relaxed(found.scene(), globally(4)).positions, first.positions);
}

// Each group of particles takes the lowest of its own minima.
TEST(GlobalSearch, ChoosesForEachGroup) {
  std::vector<Particle> particles;
  SpringLists springs;
  std::vector<Rig> rigs;
  for (unsigned seed = 0; seed < 6; ++seed) {
    Rig rig = rigOf(6, 0.2 * kDegree, 100 + seed);
    addOriented(rig);
    const auto offset = static_cast<std::uint32_t>(particles.size());
    forEachKind([&](auto kind) {
      for (auto spring : rig.springs.get<typename decltype(kind)::type>()) {
        for (std::uint32_t& i : spring.particles) i += offset;
        springs.get<typename decltype(kind)::type>().push_back(spring);
      }
    });
    particles.insert(particles.end(), rig.particles.begin(), rig.particles.end());
    rigs.push_back(rig);
  }
  const auto result = relaxed(testing::sceneOf(particles, springs), globally(3));
  EXPECT_TRUE(result.converged) << result.message;
  for (std::size_t r = 0; r < rigs.size(); ++r) {
    EXPECT_LT(misfit(result.positions.middleCols(6 * r, 6), rigs[r].truth), kNear) << r;
  }
  EXPECT_EQ(result.free_rotations, 6);
}

TEST(GlobalSearch, LeavesPinsAndParticlesWithoutSprings) {
  Rig rig = rigOf(8, 0.2 * kDegree, 1);
  rig.particles.push_back(testing::particleAt({0.6, 0, 0.8}));
  const auto result = relaxed(rig.scene(), globally(3));
  EXPECT_EQ(Vector3(result.positions.col(0)), Vector3(rig.scene().particles().item(0).position));
  EXPECT_EQ(Vector3(result.positions.col(8)), Vector3(rig.scene().particles().item(8).position));
}

TEST(GlobalSearch, ShowsItsWayAndEndsWhenToldTo) {
  const Scene scene = treeScene(30, 3);
  double last = 0, energy = 1e300;
  int calls = 0;
  RelaxationOptions options = globally(3);
  options.go_on = [&](const RelaxationProgress& progress) {
    EXPECT_GE(progress.fraction, last);
    EXPECT_LE(progress.fraction, 1);
    EXPECT_LE(progress.best.energy_after, energy * (1 + 1e-12));
    last = progress.fraction;
    energy = progress.best.energy_after;
    return ++calls < 100;
  };
  const auto result = relaxed(scene, options);
  EXPECT_EQ(calls, 100);
  EXPECT_NE(result.message.find("cancelled after "), std::string::npos) << result.message;
  EXPECT_GT(last, 0.2);
}

TEST(GlobalSearch, EndsWithItsTime) {
  RelaxationOptions options = globally(1'000'000);
  options.max_time = 0.2;
  const auto result = relaxed(treeScene(30, 3), options);
  EXPECT_NE(result.message.find("max_time is over after "), std::string::npos) << result.message;
  EXPECT_TRUE(result.converged);
}

TEST(GlobalSearch, RefusesWhatItCannotDo) {
  const Scene scene = treeScene(3, 1);
  RelaxationOptions options = globally(0);
  EXPECT_THROW(relaxed(scene, options), std::invalid_argument);
  options.starts = 1;
  options.keep_orientation = true;
  EXPECT_THROW(relaxed(scene, options), std::invalid_argument);
}

TEST(GlobalSearch, BearsScenesWithNothingToDo) {
  EXPECT_TRUE(relaxed(Scene(), globally(2)).converged);
  EXPECT_TRUE(
      relaxed(testing::sceneOf({testing::particleAt({1, 0, 0})}, {}), globally(2)).converged);
}

// A share of 1, at first, takes the condition away; the heavier particle moves less.
TEST(SpringSweeps, SatisfyASpringByTheEaseOfItsParticles) {
  std::vector<Particle> particles = {testing::particleAt({1, 0, 0}),
                                     testing::particleAt({0, 1, 0})};
  particles[1].mass = 3;
  SpringLists springs;
  springs.get<AngleSpring>().push_back(testing::angleSpring(0, 1, 1));
  const Scene scene = testing::sceneOf(particles, springs);
  const Points before = testing::positionsOf(scene);
  Points after = before;
  const System system(scene, {});
  SpringSweeps(system, 1).sweep(0, after);
  EXPECT_NEAR(arc(after.col(0), after.col(1)).angle, 1, 1e-14);
  const double light = arc(before.col(0), after.col(0)).angle;
  EXPECT_NEAR(light, 3 * arc(before.col(1), after.col(1)).angle, 1e-14);
  EXPECT_NEAR(light, 0.75 * (kPi / 2 - 1), 1e-14);
}

}  // namespace
}  // namespace spherical_springs::core
