// Everything that clients, timers and topics do with a runner, at once; scripts/thread_sanitizer
// runs it under ThreadSanitizer too.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <ostream>
#include <stdexcept>
#include <thread>
#include <vector>

#include "simulation/runner.h"
#include "spherical_springs/measures.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

struct Crowd {
  int threads;  ///< of each loop
  std::uint32_t particles;
  int calls;  ///< of each client
  int steps;  ///< of a call
};

void PrintTo(const Crowd& crowd, std::ostream* out) {
  *out << crowd.particles << " particles on " << crowd.threads << " threads";
}

class Concurrency : public ::testing::TestWithParam<Crowd> {
 protected:
  Concurrency() {
    const int springs_each = static_cast<int>(GetParam().particles);
    const Scene scene = testing::randomScene(1, GetParam().particles, springs_each, 0.1, 1);
    runner_.change([&](Simulation& s) {
      s.addParticles(scene.particles().items());
      s.addSprings(testing::springsOf(scene));
    });
  }

  /// Calls many times, on a thread; what is refused meanwhile is refused.
  void keepCalling(const std::function<void()>& call) {
    clients_.emplace_back([this, call] {
      for (int i = 0; i < GetParam().calls; ++i) {
        try {
          call();
        } catch (const std::runtime_error&) {
          ++refused_;
        }
      }
    });
  }

  void join() {
    for (std::thread& client : clients_) client.join();
  }

  static Simulation::Settings settings() {
    Simulation::Settings settings;
    settings.system.threads = GetParam().threads;
    return settings;
  }

  Runner runner_{settings(), true};
  std::vector<std::thread> clients_;
  std::atomic<int> refused_{0};
};

TEST_P(Concurrency, OfServicesTimersTopicsRelaxationAndCancelling) {
  // A topic and the status.
  keepCalling([this] {
    const auto now = runner_.snapshot();
    measure(now.plan, IntegrationMethod::verlet, 1e-3, now.state, *now.account);
  });
  keepCalling([this] {
    const auto now = runner_.snapshot();
    ASSERT_TRUE(std::isfinite(energies(*now.plan, now.state).total()));
  });
  // The timer.
  keepCalling([this] { runner_.advance(0.001 * GetParam().steps, 0.01); });
  // Clients.
  keepCalling([this] { runner_.read([](const Simulation& s) { return s.presentScene(); }); });
  for (const bool running : {false, true}) {
    keepCalling([this, running] { runner_.setRunning(running); });
  }
  keepCalling([this] {
    const auto ids = runner_.change([](Simulation& s) {
      return s.addParticles({testing::particleAt({1, 2, 3})});
    });
    runner_.change([&](Simulation& s) { s.removeParticles(ids); });
  });
  keepCalling([this] { runner_.change([](Simulation& s) { s.reset(); }); });
  keepCalling([this] { runner_.step(GetParam().steps); });
  for (const auto method : {RelaxationMethod::newton, RelaxationMethod::dynamics}) {
    keepCalling([this, method] {
      RelaxationOptions options;
      options.method = method;
      options.max_time = 0.05;
      runner_.relax(options);
    });
  }
  for (int i = 0; i < 2; ++i) {
    keepCalling([this] {
      runner_.cancel();
      std::this_thread::yield();
    });
  }
  join();

  EXPECT_GT(refused_, 0) << "nothing ever met";
  EXPECT_EQ(runner_.snapshot().activity, Activity::none);
  EXPECT_TRUE(runner_.snapshot().state.positions.allFinite());
}

TEST_P(Concurrency, OfClosingAndAllElse) {
  runner_.setRunning(false);
  for (int i = 0; i < 2; ++i) {
    keepCalling([this] { runner_.step(~std::uint64_t(0)); });
    keepCalling([this] {
      RelaxationOptions options;
      options.method = RelaxationMethod::dynamics;
      options.tolerance = 1e-300;
      runner_.relax(options);
    });
    keepCalling([this] { runner_.snapshot(); });
  }
  while (runner_.snapshot().activity == Activity::none) std::this_thread::yield();
  runner_.close();
  join();
  EXPECT_EQ(runner_.snapshot().activity, Activity::none);
}

// Loops over the springs of the larger scenes are long enough to be shared.
INSTANTIATE_TEST_SUITE_P(OfARunner, Concurrency,
                         ::testing::Values(Crowd{1, 60, 150, 1000}, Crowd{2, 4200, 10, 10},
                                           Crowd{3, 4200, 10, 10}));

}  // namespace
}  // namespace spherical_springs::core
