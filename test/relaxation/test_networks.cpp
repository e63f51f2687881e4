// Networks of every sort, each relaxed to a minimum by the eigenvalues of its whole Hessian.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

#include "relaxation/torque_limit.h"
#include "spherical_springs/relaxation.h"
#include "support/relaxation_scenes.h"

namespace spherical_springs::core {
namespace {

using testing::angleSpring;
using testing::Random;

struct Network {
  std::string name;
  Scene scene;
};

void PrintTo(const Network& network, std::ostream* out) { *out << network.name; }

std::vector<Particle> randomParticles(unsigned seed, std::uint32_t count) {
  Random random(seed);
  std::vector<Particle> particles;
  for (std::uint32_t i = 0; i < count; ++i) {
    particles.push_back(testing::particleAt(random.unitVector()));
  }
  return particles;
}

/// Arcs between `count` particles at random places, where `joined(i, j)`; `restAngle(random)`.
template <class Joined, class RestAngle>
Scene arcScene(std::uint32_t count, const Joined& joined, const RestAngle& restAngle) {
  Random random(7);
  SpringLists springs;
  for (std::uint32_t j = 0; j < count; ++j) {
    for (std::uint32_t i = 0; i < j; ++i) {
      if (joined(i, j)) {
        springs.get<AngleSpring>().push_back(angleSpring(i, j, restAngle(random)));
      }
    }
  }
  return testing::sceneOf(randomParticles(1, count), springs);
}

double ordinary(Random& random) { return random.between(0.1, 2); }

bool inChain(std::uint32_t i, std::uint32_t j) { return j == i + 1; }

bool inGrid(std::uint32_t i, std::uint32_t j) {
  constexpr std::uint32_t kWidth = 12;
  return j == i + kWidth || (j == i + 1 && j % kWidth != 0);
}

Scene randomGraph() {
  Random random(2);
  return arcScene(
      80, [&](std::uint32_t, std::uint32_t) { return random.between(0, 1) < 0.06; }, ordinary);
}

/// The springs of a membrane as `change` leaves them.
template <class Change>
Scene changedMembrane(const Change& change) {
  const Scene scene = testing::membraneScene(2);
  SpringLists springs = testing::springsOf(scene);
  change(springs);
  return testing::sceneOf(scene.particles().items(), springs);
}

/// Oriented angles on two sides of each triangle; every tenth one begins inverted.
Scene orientedMesh() {
  Scene mesh = testing::membraneScene(2);
  auto particles = mesh.particles().items();
  SpringLists springs;
  std::vector<bool> moved(particles.size(), false);
  int number = 0;
  for (const SolidAngleSpring& face : mesh.springs<SolidAngleSpring>().items()) {
    const auto& [a, b, c] = face.particles;
    const Vector3 places[] = {particles[a].position, particles[b].position, particles[c].position};
    for (int i = 0; i < 2; ++i) {
      OrientedAngleSpring spring;
      spring.particles = {face.particles[i], face.particles[i + 1], face.particles[(i + 2) % 3]};
      spring.rest_angle = arc(places[i], places[i + 1]).angle;
      spring.stiffness = 1;
      springs.get<OrientedAngleSpring>().push_back(spring);
    }
    if (++number % 10 == 0 && !moved[a] && !moved[b]) {
      std::swap(particles[a].position, particles[b].position);
      moved[a] = moved[b] = true;
    }
  }
  return testing::sceneOf(particles, springs);
}

std::vector<Network> networks() {
  const auto rest = [](double angle) { return [angle](Random&) { return angle; }; };
  const auto all = [](std::uint32_t, std::uint32_t) { return true; };
  const auto apart = [](std::uint32_t i, std::uint32_t j) { return j == i + 1 && j % 7 != 0; };
  std::vector<std::uint32_t> most_pinned;
  for (std::uint32_t i = 0; i < 162; ++i) {
    if (i % 10 != 3) most_pinned.push_back(i);
  }
  return {
      {"random_graph", randomGraph()},
      {"chain", arcScene(100, inChain, ordinary)},
      {"star", arcScene(
                   100, [](std::uint32_t i, std::uint32_t) { return i == 0; }, ordinary)},
      {"grid", arcScene(144, inGrid, [](Random& r) { return r.between(0.1, 0.3); })},
      {"complete_graph", arcScene(40, all, rest(kPi))},
      {"rest_angle_0", arcScene(100, inGrid, rest(0))},
      {"rest_angle_pi", arcScene(100, inChain, rest(kPi))},
      {"rest_angles_0_and_pi",
       arcScene(60, inGrid, [](Random& r) { return r.below(2) == 0 ? 0 : kPi; })},
      {"components", arcScene(100, apart, ordinary)},
      {"membrane", testing::membraneScene(2)},
      {"a_few_pins", testing::pinnedScene(testing::membraneScene(2), {0, 5, 77})},
      {"most_pinned", testing::pinnedScene(testing::membraneScene(2), most_pinned)},
      {"triangles_alone",
       changedMembrane([](SpringLists& springs) { springs.get<AngleSpring>().clear(); })},
      {"half_of_the_arcs", changedMembrane([](SpringLists& springs) {
         Random random(4);
         auto& arcs = springs.get<AngleSpring>();
         arcs.erase(std::remove_if(arcs.begin(), arcs.end(),
                                   [&](const AngleSpring&) { return random.below(2) == 0; }),
                    arcs.end());
         springs.get<SolidAngleSpring>().clear();
       })},
      {"six_decades_of_stiffness", changedMembrane([](SpringLists& springs) {
         Random random(5);
         for (auto& spring : springs.get<AngleSpring>()) {
           spring.stiffness = std::pow(10, random.between(-3, 3));
         }
       })},
      {"stiff_triangles", changedMembrane([](SpringLists& springs) {
         for (auto& spring : springs.get<SolidAngleSpring>()) spring.stiffness = 1e5;
       })},
      {"oriented_with_inverted_triangles", orientedMesh()},
  };
}

class Networks : public ::testing::TestWithParam<Network> {};
INSTANTIATE_TEST_SUITE_P(OfEverySort, Networks, ::testing::ValuesIn(networks()),
                         [](const auto& info) { return info.param.name; });

TEST_P(Networks, EndAtMinima) {
  const System system(GetParam().scene, {});
  const Points start = testing::positionsOf(GetParam().scene);
  const auto result = relax(system, start, {});
  EXPECT_TRUE(result.converged) << result.message;
  EXPECT_LT(result.energy_after, result.energy_before);
  EXPECT_LE(result.max_torque, 1e-9 * feltStiffness(system, result.positions).maxCoeff());
  EXPECT_NEAR(result.energy_after, system.potential(result.positions).total(),
              1e-12 * result.energy_before);
  for (Eigen::Index i = 0; i < start.cols(); ++i) {
    EXPECT_TRUE(!system.pinned(i) || result.positions.col(i) == start.col(i)) << i;
  }
  const auto energy = testing::energyAt(system, result.positions, Curvature::exact);
  const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
          testing::dense(energy.pattern(), energy.hessian()), Eigen::EigenvaluesOnly)
          .eigenvalues();
  EXPECT_GE(eigenvalues.minCoeff(), -1e-9 * eigenvalues.maxCoeff());
}

// Three angles make no more than a whole turn, which is shared evenly on a great circle.
TEST(CompleteGraph, OfThreeThatWantToBeAntipodal) {
  const auto scene = arcScene(
      3, [](std::uint32_t, std::uint32_t) { return true; }, [](Random&) { return kPi; });
  const auto result = relax(System(scene, {}), testing::positionsOf(scene), {});
  EXPECT_TRUE(result.converged) << result.message;
  EXPECT_NEAR(result.energy_after, 3 * std::pow(kPi / 3, 2) / 2, 1e-12);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(arc(result.positions.col(i), result.positions.col((i + 1) % 3)).angle, 2 * kPi / 3,
                1e-8);
  }
}

}  // namespace
}  // namespace spherical_springs::core
