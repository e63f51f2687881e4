// Random requests to a simulation: each refused or followed by finite results.
#include <fuzzer/FuzzedDataProvider.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <vector>

#include "soundness.h"
#include "spherical_springs/relaxation.h"

using namespace spherical_springs::core;

namespace {

constexpr int kMostRequests = 16;
constexpr std::size_t kMostAtOnce = 6;

/// Tells at the end how many requests there were.
struct Counts {
  ~Counts() { std::fprintf(stderr, "requests: %llu, refused: %llu\n", requests, refused); }
  unsigned long long requests = 0, refused = 0;
} counts;

class Requests {
 public:
  Requests(const std::uint8_t* data, std::size_t size)
      : data_(data, size), simulation_(settings()) {}

  void run() {
    for (int i = 0; i < kMostRequests && data_.remaining_bytes() > 0; ++i) {
      ++counts.requests;
      try {
        one();
      } catch (const std::invalid_argument&) {
        ++counts.refused;
      }
      fuzzing::requireSound(simulation_);
    }
    fuzzing::requireSoundMeasures(simulation_);
  }

 private:
  Simulation::Settings settings() {
    Simulation::Settings settings;
    static_cast<StepWish&>(settings) = fixedSteps();
    settings.system.spring_damping =
        data_.ConsumeBool() ? SpringDamping::own : SpringDamping::relative;
    settings.system.threads = 1;
    settings.limits.particles = 40;
    settings.limits.springs = 80;
    return settings;
  }

  void one() {
    switch (data_.ConsumeIntegralInRange(0, 9)) {
      case 0:
        simulation_.addParticles(list<Particle>());
        break;
      case 1:
        simulation_.setParticles(ids(), list<Particle>());
        break;
      case 2:
        simulation_.removeParticles(ids());
        break;
      case 3:
        simulation_.addSprings(springs());
        break;
      case 4:
        simulation_.setSprings(springIds(), springs());
        break;
      case 5:
        simulation_.removeSprings(springIds());
        break;
      case 6:
        data_.ConsumeBool() ? simulation_.reset() : simulation_.clear();
        break;
      case 7:
        for (int i = data_.ConsumeIntegralInRange(1, 4); i > 0; --i) simulation_.step();
        break;
      case 8:
        simulation_.stepBy(anySteps());
        break;
      default:
        relaxShortly();
    }
  }

  StepWish fixedSteps() {
    StepWish wish;
    wish.method = integrationMethod(
        data_.PickValueInArray({"euler", "verlet", "fourth_order", "implicit_euler"}));
    wish.time_step = data_.PickValueInArray({1e-12, 1e-3, 0.1, 1., 1e3, 1e6});
    return wish;
  }

  StepWish anySteps() {
    StepWish wish = fixedSteps();
    wish.accuracy = data_.PickValueInArray({0., 1e-3, 1.});
    wish.chooses_method = data_.ConsumeBool();
    return wish;
  }

  void relaxShortly() {
    RelaxationOptions options;
    options.method =
        relaxationMethod(data_.PickValueInArray({"newton", "dynamics", "fire", "global"}));
    options.tolerance = data_.ConsumeBool() ? 0 : number();
    int iterations = data_.ConsumeIntegralInRange(1, 8);
    options.go_on = [&](const RelaxationProgress& progress) {
      fuzzing::require(progress.fraction >= 0 && progress.fraction <= 1, "progress is a share");
      return --iterations > 0;
    };
    const RelaxationResult result =
        relax(*simulation_.plan()->system(), simulation_.state().positions, options);
    fuzzing::requireUnitVectors(result.positions);
    fuzzing::require(std::isfinite(result.energy_before), "the energy before is finite");
    fuzzing::require(std::isfinite(result.max_torque), "the torque is finite");
    // Beside their rounding the torque decides what is better.
    constexpr double kRounding = 1e-13, kRoundingOfRest = 1e-28;  // of an energy; [rad^2] or [sr^2]
    const double most = (1 + kRounding) * result.energy_before +
                        kRoundingOfRest * simulation_.plan()->system()->largestStiffness();
    const bool rounding = roundingRules(simulation_.state().positions);
    fuzzing::require(rounding || result.energy_after <= most, "the energy has not grown");
    simulation_.settle(result.positions);
  }

  /// Whether vertices of a triangle are so near antipodal that rounding of their positions rules
  /// its area, and with it the energy.
  bool roundingRules(const Points& positions) {
    const System& system = *simulation_.plan()->system();
    bool any = false;
    forEachKind([&](auto kind) {
      for (const auto& spring : system.springs<typename decltype(kind)::type>()) {
        any = any || distanceToUndefined(spring, System::points(spring, positions)) < 1e-6;
      }
    });
    return any;
  }

  /// Mostly of a size that is taken; now and then at the edge of what is, beyond it, or any bits.
  double number() {
    using Limits = std::numeric_limits<double>;
    switch (data_.ConsumeIntegralInRange(0, 7)) {
      case 0:
        return data_.PickValueInArray({0., -0., 1., kPi, -kPi, 2 * kPi, kPi / 2, 1e-9, 1e-16});
      case 1:
        return data_.PickValueInArray({1e-30, 1e30, 1e100, -1e100, 1e300, Limits::denorm_min(),
                                       Limits::max(), Limits::infinity(), Limits::quiet_NaN()});
      case 2: {
        const auto bits = data_.ConsumeIntegral<std::uint64_t>();
        double value;
        static_assert(sizeof(value) == sizeof(bits));
        std::memcpy(&value, &bits, sizeof(value));
        return value;
      }
      default:
        return data_.ConsumeIntegral<std::int8_t>() / 32.;
    }
  }

  Vector3 vector() { return {number(), number(), number()}; }

  std::uint32_t id() {
    return data_.ConsumeBool() ? data_.ConsumeIntegralInRange(0u, 12u)
                               : data_.ConsumeIntegral<std::uint32_t>() % 50;
  }

  std::vector<std::uint32_t> ids() {
    std::vector<std::uint32_t> result(data_.ConsumeIntegralInRange<std::size_t>(0, kMostAtOnce));
    for (std::uint32_t& one : result) one = id();
    return result;
  }

  void fill(Particle& particle) {
    particle.position = vector();
    if (data_.ConsumeBool()) particle.angular_velocity = vector();
    particle.pinned = data_.ConsumeIntegralInRange(0, 9) == 0;
  }

  template <class Spring>
  void fill(Spring& spring) {
    for (std::uint32_t& end : spring.particles) end = id();
    spring.at_rest = data_.ConsumeIntegralInRange(0, 3) == 0;
  }

  template <class Item>
  std::vector<Item> list() {
    std::vector<Item> items(data_.ConsumeIntegralInRange<std::size_t>(0, kMostAtOnce));
    for (Item& item : items) {
      fill(item);
      Item::visitFields(item, [&](const char*, double& value, const Range& range) {
        value = number();
        if (!range.contains(value) && data_.ConsumeBool()) value = 1;
      });
    }
    return items;
  }

  SpringLists springs() {
    SpringLists result;
    forEachKind([&](auto kind) {
      using Spring = typename decltype(kind)::type;
      const auto items = list<Spring>();
      result.get<Spring>().assign(items.begin(), items.end());
    });
    return result;
  }

  SpringIds springIds() {
    SpringIds result;
    forEachKind([&](auto kind) {
      const auto some = ids();
      result.get<typename decltype(kind)::type>().assign(some.begin(), some.end());
    });
    return result;
  }

  FuzzedDataProvider data_;
  Simulation simulation_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Requests(data, size).run();
  return 0;
}
