// An example of use for each public header. The documentation of the headers shows the parts
// between the marks.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <sstream>

#include "spherical_springs/covariance.h"
#include "spherical_springs/integrator.h"
#include "spherical_springs/maps/distortion.h"
#include "spherical_springs/maps/map_scene.h"
#include "spherical_springs/maps/mesh_map.h"
#include "spherical_springs/measures.h"
#include "spherical_springs/relaxation.h"
#include "spherical_springs/scene_file.h"
#include "spherical_springs/simulation.h"

namespace spherical_springs {
namespace {

using namespace core;

TEST(Example, OfTheSphere) {
  //! [sphere]
  const Vector3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const double quarter = arc(x, y).angle;          // pi / 2
  const double octant = solidAngle(x, y, z);       // pi / 2, counter-clockwise from outside
  const Vector3 turned = rotated(x, quarter * z);  // y
  //! [sphere]
  EXPECT_DOUBLE_EQ(quarter, kPi / 2);
  EXPECT_DOUBLE_EQ(octant, kPi / 2);
  EXPECT_LT((turned - y).norm(), 1e-15);
}

TEST(Example, OfAnAngleSpring) {
  //! [angle]
  AngleSpring spring;
  spring.particles = {0, 1};
  spring.rest_angle = 1;
  spring.stiffness = 2;
  const Condition<2> c = condition(spring, {Vector3(1, 0, 0), Vector3(0, 1, 0)});
  const double energy = 0.5 * spring.stiffness * c.value * c.value;
  const Vector3 torque_on_first = -spring.stiffness * c.value * c.gradient[0];
  //! [angle]
  EXPECT_DOUBLE_EQ(energy, std::pow(kPi / 2 - 1, 2));
  EXPECT_LT((torque_on_first - Vector3(0, 0, 2 * (kPi / 2 - 1))).norm(), 1e-15);
}

TEST(Example, OfASolidAngleSpring) {
  //! [solid_angle]
  SolidAngleSpring spring;
  spring.particles = {0, 1, 2};
  spring.stiffness = 1;
  rest(spring, {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1)});  // an octant is at rest
  //! [solid_angle]
  EXPECT_DOUBLE_EQ(spring.rest_solid_angle, kPi / 2);
}

TEST(Example, OfAnOrientedAngleSpring) {
  //! [oriented_angle]
  OrientedAngleSpring spring;
  spring.particles = {0, 1, 2};  // from 0 to 1, counter-clockwise seen from the side of 2
  spring.rest_angle = -0.5;      // at rest half a radian the other way round
  spring.stiffness = 1;
  //! [oriented_angle]
  const auto c = condition(spring, {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1)});
  EXPECT_DOUBLE_EQ(c.value, kPi / 2 + 0.5);
}

TEST(Example, OfTheKinds) {
  SpringLists springs;
  springs.get<AngleSpring>().resize(2);
  springs.get<SolidAngleSpring>().resize(3);
  //! [kinds]
  std::size_t count = 0;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    count += springs.get<Spring>().size();
  });
  //! [kinds]
  EXPECT_EQ(count, 5u);
}

/// Two particles a right angle apart that a spring of 1 rad joins.
Scene pair() {
  //! [scene]
  Particle first, second;
  first.position = Vector3(2, 0, 0);  // the scene makes it a unit vector
  second.position = Vector3(0, 1, 0);
  AngleSpring spring;
  spring.rest_angle = 1;
  spring.stiffness = 1;

  Scene scene;
  const auto ids = scene.addParticles({first, second});
  spring.particles = {ids[0], ids[1]};
  Points positions(3, 2);
  positions << Vector3(1, 0, 0), Vector3(0, 1, 0);  // for springs whose `at_rest` is set
  SpringLists springs;
  springs.get<AngleSpring>() = {spring};
  scene.addSprings(springs, positions);
  //! [scene]
  return scene;
}

/// The scene's particles, at rest.
State stateOf(const Scene& scene) {
  //! [state]
  const auto& particles = scene.particles().items();
  State state;
  state.positions.resize(3, particles.size());
  state.angular_velocities = Points::Zero(3, particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    state.positions.col(i) = particles[i].position;
  }
  //! [state]
  return state;
}

TEST(Example, OfAScene) {
  EXPECT_EQ(pair().springCount(), 1u);
  //! [scene_refuses]
  Scene scene;
  Particle heavy;
  heavy.position = Vector3(1, 0, 0);
  heavy.mass = -1;
  try {
    scene.addParticles({heavy});
  } catch (const std::invalid_argument& refusal) {
    std::cerr << refusal.what() << "\n";  // names item, field, value and what is allowed
  }
  //! [scene_refuses]
  EXPECT_EQ(scene.particles().size(), 0u);
}

TEST(Example, OfASceneFile) {
  std::stringstream file;
  //! [scene_file]
  writeScene(file, pair(), 1.5);
  const SceneFile read = readScene(file, SceneLimits());
  //! [scene_file]
  EXPECT_EQ(read.time, 1.5);
  EXPECT_EQ(read.scene.particles().size(), 2u);
}

TEST(Example, OfASystem) {
  const Scene scene = pair();
  const Points positions = stateOf(scene).positions;
  //! [system]
  System::Options options;
  options.threads = 2;
  const System system(scene, options);
  System::Workspace workspace;
  system.evaluate(positions, workspace);
  const Vector3 torque = workspace.torques.col(0);            // [N m]
  const double energy = system.potential(positions).total();  // [J]
  //! [system]
  EXPECT_DOUBLE_EQ(torque.norm(), kPi / 2 - 1);
  EXPECT_DOUBLE_EQ(energy, 0.5 * std::pow(kPi / 2 - 1, 2));
}

TEST(Example, OfAnIntegrator) {
  const Scene scene = pair();
  State state = stateOf(scene);
  //! [integrator]
  const auto plan = std::make_shared<const Plan>(scene, System::Options());
  const auto integrator = makeIntegrator(plan, IntegrationMethod::fourth_order, 0.01);
  integrator->take(state);
  integrator->advance(1000);
  integrator->give(state);
  //! [integrator]
  EXPECT_EQ(state.steps, 1000u);
  EXPECT_NEAR(state.time, 10, 1e-12);
}

TEST(Example, OfMeasures) {
  const Scene scene = pair();
  State state = stateOf(scene);
  const auto plan = std::make_shared<const Plan>(scene, System::Options());
  //! [measures]
  Account account(*plan, state);
  const auto integrator = makeIntegrator(plan, IntegrationMethod::verlet, 0.01);
  for (int i = 0; i < 100; ++i) integrator->step(state);
  const Measures measures = measure(plan, IntegrationMethod::verlet, 0.01, state, account);
  if (!measures.warning.empty()) std::cerr << measures.warning << "\n";
  //! [measures]
  EXPECT_LT(measures.energy_error, 1e-4);
  EXPECT_EQ(measures.warning, "");
}

TEST(Example, OfASimulation) {
  //! [simulation]
  Simulation::Settings settings;
  settings.time_step = 0.01;
  Simulation simulation(settings);
  Particle first, second;
  first.position = Vector3(1, 0, 0);
  second.position = Vector3(0, 1, 0);
  simulation.addParticles({first, second});
  simulation.step(100);
  const Points& positions = simulation.state().positions;
  //! [simulation]
  EXPECT_EQ(positions.col(1), Vector3(0, 1, 0));
}

TEST(Example, OfAnAccuracy) {
  //! [accuracy]
  Simulation::Settings settings;
  settings.accuracy = 1e-6;        // [rad/s]
  settings.chooses_method = true;  // verlet or fourth_order
  Simulation simulation(settings);
  simulation.load({pair(), 0});
  const double time_step = simulation.choice().time_step;  // [s]
  while (simulation.state().time < 10) simulation.step();
  //! [accuracy]
  EXPECT_GT(time_step, 0.01);
  EXPECT_TRUE(simulation.choice().is_reached);
}

TEST(Example, OfARelaxation) {
  const Scene scene = pair();
  const Points start = stateOf(scene).positions;
  //! [relaxation]
  RelaxationOptions options;
  options.max_time = 5;  // [s]
  options.go_on = [](const RelaxationProgress& progress) { return progress.best.max_torque > 0; };
  const RelaxationResult result = relax(System(scene, System::Options()), start, options);
  if (!result.converged) std::cerr << result.message << "\n";
  //! [relaxation]
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(arc(result.positions.col(0), result.positions.col(1)).angle, 1, 1e-8);
}

TEST(Example, OfTheCovariance) {
  const Scene scene = pair();
  const System system(scene, System::Options());
  const Points start = stateOf(scene).positions;
  //! [covariance]
  RelaxationOptions options;
  options.method = RelaxationMethod::global;
  options.starts = 5;
  const RelaxationResult result = relax(system, start, options);
  const std::vector<Matrix3> covariance = covariances(system, result.positions, {0, 1});
  const double sigma = std::sqrt(covariance[0].trace());  // if it is along one direction
  //! [covariance]
  EXPECT_NEAR(sigma, 0.5, 1e-6);
}

TEST(Example, OfStrains) {
  const Scene scene = pair();
  const System system(scene, System::Options());
  const Points positions = stateOf(scene).positions;
  //! [strains]
  const Strains of_all = strains(system, positions);
  const auto& [conditions, energies] = of_all.get<AngleSpring>();
  //! [strains]
  EXPECT_DOUBLE_EQ(conditions.at(0), kPi / 2 - 1);
  EXPECT_DOUBLE_EQ(energies.at(0), 0.5 * conditions[0] * conditions[0]);
}

TEST(Example, OfAMap) {
  mesh::TriangleMesh octahedron;
  octahedron.vertices.resize(3, 6);
  octahedron.vertices << 2, -2, 0, 0, 0, 0, 0, 0, 1, -1, 0, 0, 0, 0, 0, 0, 1, -1;
  octahedron.faces.resize(3, 8);
  octahedron.faces << 0, 2, 1, 3, 2, 1, 3, 0, 2, 1, 3, 0, 0, 2, 1, 3, 4, 4, 4, 4, 5, 5, 5, 5;
  //! [map]
  const auto shares = mesh::faceShares(mesh::faceAreas(octahedron));
  mesh::MapOptions options;
  options.tolerance = 0.01;
  const Points map = mesh::sphereMap(octahedron, shares, options);
  const mesh::Distortion distortion = mesh::summary(mesh::faceDistortion(octahedron, shares, map));
  //! [map]
  EXPECT_EQ(distortion.folded, 0);
  EXPECT_LE(distortion.spread, 0.01);
  //! [map_scene]
  options.go_on = [](const mesh::MapProgress& progress) { return progress.spread > 0.02; };
  const mesh::MeshMap again = mesh::meshMap(octahedron, shares, map, options);
  const Scene scene = mesh::sceneOfMap(octahedron.faces, shares, again.points, 0, SceneLimits());
  //! [map_scene]
  EXPECT_TRUE(mesh::coversOnce(again.distortion));
  EXPECT_EQ(scene.particles().size(), 6u);
}

}  // namespace
}  // namespace spherical_springs
