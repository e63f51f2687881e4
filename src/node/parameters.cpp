#include "node/parameters.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "base/available_threads.h"
#include "node/parameter_values.h"
#include "node/unknown_parameters.h"
#include "spherical_springs/range.h"

namespace spherical_springs {
namespace {

using Type = XmlRpc::XmlRpcValue::Type;

std::string inWords(const XmlRpc::XmlRpcValue& value) {
  if (value.getType() == Type::TypeBoolean) {
    return value == XmlRpc::XmlRpcValue(true) ? "true" : "false";
  }
  std::ostringstream text;
  value.write(text);
  return value.getType() == Type::TypeString ? core::quoted(text.str())
                                             : core::shortened(text.str());
}

std::string faultOf(const std::string& name, const std::string& value, const std::string& allowed) {
  return "parameter ~" + name + " is " + value + "; allowed: " + allowed;
}

/// Reads one parameter, if it is set.
template <class Value>
void read(const ros::NodeHandle& node, const std::string& name, const Allowed<Value>& allowed,
          Value& value) {
  XmlRpc::XmlRpcValue raw;
  if (!node.getParam(name, raw)) return;
  const std::optional<Value> taken = valueIn<Value>(raw);
  if (!taken || !allowed.contains(*taken)) {
    const std::string type_fault = taken ? "" : typeFault<Value>(raw);
    throw std::invalid_argument(faultOf(name, inWords(raw) + type_fault, allowed.words));
  }
  value = *taken;
}

Allowed<double> inside(const core::Range& range) {
  return {range.allowed, [range](double v) { return range.contains(v); }};
}

Allowed<int> wholeNumbers(int low, int high) {
  return {"whole numbers from " + std::to_string(low) + " to " + std::to_string(high),
          [=](int v) { return low <= v && v <= high; }};
}

Allowed<std::string> oneOf(const std::vector<std::string>& choices) {
  std::string words;
  for (const std::string& choice : choices) words += (words.empty() ? "" : ", ") + choice;
  return {words, [choices](const std::string& v) {
            return std::find(choices.begin(), choices.end(), v) != choices.end();
          }};
}

Allowed<std::string> anyText(const char* words) {
  return {words, [](const std::string&) { return true; }};
}

Allowed<std::string> someText(const char* words) {
  return {words, [](const std::string& text) { return !text.empty(); }};
}

Allowed<std::string> frameName() {
  return {"a name that is not empty",
          [](const std::string& name) { return name.find_first_not_of('/') != std::string::npos; }};
}

constexpr const char* kAutomatic = "automatic";

/// The values of `Pace` that are allowed, at start and while the node runs.
struct AllowedPace {
  Allowed<double> time_step =
      inside({core::StepWish::kShortest, core::StepWish::kLongest, "1e-12 to 1e6 [s]"});
  Allowed<std::string> integrator =
      oneOf({"euler", "verlet", "fourth_order", "implicit_euler", kAutomatic});
  Allowed<double> accuracy = inside({0, 1e6, "0 (off) to 1e6 [rad/s]"});
  Allowed<double> real_time_factor = inside({1e-6, 1e6, "1e-6 to 1e6"});
  Allowed<double> publish_rate = inside({1e-3, 1e4, "0.001 to 10000 [Hz]"});
  Allowed<bool> running = {"true, false", [](bool) { return true; }};
};

/// @throw std::invalid_argument where no accuracy says which integrator to choose.
void requireAccuracyIfAutomatic(const Pace& pace) {
  if (pace.integrator != kAutomatic || pace.accuracy > 0) return;
  throw std::invalid_argument(
      "parameter ~integrator is 'automatic' while ~accuracy is 0; allowed: 'automatic' with an "
      "~accuracy above 0 [rad/s], or one of the other integrators");
}

bool isNonFinite(double value) { return !std::isfinite(value); }
bool isNonFinite(const std::string&) { return false; }

}  // namespace

void Pace::requireValid() const {
  const AllowedPace allowed;
  forEachField(
      [](const char* name, const auto& rule, const auto& value) {
        if (rule.contains(value)) return;
        const std::string fault = faultOf(name, inWords(XmlRpc::XmlRpcValue(value)), rule.words);
        if (isNonFinite(value)) throw core::NonFinite(fault);
        throw std::invalid_argument(fault);
      },
      allowed, *this);
  requireAccuracyIfAutomatic(*this);
}

core::StepWish Pace::stepWish() const {
  core::StepWish wish;
  wish.chooses_method = integrator == kAutomatic;
  if (!wish.chooses_method) wish.method = core::integrationMethod(integrator);
  wish.time_step = time_step;
  wish.accuracy = accuracy;
  return wish;
}

std::string Pace::differenceFrom(const Pace& other) const {
  std::string words;
  forEachField(
      [&](const char* name, const auto& value, const auto& other_value) {
        if (value == other_value) return;
        words += words.empty() ? "" : ", ";
        words += std::string("~") + name + " is " + inWords(XmlRpc::XmlRpcValue(value));
      },
      *this, other);
  return words;
}

std::string directoryOfRos() {
  const char* directory = std::getenv("ROS_HOME");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  return directory != nullptr && *directory != '\0' ? directory : "~/.ros";
}

Parameters Parameters::from(const ros::NodeHandle& node) {
  std::vector<std::string> names;
  const auto readField = [&](const char* name, const auto& allowed, auto& value) {
    read(node, name, allowed, value);
    names.emplace_back(name);
  };
  Parameters p;
  const AllowedPace allowed;
  forEachField(readField, allowed, p);
  requireAccuracyIfAutomatic(p);
  readField("frame_id", frameName(), p.frame_id);
  readField("radius", inside({1e-6, 1e6, "1e-6 to 1e6 [m]"}), p.radius);
  readField("scene", anyText("the path of a file"), p.scene);
  readField("threads", wholeNumbers(0, 256), p.threads);
  readField("spring_damping", oneOf({"relative", "own"}), p.spring_damping);
  readField("max_particles", wholeNumbers(0, core::SceneLimits::kMostParticles), p.max_particles);
  readField("max_springs", wholeNumbers(0, core::SceneLimits::kMostSprings), p.max_springs);
  readField("scene_directory", someText("the path of a directory"), p.scene_directory);
  warnOfUnknownParameters(node, names);
  p.frame_id.erase(0, p.frame_id.find_first_not_of('/'));  // frames of tf2 begin with no slash
  return p;
}

core::Simulation::Settings Parameters::simulation() const {
  core::Simulation::Settings settings;
  static_cast<core::StepWish&>(settings) = stepWish();
  settings.system.spring_damping =
      spring_damping == "own" ? core::SpringDamping::own : core::SpringDamping::relative;
  settings.system.threads = threads > 0 ? threads : core::availableThreads();
  settings.limits.particles = max_particles;
  settings.limits.springs = max_springs;
  return settings;
}

}  // namespace spherical_springs
