#include "node/handlers.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "node/chosen_fields.h"
#include "node/conversion.h"
#include "node/kinds.h"
#include "spherical_springs/range.h"

namespace spherical_springs {
namespace {

using Clock = std::chrono::steady_clock;

/// Room for a message that is written after a change [bytes].
constexpr std::size_t kMessageRoom = 1000;

/// The functions that append take no memory beyond what `text` has reserved.
void append(std::uint64_t number, std::string& text) {
  char digits[20];
  const auto end = std::to_chars(std::begin(digits), std::end(digits), number).ptr;
  text.append(digits, end);
}

void appendCount(std::uint64_t count, const char* what, std::string& text) {
  append(count, text);
  text.append(" ").append(what).append(count == 1 ? "" : "s");
}

std::string counted(std::uint64_t count, const char* what) {
  std::string text;
  appendCount(count, what, text);
  return text;
}

double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

}  // namespace

void Handlers::addParticles(const AddParticles::Request& request, Answer<AddParticles>& answer) {
  auto& response = answer.response;
  auto particles = fromMessages(request.particles);
  response.ids.resize(particles.size());
  response.message = "added " + counted(particles.size(), "particle");
  answer.reserve();
  runner_.change([&](core::Simulation& s) { response.ids = s.addParticles(std::move(particles)); });
}

void Handlers::setParticles(const SetParticles::Request& request, Answer<SetParticles>& answer) {
  const ChosenFields chosen(request.fields);
  chosen.requireAmong(particleFields(), "particles");
  auto particles = fromMessages(request.particles);
  answer.response.message = "set " + counted(request.ids.size(), "particle");
  answer.reserve();
  runner_.change([&](core::Simulation& s) {
    const auto present = [&](std::size_t index) {
      core::Particle particle = s.scene().particles().item(index);
      particle.position = s.state().positions.col(index);
      particle.angular_velocity = s.state().angular_velocities.col(index);
      return particle;
    };
    keepOthersOfAll(chosen, s.scene().particles(), request.ids, present, particles);
    s.setParticles(request.ids, std::move(particles));
  });
}

void Handlers::removeParticles(const RemoveParticles::Request& request,
                               Answer<RemoveParticles>& answer) {
  auto& response = answer.response;
  answer.reserve(kMessageRoom);
  runner_.change([&](core::Simulation& s) {
    response.springs_removed = static_cast<std::uint32_t>(s.removeParticles(request.ids));
  });
  response.message = "removed ";
  appendCount(request.ids.size(), "particle", response.message);
  response.message += " and ";
  appendCount(response.springs_removed, "spring", response.message);
}

void Handlers::addSprings(const AddSprings::Request& request, Answer<AddSprings>& answer) {
  auto& response = answer.response;
  auto springs = springsFrom(request);
  forEachKindInMessages(
      [&](auto kind) { kind.ids(response).resize(kind.springs(request).size()); });
  response.message = "added " + counted(springCount(request), "spring");
  answer.reserve();
  runner_.change(
      [&](core::Simulation& s) { setSpringIds(s.addSprings(std::move(springs)), response); });
}

void Handlers::setSprings(const SetSprings::Request& request, Answer<SetSprings>& answer) {
  const ChosenFields chosen(request.fields);
  requireSpringFields(chosen, request);
  auto springs = springsFrom(request);
  const auto ids = springIdsFrom(request);
  answer.response.message = "set " + counted(springCount(request), "spring");
  answer.reserve();
  runner_.change([&](core::Simulation& s) {
    core::forEachKind([&](auto kind) {
      using Spring = typename decltype(kind)::type;
      const auto& table = s.scene().springs<Spring>();
      const auto present = [&](std::size_t index) { return table.item(index); };
      keepOthersOfAll(chosen, table, ids.get<Spring>(), present, springs.get<Spring>());
    });
    s.setSprings(ids, std::move(springs));
  });
}

void Handlers::removeSprings(const RemoveSprings::Request& request, Answer<RemoveSprings>& answer) {
  const auto ids = springIdsFrom(request);
  answer.response.message = "removed " + counted(springIdCount(request), "spring");
  answer.reserve();
  runner_.change([&](core::Simulation& s) { s.removeSprings(ids); });
}

void Handlers::loadScene(const LoadScene::Request& request, Answer<LoadScene>& answer) {
  const auto path = directory_.inside(request.path);
  auto file = core::readScene(path, limits_);
  answer.response.message = "loaded " + core::onOneLine(path);
  answer.reserve();
  runner_.change([&](core::Simulation& s) {
    try {
      s.load(std::move(file));
    } catch (const std::invalid_argument& fault) {
      throw std::invalid_argument(core::onOneLine(path) + " cannot be loaded: " + fault.what());
    }
  });
  news_.relaxed("");
  news_.tell(answer.response.message);
}

void Handlers::saveScene(const SaveScene::Request& request, Answer<SaveScene>& answer) {
  const auto path = directory_.inside(request.path);
  const auto [scene, time] = runner_.present();
  answer.response.message = "saved " + core::onOneLine(path);
  answer.reserve();
  directory_.make();
  core::writeScene(path, scene, time);
  news_.tell(answer.response.message);
}

void Handlers::clear(const std_srvs::Trigger::Request&, Answer<std_srvs::Trigger>& answer) {
  runner_.change([&](core::Simulation& s) {
    answer.response.message = "removed " + counted(s.scene().particles().size(), "particle") +
                              " and " + counted(s.scene().springCount(), "spring") + ", time 0";
    answer.reserve();
    s.clear();
  });
  news_.relaxed("");
}

void Handlers::reset(const std_srvs::Trigger::Request&, Answer<std_srvs::Trigger>& answer) {
  answer.response.message = "every particle is where it was last added or set, time 0";
  answer.reserve();
  runner_.change([](core::Simulation& s) { s.reset(); });
  news_.relaxed("");
}

void Handlers::setRunning(const std_srvs::SetBool::Request& request,
                          Answer<std_srvs::SetBool>& answer) {
  answer.response.message = request.data ? "running" : "paused";
  answer.reserve();
  runner_.setRunning(request.data);
}

namespace {

/// Returns how many steps of a length [s] a request asks for, beyond those that are done.
/// @throw std::invalid_argument where it does so in two ways, or for more than a step may take.
std::uint32_t stepsIn(const Step::Request& request, double time_step,
                      const core::Runner::Done& done) {
  constexpr std::uint32_t kMost = ~std::uint32_t(0);
  if (request.duration == 0) return request.steps - static_cast<std::uint32_t>(done.steps);
  if (request.steps != 0) {
    throw std::invalid_argument("steps is " + std::to_string(request.steps) + " and duration is " +
                                core::toText(request.duration) +
                                "; allowed: one of the two, the other 0");
  }
  const double longest = kMost * time_step;
  const std::string allowed =
      "0 to " + core::toText(longest) + " [s], the time of " + std::to_string(kMost) + " steps";
  if (done.steps == 0) {
    core::requireInside(core::Range{0, longest, allowed.c_str()}, request.duration, "duration");
  }
  const double steps = std::round((request.duration - done.time) / time_step);
  return static_cast<std::uint32_t>(
      std::clamp<double>(steps, 0, static_cast<double>(kMost - done.steps)));
}

}  // namespace

void Handlers::step(const Step::Request& request, Answer<Step>& answer,
                    core::StepFollower* follower) {
  const auto begin = Clock::now();
  auto& response = answer.response;
  response.energies.header.frame_id = frame_id_;
  answer.reserve(kMessageRoom);
  const auto report = [&] {
    response.wall_time = secondsSince(begin);
    const auto now = runner_.snapshot();
    response.time = now.state.time;
    response.energies = energiesOf(now, frame_id_);
  };
  std::uint64_t steps = 0;
  const auto count = [&](double time_step, const core::Runner::Done& done) {
    const std::uint32_t left = stepsIn(request, time_step, done);
    steps = done.steps + left;
    return left;
  };
  const double time_step = runner_.choice().time_step;
  if (count(time_step, {}) == 0) {
    if (request.duration != 0) {
      response.message = "did no step: a duration of " + core::toText(request.duration) +
                         " s is less than half of the time step, " + core::toText(time_step) + " s";
    }
    report();
    return;
  }
  const StatusChange told_at_the_end(news_);
  const std::uint64_t done = runner_.step(count, report, follower).steps;
  news_.sceneChanged();
  response.steps = static_cast<std::uint32_t>(done);
  response.message = done == steps ? "did " : "cancelled after ";
  appendCount(done, "step", response.message);
  if (done == steps) return;
  response.message += " of ";
  append(steps, response.message);
}

void Handlers::relax(const Relax::Request& request, Answer<Relax>& answer,
                     core::RelaxFollower* follower) {
  const auto begin = Clock::now();
  auto& response = answer.response;
  core::RelaxationOptions options;
  options.method = core::relaxationMethod(request.method);
  options.tolerance = request.tolerance;
  options.max_time = request.max_time;
  options.keep_orientation = request.keep_orientation;
  options.starts = std::max(request.starts, 1u);
  options.seed = request.seed;
  if (request.starts > 0 && options.method != core::RelaxationMethod::global) {
    throw std::invalid_argument("starts is " + std::to_string(request.starts) +
                                "; allowed: 0, as only the method global starts several times");
  }
  answer.reserve(kMessageRoom);
  news_.statusChanged();
  const auto result = runner_.relax(options, follower);
  news_.sceneChanged();
  response.converged = result.converged;
  response.iterations = result.iterations;
  response.wall_time = secondsSince(begin);
  response.energy_before = result.energy_before;
  response.energy_after = result.energy_after;
  response.max_torque = result.max_torque;
  response.free_rotations = result.free_rotations;
  response.mirror_ambiguous = result.mirror_ambiguous;
  response.rms_strain = result.rms_strain;
  response.message.assign(result.message, 0, kMessageRoom);
  news_.relaxed(result.converged ? std::string_view() : response.message);
  news_.tell(response.message, "relax: ");
}

void Handlers::cancel(const std_srvs::Trigger::Request&, Answer<std_srvs::Trigger>& answer) {
  answer.reserve(kMessageRoom);
  const bool maps = mappings_.cancel();
  answer.response.message = runner_.cancel() || maps ? "cancelling" : "nothing was under way";
}

}  // namespace spherical_springs
