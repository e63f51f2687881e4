#include "networks.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "scene_parts.h"

namespace benchmark_scenes {
namespace {

using spherical_springs::core::kPi;
using spherical_springs::core::solidAngle;

constexpr std::uint32_t kSeed = 1;

Parts benchmarkParts(int level, Random& random) {
  return displacedMesh(level, Springs::both, random);
}

// --- the networks ---

Parts randomStart(int level) {
  Random random(kSeed);
  Parts parts = benchmarkParts(level, random);
  for (Particle& particle : parts.particles) particle.position = random.direction();
  return parts;
}

/// About three arcs for each particle, to any other, with any rest angle.
Parts longRangeGraph(std::uint32_t count) {
  Random random(kSeed);
  Parts parts = particlesAnywhere(count, random);
  for (std::uint32_t i = 0; i < count; ++i) {
    for (int j = 0; j < 3; ++j) {
      const std::uint32_t other = random.below(count);
      if (other != i) parts.addArc(i, other, random.between(0, kPi));
    }
  }
  return parts;
}

Parts chain(std::uint32_t count) {
  Random random(kSeed);
  Parts parts = particlesAnywhere(count, random);
  for (std::uint32_t i = 1; i < count; ++i) parts.addArc(i - 1, i, random.between(0.05, 0.5));
  return parts;
}

Parts chainBetweenPins(std::uint32_t count) {
  Parts parts = chain(count);
  for (AngleSpring& spring : parts.arcs()) spring.rest_angle /= count;
  parts.particles.front().pinned = parts.particles.back().pinned = true;
  return parts;
}

Parts star(std::uint32_t count) {
  Random random(kSeed);
  Parts parts = particlesAnywhere(count, random);
  for (std::uint32_t i = 1; i < count; ++i) parts.addArc(0, i, random.between(0.1, 3));
  return parts;
}

Parts grid(std::uint32_t side) {
  constexpr double kCell = 0.04;  // [rad]
  Random random(kSeed);
  Parts parts;
  const auto tangent = [&](std::uint32_t i) { return (i - (side - 1) / 2.) * kCell; };
  for (std::uint32_t i = 0; i < side; ++i) {
    for (std::uint32_t j = 0; j < side; ++j) {
      parts.addParticle(Vector3(tangent(i), tangent(j), 1).normalized());
      const auto rest = [&] { return kCell * random.between(0.8, 1.2); };
      if (i > 0) parts.addArc(side * i + j, side * (i - 1) + j, rest());
      if (j > 0) parts.addArc(side * i + j, side * i + j - 1, rest());
    }
  }
  displace(0.3 * kCell, random, parts);
  return parts;
}

/// The benchmark scene displaced once more, so far that some triangles fold over.
Parts foldedTriangles(int level) {
  Random random(kSeed);
  Parts parts = benchmarkParts(level, random);
  displace(0.25 * parts.arcs().front().rest_angle, random, parts);
  return parts;
}

Parts completeGraph(std::uint32_t count) {
  Random random(kSeed);
  Parts parts = particlesAnywhere(count, random);
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t j = 0; j < i; ++j) parts.addArc(i, j, kPi);
  }
  return parts;
}

/// Swaps neighbours until a share of the triangles is inverted.
void invertTriangles(const Mesh& mesh, double share, Random& random, Parts& parts) {
  const auto inverted = [&] {
    return std::count_if(mesh.faces.begin(), mesh.faces.end(), [&](const auto& face) {
      const auto at = [&](int i) { return parts.particles[face[i]].position; };
      return solidAngle(at(0), at(1), at(2)) < 0;
    });
  };
  std::vector<bool> swapped(mesh.vertices.size(), false);
  while (inverted() < share * mesh.faces.size()) {
    const auto [a, b] = mesh.edges[random.below(static_cast<std::uint32_t>(mesh.edges.size()))];
    if (swapped[a] || swapped[b]) continue;
    std::swap(parts.particles[a].position, parts.particles[b].position);
    swapped[a] = swapped[b] = true;
  }
}

Parts orientedAngles(int level) {
  Random random(kSeed);
  const Mesh mesh = icosphere(level);
  Parts parts = particlesAt(mesh.vertices);
  for (const auto& face : mesh.faces) {
    for (int i = 0; i < 3; ++i) {
      parts.orientedArcs().emplace_back();
      OrientedAngleSpring& spring = parts.orientedArcs().back();
      spring.particles = {face[i], face[(i + 1) % 3], face[(i + 2) % 3]};
      spring.rest_angle = length(mesh, {face[i], face[(i + 1) % 3]});
      spring.stiffness = 1;
    }
  }
  invertTriangles(mesh, 0.1, random, parts);
  return parts;
}

Parts halfOfTheArcs(int level) {
  Random random(kSeed);
  Parts parts = displacedMesh(level, Springs::arcs, random);
  auto& arcs = parts.arcs();
  arcs.erase(std::remove_if(arcs.begin(), arcs.end(),
                            [&](const AngleSpring&) { return random.unit() < 0.5; }),
             arcs.end());
  return parts;
}

/// Three meshes over each other, a chain of ten, and five particles without springs.
Parts separateComponents(int level) {
  Random random(kSeed);
  Parts parts;
  const auto append = [&](Parts piece) {
    const std::uint32_t first = parts.size();
    for (const Particle& particle : piece.particles) parts.particles.push_back(particle);
    for (AngleSpring spring : piece.arcs()) {
      for (std::uint32_t& particle : spring.particles) particle += first;
      parts.arcs().push_back(spring);
    }
    for (SolidAngleSpring spring : piece.triangles()) {
      for (std::uint32_t& particle : spring.particles) particle += first;
      parts.triangles().push_back(spring);
    }
  };
  for (int i = 0; i < 3; ++i) append(benchmarkParts(level, random));
  append(chain(10));
  append(particlesAnywhere(5, random));
  return parts;
}

Parts pinned(int level, double share) {
  Random random(kSeed);
  Parts parts = benchmarkParts(level, random);
  for (Particle& particle : parts.particles) particle.pinned = random.unit() < share;
  return parts;
}

Parts stiffnessOverTwelveDecades(int level) {
  Random random(kSeed);
  Parts parts = benchmarkParts(level, random);
  const auto stiffness = [&] { return std::pow(10, random.between(-6, 6)); };
  for (AngleSpring& spring : parts.arcs()) spring.stiffness = stiffness();
  for (SolidAngleSpring& spring : parts.triangles()) spring.stiffness = stiffness();
  return parts;
}

Parts stiffTriangles(int level) {
  Random random(kSeed);
  return displacedMesh(level, Springs::both, random, 1e5);
}

Parts restAnglesZeroAndPi(int level) {
  Random random(kSeed);
  Parts parts = displacedMesh(level, Springs::arcs, random);
  for (AngleSpring& spring : parts.arcs()) spring.rest_angle = random.unit() < 0.5 ? 0 : kPi;
  return parts;
}

Parts onOneSpot(int level, double share) {
  Random random(kSeed);
  Parts parts = benchmarkParts(level, random);
  for (Particle& particle : parts.particles) {
    if (random.unit() < share) particle.position = Vector3::UnitZ();
  }
  return parts;
}

}  // namespace

Scene benchmarkScene(int level) {
  Random random(kSeed);
  return benchmarkParts(level, random).scene();
}

std::vector<Network> networks() {
  std::vector<Network> result;
  const auto add = [&](const std::string& name, std::function<Parts()> make) {
    result.push_back({name, [make = std::move(make)] { return make().scene(); }});
  };
  add("random start, 642", [] { return randomStart(3); });
  add("random start, 2,562", [] { return randomStart(4); });
  add("long-range graph, 1,000", [] { return longRangeGraph(1000); });
  add("long-range graph, 10,000", [] { return longRangeGraph(10'000); });
  add("chain, 1,000", [] { return chain(1000); });
  add("chain between pins, 1,000", [] { return chainBetweenPins(1000); });
  add("star, 500", [] { return star(500); });
  add("grid, 30 x 30", [] { return grid(30); });
  add("complete graph, 300", [] { return completeGraph(300); });
  add("triangles alone, 642", [] {
    Random random(kSeed);
    return displacedMesh(3, Springs::triangles, random);
  });
  add("triangles alone, 10,242", [] {
    Random random(kSeed);
    return displacedMesh(5, Springs::triangles, random);
  });
  add("arcs alone, 2,562", [] {
    Random random(kSeed);
    return displacedMesh(4, Springs::arcs, random);
  });
  add("oriented angles, a tenth inverted, 642", [] { return orientedAngles(3); });
  add("oriented angles, a tenth inverted, 2,562", [] { return orientedAngles(4); });
  add("half of the arcs, 2,562", [] { return halfOfTheArcs(4); });
  add("separate components, 1,941", [] { return separateComponents(3); });
  add("folded triangles, 10,242", [] { return foldedTriangles(5); });
  add("few pins, 2,562", [] { return pinned(4, 0.002); });
  add("most pinned, 2,562", [] { return pinned(4, 0.95); });
  add("stiffness over twelve decades, 2,562", [] { return stiffnessOverTwelveDecades(4); });
  add("stiffness over twelve decades, 10,242", [] { return stiffnessOverTwelveDecades(5); });
  add("triangles 1e5 times stiffer, 2,562", [] { return stiffTriangles(4); });
  add("rest angles 0 and pi, 642", [] { return restAnglesZeroAndPi(3); });
  add("a tenth on one spot, 642", [] { return onOneSpot(3, 0.1); });
  add("all on one spot, 162", [] { return onOneSpot(2, 1); });
  return result;
}

}  // namespace benchmark_scenes
