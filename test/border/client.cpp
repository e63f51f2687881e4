// A program that uses every public header, compiled for other machines than the library is.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "geometry/tessellation.h"
#include "layouts.h"
#include "maps/topological_sphere.h"
#include "spherical_springs/maps/map_scene.h"
#include "springs/strain.h"

namespace spherical_springs {
namespace {

using namespace core;

const Points kCorners = Eigen::Matrix3d::Identity();  // a right angle between each two

/// Three particles with an arc and a triangle, at rest elsewhere.
Scene sceneAtCorners(double damping = 0) {
  std::vector<Particle> particles(3);
  for (int i = 0; i < 3; ++i) particles[i].position = kCorners.col(i);
  particles[2].damping = damping;
  Scene scene;
  const auto ids = scene.addParticles(particles);
  SpringLists springs;
  AngleSpring arc;
  arc.particles = {ids[0], ids[1]};
  arc.rest_angle = 1;
  arc.stiffness = 2;
  arc.damping = damping;
  springs.get<AngleSpring>().push_back(arc);
  SolidAngleSpring triangle;
  triangle.particles = {ids[0], ids[1], ids[2]};
  triangle.rest_solid_angle = 0.5;
  triangle.stiffness = 3;
  springs.get<SolidAngleSpring>().push_back(triangle);
  scene.addSprings(springs, kCorners);
  return scene;
}

double energyAtCorners() {
  const double arc = kPi / 2 - 1, triangle = kPi / 2 - 0.5;
  return 0.5 * (2 * arc * arc + 3 * triangle * triangle);
}

/// Expects both springs of `sceneAtCorners` to be at rest.
void expectRelaxed(const Points& positions) {
  EXPECT_NEAR(arc(positions.col(0), positions.col(1)).angle, 1, 1e-8);
  EXPECT_NEAR(solidAngle(positions.col(0), positions.col(1), positions.col(2)), 0.5, 1e-8);
}

mesh::TriangleMesh octahedron() {
  mesh::TriangleMesh mesh;
  mesh.vertices.resize(3, 6);
  mesh.vertices << 3 * Eigen::Matrix3d::Identity(), -Eigen::Matrix3d::Identity();
  mesh.faces.resize(3, 8);
  mesh.faces << 0, 1, 3, 4, 1, 3, 4, 0,  //
      1, 3, 4, 0, 0, 1, 3, 4,            //
      2, 2, 2, 2, 5, 5, 5, 5;
  return mesh;
}

TEST(Border, TypesHaveOneLayout) {
  const TypeLayout* theirs = layoutsOfLibrary();
  for (const TypeLayout& own : kLayouts) {
    EXPECT_EQ(own.size, theirs->size) << own.type;
    EXPECT_EQ(own.alignment, theirs->alignment) << own.type;
    ++theirs;
  }
}

TEST(Border, ClientKeepsItsOwnMatrices) {
  const System system(sceneAtCorners(), {});
  for (int size = 1; size < 40; ++size) {
    Eigen::VectorXd masses = system.masses();
    masses.conservativeResize(size + 3);
    masses.tail(size).setOnes();
    const Eigen::MatrixXd matrix = masses.asDiagonal();
    EXPECT_EQ((matrix * masses).sum(), size + 3);
  }
}

TEST(Border, FormulasOfSpringsCross) {
  SolidAngleSpring spring;
  spring.rest_solid_angle = 0.5;
  const std::array<Vector3, 3> points{kCorners.col(0), kCorners.col(1), kCorners.col(2)};
  std::array<TangentFrame, 3> frames;
  for (int i = 0; i < 3; ++i) frames[i] = tangentFrame(points[i]);

  const auto moved = [&](int i, int a, int j, int b) {  // a step along each of two axes
    auto result = points;
    constexpr double kStep = 1e-4;
    if (i >= 0) result[i] += kStep * frames[i].col(a);
    if (j >= 0) result[j] += kStep * frames[j].col(b);
    for (Vector3& p : result) p.normalize();
    return condition(spring, result).value;
  };
  const auto t = tangentCondition(spring, points, frames, Curvature::exact);
  EXPECT_NEAR(t.value, kPi / 2 - 0.5, 1e-12);
  EXPECT_NEAR(strain(spring, points), 1 - 0.5 / (kPi / 2), 1e-12);
  for (int i = 0; i < 3; ++i) {
    for (int a = 0; a < 2; ++a) {
      const double first = (moved(i, a, -1, 0) - t.value) / 1e-4;
      EXPECT_NEAR(t.gradient[i][a], first, 1e-3);
      for (int j = 0; j < i; ++j) {
        for (int b = 0; b < 2; ++b) {
          const double second =
              (moved(i, a, j, b) - moved(i, a, -1, 0) - moved(-1, 0, j, b) + t.value) / 1e-8;
          EXPECT_NEAR(t.hessian[i][j](a, b), second, 1e-3);
        }
      }
    }
  }
}

TEST(Border, ListsOfVectorsGrowOnBothSides) {
  std::vector<Vector3> ends;
  for (int i = 0; i < 50; ++i) {
    appendArc(kCorners.col(0), kCorners.col(1), 0.1, ends);
    ends.push_back(kCorners.col(2));
  }
  EXPECT_EQ(ends.size(), 50 * (2 * 16 + 1));
  EXPECT_NEAR((ends[2 * 16 - 1] - kCorners.col(1)).norm(), 0, 1e-12);
}

TEST(Border, SystemsEvaluate) {
  const System system(sceneAtCorners(0.1), {});
  EXPECT_EQ(system.masses(), Values::Ones(3));
  EXPECT_NEAR(system.potential(kCorners).total(), energyAtCorners(), 1e-12);
  EXPECT_LT(stableTimeStep(system, IntegrationMethod::verlet, kCorners), 2);
  System::Workspace workspace;
  for (int i = 0; i < 50; ++i) {
    workspace.torques.resize(3, i);
    workspace.end_torques.resize(i);
    system.evaluate(kCorners, workspace);
  }
  EXPECT_NEAR(workspace.torques.rowwise().sum().norm(), 0, 1e-12);
  Points velocities = Points::Zero(3, 3);
  velocities.col(2) = kCorners.col(0);
  system.damping().kick(kCorners, workspace.end_gradients, Points::Zero(3, 3), 2, velocities);
  EXPECT_NEAR(velocities(0, 2), std::exp(-0.2), 1e-9);
}

TEST(Border, StatesStep) {
  const auto plan = std::make_shared<const Plan>(sceneAtCorners(), System::Options());
  for (const auto method : {IntegrationMethod::verlet, IntegrationMethod::implicit_euler}) {
    State state;
    state.positions = kCorners;
    state.angular_velocities = Points::Zero(3, 3);
    Account account(*plan, state);
    const auto integrator = makeIntegrator(plan, method, 1e-4);
    for (int i = 0; i < 50; ++i) integrator->step(state);
    EXPECT_EQ(state.steps, 50);
    EXPECT_LT(account.energyError(energies(*plan, state)), 1e-3);
    EXPECT_GT(energies(*plan, state).kinetic, 1e-6);
    EXPECT_LT(normError(state), 1e-12);
  }
}

TEST(Border, SystemsRelax) {
  Relaxer relaxer;
  for (int i = 0; i < 50; ++i) {
    int calls = 0;
    RelaxationOptions options;
    options.method = i % 2 == 0 ? RelaxationMethod::newton : RelaxationMethod::fire;
    options.go_on = [&](const RelaxationProgress& progress) {
      ++calls;
      return progress.best.positions.cols() == 3;
    };
    const RelaxationResult result = relaxer.relax(System(sceneAtCorners(), {}), kCorners, options);
    EXPECT_TRUE(result.converged) << result.message;
    EXPECT_GT(calls, 0);
    expectRelaxed(result.positions);
  }
}

TEST(Border, RunnersRun) {
  Runner runner({}, false);
  std::stringstream text;
  writeScene(text, sceneAtCorners(), 0);
  runner.change([&](Simulation& s) { s.load(readScene(text, {})); });
  EXPECT_EQ(runner.step(100), 100);
  const Runner::Snapshot moving = runner.snapshot();
  EXPECT_EQ(moving.state.steps, 100);
  EXPECT_NEAR(energies(*moving.plan, moving.state).total(), energyAtCorners(), 1e-3);
  EXPECT_TRUE(runner.relax({}).converged);
  const Runner::Snapshot relaxed = runner.snapshot();
  expectRelaxed(relaxed.state.positions);
  EXPECT_LT(maxTorque(*relaxed.plan, relaxed.state), 1e-7);
  EXPECT_EQ(runner.present().scene.particles().item(2).position, relaxed.state.positions.col(2));
}

TEST(Border, MeshesMap) {
  const mesh::TriangleMesh surface = octahedron();
  mesh::requireTopologicalSphere(surface);
  const Eigen::VectorXd areas = mesh::faceAreas(surface);
  const Values shares = mesh::faceShares(areas.cwiseSqrt());
  const Points map = mesh::sphereMap(surface, shares);
  EXPECT_EQ(mesh::sphereMap(surface, shares, map).cols(), 6);
  const mesh::FaceDistortion faces = mesh::faceDistortion(surface, shares, map);
  EXPECT_NEAR(faces.areas.sum(), 4 * kPi, 1e-9);
  EXPECT_LT((faces.areas - shares).norm(), 1e-2);
  EXPECT_LT(mesh::summary(faces).spread, 2e-3);
  mesh::MapOptions options;
  options.go_on = [](const mesh::MapProgress& progress) { return progress.spread >= 0; };
  const mesh::MeshMap again = mesh::meshMap(surface, shares, map, options);
  EXPECT_EQ(again.end, mesh::MapEnd::found);
  EXPECT_TRUE(mesh::coversOnce(again.distortion));
  EXPECT_NEAR(mesh::centralProjection(surface).squaredNorm(), 6, 1e-12);
  const Scene scene = mesh::sceneOfMap(surface.faces, shares, again.points, 0, {});
  EXPECT_EQ(scene.springCount(), mesh::springCountOfMap(8));
  EXPECT_GT(mesh::volume(surface), 0);
}

TEST(Border, RefusalsAreCaughtByTheirTypes) {
  mesh::TriangleMesh open = octahedron();
  open.faces.conservativeResize(3, 7);
  EXPECT_THROW(mesh::requireTopologicalSphere(open), std::invalid_argument);
  EXPECT_THROW(requireInside({0, 1, "0 to 1"}, std::numeric_limits<double>::quiet_NaN(), "it"),
               NonFinite);
  mesh::MapOptions options;
  options.go_on = [](const mesh::MapProgress&) -> bool {
    throw std::domain_error("from the client");
  };
  EXPECT_THROW(mesh::sphereMap(octahedron(), Values::Constant(8, kPi / 2), options),
               std::domain_error);
}

}  // namespace
}  // namespace spherical_springs
