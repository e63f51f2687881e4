#include "relaxation/tangent_energy.h"

#include <algorithm>
#include <cmath>

#include "base/buckets.h"
#include "relaxation/hessian_kernels.h"

namespace spherical_springs::core {

namespace {

/// Particles that something acts on: springs or, where there is inertia, their targets.
std::vector<bool> freeParticles(const System& system, bool inertia) {
  std::vector<bool> free(system.particleCount());
  for (std::size_t i = 0; i < free.size(); ++i) {
    free[i] = !system.pinned(i) && (inertia || system.joined(i));
  }
  return free;
}

/// The number of the first particle of a spring in the order here, where free ones come first.
template <class Spring>
std::uint32_t lowestOf(const Spring& spring) {
  return *std::min_element(spring.particles.begin(), spring.particles.end());
}

}  // namespace

TangentEnergy::TangentEnergy(const System& system, const Points& positions, Eigen::VectorXd inertia)
    : threads_(system.threads()),
      places_(particleOrder(freeParticles(system, inertia.size() > 0), positions), threads_),
      pattern_(freeGraph(system, places_.order(), threads_), threads_),
      far_apart_(farApart(pattern_.graph, pattern_.order, threads_)),
      units_(inertia.size() > 0 ? std::vector<std::uint32_t>(freeCount(), 0)
                                : componentsOf(pattern_.graph)),
      inertia_(std::move(inertia)) {
  forEachKind([&](auto kind) { compile<typename decltype(kind)::type>(system); });
  take(system);
  gradient_.resize(2 * freeCount());
  hessian_.resize(pattern_.graph.neighbours.size());
  block_values_.resize(pattern_.order.blocks());
}

/// Springs by the block of their first free particle in the order here.
template <class Spring>
void TangentEnergy::compile(const System& system) {
  constexpr std::size_t kEnds = Spring::kParticles;
  auto& compiled = compiled_.get<Spring>();
  const auto& springs = system.springs<Spring>();
  const std::size_t blocks = pattern_.order.blocks();
  const auto numbered = [&](Spring spring) {
    for (std::uint32_t& i : spring.particles) i = order().numbers[i];
    return spring;
  };
  auto by_lowest = dealtOut<std::uint32_t>(order().particles.size(), [&](const auto& visit) {
    for (std::uint32_t s = 0; s < springs.size(); ++s) visit(lowestOf(numbered(springs[s])), s);
  });
  compiled.first.resize(blocks + 1);
  for (std::size_t b = 0; b <= blocks; ++b) {
    compiled.first[b] = by_lowest.first[pattern_.order.first_node[b]];
  }
  compiled.sources = std::move(by_lowest.items);
  const auto placeOf = [&](std::uint32_t row, std::uint32_t column) {
    if (row >= freeCount() || column >= freeCount()) return HessianArrays::kNotStored;
    return row == column ? pattern_.diagonal[row] : pattern_.place(row, column);
  };
  compiled.springs.resize(springs.size());
  compiled.places.resize(springs.size());
  parallelFor(springs.size(), threads_, [&](std::ptrdiff_t s) {
    const Spring& spring = compiled.springs[s] = numbered(springs[compiled.sources[s]]);
    for (std::size_t i = 0; i < kEnds; ++i) {
      for (std::size_t j = 0; j < kEnds; ++j) {
        compiled.places[s][kEnds * i + j] = placeOf(spring.particles[i], spring.particles[j]);
      }
    }
  });
}

bool TangentEnergy::fits(const System& system) const {
  constexpr double kMostChange = 2;  // factor of a stiffness
  if (static_cast<std::size_t>(system.particleCount()) != order().particles.size()) return false;
  const std::vector<bool> free = freeParticles(system, inertia_.size() > 0);
  for (std::size_t n = 0; n < order().particles.size(); ++n) {
    if (free[order().particles[n]] != (n < freeCount())) return false;
  }
  bool fits = true;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& compiled = compiled_.get<Spring>();
    const auto& springs = system.springs<Spring>();
    fits = fits && springs.size() == compiled.springs.size();
    for (std::size_t s = 0; fits && s < compiled.springs.size(); ++s) {
      const Spring& spring = springs[compiled.sources[s]];
      const double stiffness = unitOf(compiled.springs[s]) * compiled.springs[s].stiffness;
      fits = stiffness <= kMostChange * spring.stiffness &&
             spring.stiffness <= kMostChange * stiffness;
      for (std::size_t j = 0; j < Spring::kParticles; ++j) {
        fits = fits && order().numbers[spring.particles[j]] == compiled.springs[s].particles[j];
      }
    }
  });
  return fits;
}

template <class Spring>
double TangentEnergy::unitOf(const Spring& spring) const {
  const std::uint32_t lowest = lowestOf(spring);
  return lowest < freeCount() ? unit(lowest) : 1;
}

void TangentEnergy::take(const System& system) {
  units_.take(system, order(), inertia_.size() > 0 ? inertia_.maxCoeff() : 0);
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    auto& compiled = compiled_.get<Spring>();
    const auto& springs = system.springs<Spring>();
    parallelFor(compiled.springs.size(), threads_, [&](std::ptrdiff_t s) {
      Spring spring = springs[compiled.sources[s]];
      spring.particles = compiled.springs[s].particles;
      spring.stiffness /= unitOf(spring);
      compiled.springs[s] = spring;
    });
  });
}

void TangentEnergy::place(const Points& positions) {
  places_.place(positions);
  findPinnedEnergy();
}

void TangentEnergy::carry(const Points& positions) {
  places_.carry(positions);
  findPinnedEnergy();
}

void TangentEnergy::findPinnedEnergy() {
  pinned_energy_ = 0;
  forEachKind([&](auto kind) {
    const auto& compiled = compiled_.get<typename decltype(kind)::type>();
    for (std::size_t s = compiled.first.back(); s < compiled.springs.size(); ++s) {
      pinned_energy_ += addOne(compiled, s, Curvature::definite);
    }
  });
}

void TangentEnergy::setTargets(const Points& targets) {
  targets_.resize(freeCount());
  for (std::size_t n = 0; n < freeCount(); ++n) targets_[n] = targets.col(order().particles[n]);
}

double TangentEnergy::expectedDrop(const Eigen::VectorXd& step) const {
  const Graph& graph = pattern_.graph;
  return -parallelSum(freeCount(), threads_, [&](std::ptrdiff_t i) {
    const Eigen::Vector2d product =
        rowProduct<double, 2>(graph, hessian_, step, graph.first[i], graph.first[i + 1]);
    return step.segment<2>(2 * i).dot(gradient_.segment<2>(2 * i) + 0.5 * product);
  });
}

namespace {

/// Returns the kernel of a kind of springs, or null for a kind without one.
HessianKernel<2> kernelFor(const AngleSpring&) { return hessianKernels().angle_springs; }
HessianKernel<3> kernelFor(const SolidAngleSpring&) { return hessianKernels().solid_angle_springs; }
template <class Spring>
void* kernelFor(const Spring&) {
  return nullptr;
}
const double& restOf(const AngleSpring& spring) { return spring.rest_angle; }
const double& restOf(const SolidAngleSpring& spring) { return spring.rest_solid_angle; }

}  // namespace

template <class Spring>
double TangentEnergy::add(const Compiled<Spring>& compiled, std::size_t block,
                          Curvature curvature) {
  const std::uint32_t begin = compiled.first[block], end = compiled.first[block + 1];
  if (begin == end) return 0;
  double value = 0;
  if constexpr (std::is_same_v<decltype(kernelFor(Spring())), HessianKernel<Spring::kParticles>>) {
    const Spring& first = compiled.springs.front();
    const SpringFields<Spring::kParticles> fields = {
        {first.particles.data(), sizeof(Spring)},
        {&restOf(first), sizeof(Spring)},
        {&first.stiffness, sizeof(Spring)},
        {compiled.places.data(), sizeof(compiled.places[0])}};
    const HessianArrays arrays = {places_[0].frame.data(),
                                  static_cast<std::uint32_t>(freeCount()),
                                  gradient_.data(),
                                  hessian_.front().data(),
                                  curvature == Curvature::definite,
                                  leastCurvature(curvature)};
    std::vector<std::uint32_t> left_out(end - begin);
    std::uint32_t count = 0;
    value = kernelFor(first)(fields, begin, end, arrays, left_out.data(), count);
    for (std::uint32_t i = 0; i < count; ++i) value += addOne(compiled, left_out[i], curvature);
  } else {
    for (std::uint32_t s = begin; s < end; ++s) value += addOne(compiled, s, curvature);
  }
  return value;
}

template <class Spring>
std::array<Vector3, Spring::kParticles> TangentEnergy::pointsOf(const Spring& spring) const {
  std::array<Vector3, Spring::kParticles> points;
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = places_[spring.particles[i]].point;
  return points;
}

template <class Spring>
double TangentEnergy::addOne(const Compiled<Spring>& compiled, std::size_t s, Curvature curvature) {
  constexpr std::size_t kEnds = Spring::kParticles;
  const Spring& spring = compiled.springs[s];
  std::array<TangentFrame, kEnds> frames;
  for (std::size_t i = 0; i < kEnds; ++i) frames[i] = places_[spring.particles[i]].frame;
  const auto c = tangentCondition(spring, pointsOf(spring), frames, curvature);
  for (std::size_t i = 0; i < kEnds; ++i) {
    if (spring.particles[i] >= freeCount()) continue;
    gradient_.segment<2>(2 * spring.particles[i]) += spring.stiffness * c.value * c.gradient[i];
    for (std::size_t j = 0; j < kEnds; ++j) {
      const std::uint32_t place = compiled.places[s][kEnds * i + j];
      if (place == HessianArrays::kNotStored) continue;
      hessian_[place] += spring.stiffness *
                         (c.gradient[i] * c.gradient[j].transpose() + c.value * c.hessian[i][j]);
    }
  }
  return 0.5 * spring.stiffness * c.value * c.value;
}

void TangentEnergy::evaluate(Curvature curvature) {
  gradient_.setZero();
  parallelFor(freeCount(), threads_, [&](std::ptrdiff_t n) {
    for (std::uint32_t e = pattern_.graph.first[n]; e < pattern_.graph.first[n + 1]; ++e) {
      hessian_[e].setZero();
    }
  });
  const int threads = worthwhileThreads(freeCount(), threads_);
  far_apart_.forEach(threads, [&](std::size_t block) {
    double value = 0;
    forEachKind([&](auto kind) {
      using Spring = typename decltype(kind)::type;
      value += add(compiled_.get<Spring>(), block, curvature);
    });
    block_values_[block] = value;
  });
  value_ = 0;
  for (const double value : block_values_) value_ += value;
  if (inertia_.size() > 0) addInertia(curvature);
}

double TangentEnergy::energy() const {
  if (freeCount() == 0) return pinned_energy_;
  if (!units_.differ()) return pinned_energy_ + unit(0) * value_;
  double energy = pinned_energy_;
  forEachKind([&](auto kind) {
    const auto& compiled = compiled_.get<typename decltype(kind)::type>();
    for (std::size_t s = 0; s < compiled.first.back(); ++s) {
      const auto& spring = compiled.springs[s];
      const double c = condition(spring, pointsOf(spring)).value;
      energy += 0.5 * unitOf(spring) * spring.stiffness * c * c;
    }
  });
  return energy;
}

// The distance from a target is the condition of an angle spring of rest angle 0 to a pinned one.
void TangentEnergy::addInertia(Curvature curvature) {
  for (std::size_t n = 0; n < freeCount(); ++n) {
    const double stiffness = inertia_[order().particles[n]] / unit(n);
    const auto& [frame, point] = places_[n];
    const auto c = tangentCondition(AngleSpring(), {point, targets_[n]}, {frame, frame}, curvature);
    value_ += 0.5 * stiffness * c.value * c.value;
    gradient_.segment<2>(2 * n) += stiffness * c.value * c.gradient[0];
    hessian_[pattern_.diagonal[n]] +=
        stiffness * (c.gradient[0] * c.gradient[0].transpose() + c.value * c.hessian[0][0]);
  }
}

double TangentEnergy::maxTorque() const {
  return parallelLargest(freeCount(), threads_, [&](std::ptrdiff_t n) {
    return unit(n) * gradient_.segment<2>(2 * n).norm();
  });
}

Eigen::VectorXd TangentEnergy::reach() const {
  const Graph& graph = pattern_.graph;
  Eigen::VectorXd longest(freeCount());
  parallelFor(freeCount(), threads_, [&](std::ptrdiff_t i) {
    double squared = 0;
    for (std::uint32_t e = graph.first[i]; e < graph.first[i + 1]; ++e) {
      const Vector3& other = places_[graph.neighbours[e]].point;
      squared = std::max(squared, (other - places_[i].point).squaredNorm());
    }
    longest[i] = squared > 0 ? std::sqrt(squared) : 1;
  });
  return longest;
}

}  // namespace spherical_springs::core
