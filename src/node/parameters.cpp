#include "node/parameters.h"

#include <sstream>
#include <stdexcept>

#include "base/available_threads.h"

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

[[noreturn]] void refuse(const std::string& name, const XmlRpc::XmlRpcValue& value,
                         const std::string& allowed) {
  throw std::invalid_argument("parameter ~" + name + " is " + inWords(value) +
                              "; allowed: " + allowed);
}

// A whole number will do for a real one, but nothing else is taken for something else.
bool isOf(const XmlRpc::XmlRpcValue& raw, double) {
  return raw.getType() == Type::TypeDouble || raw.getType() == Type::TypeInt;
}
bool isOf(const XmlRpc::XmlRpcValue& raw, int) { return raw.getType() == Type::TypeInt; }
bool isOf(const XmlRpc::XmlRpcValue& raw, bool) { return raw.getType() == Type::TypeBoolean; }
bool isOf(const XmlRpc::XmlRpcValue& raw, const std::string&) {
  return raw.getType() == Type::TypeString;
}

/// Reads one parameter, if it is set; `allowed` says which values `accept` takes.
template <class Value, class Accept>
void read(const ros::NodeHandle& node, const std::string& name, Value& value,
          const std::string& allowed, const Accept& accept) {
  XmlRpc::XmlRpcValue raw;
  if (!node.getParam(name, raw)) return;
  if (!isOf(raw, value) || !node.getParam(name, value) || !accept(value)) {
    refuse(name, raw, allowed);
  }
}

void read(const ros::NodeHandle& node, const std::string& name, double& value,
          const core::Range& range) {
  read(node, name, value, range.allowed, [&](double v) { return range.contains(v); });
}

void read(const ros::NodeHandle& node, const std::string& name, int& value, int low, int high) {
  read(node, name, value,
       "whole numbers from " + std::to_string(low) + " to " + std::to_string(high),
       [&](int v) { return low <= v && v <= high; });
}

void read(const ros::NodeHandle& node, const std::string& name, std::string& value,
          const std::vector<std::string>& choices) {
  std::string allowed;
  for (const std::string& choice : choices) allowed += (allowed.empty() ? "" : ", ") + choice;
  read(node, name, value, allowed, [&](const std::string& v) {
    return std::find(choices.begin(), choices.end(), v) != choices.end();
  });
}

}  // namespace

Parameters Parameters::from(const ros::NodeHandle& node) {
  const auto anyText = [](const std::string&) { return true; };
  const auto someText = [](const std::string& text) { return !text.empty(); };
  Parameters p;
  read(node, "time_step", p.time_step, core::Range{1e-12, kLongestTimeStep, "1e-12 to 1e6 [s]"});
  read(node, "integrator", p.integrator, {"euler", "verlet", "fourth_order", "implicit_euler"});
  read(node, "publish_rate", p.publish_rate, core::Range{1e-3, 1e4, "0.001 to 10000 [Hz]"});
  read(node, "real_time_factor", p.real_time_factor, core::Range{1e-6, 1e6, "1e-6 to 1e6"});
  read(node, "running", p.running, "true, false", [](bool) { return true; });
  read(node, "frame_id", p.frame_id, "a name that is not empty", someText);
  read(node, "radius", p.radius, core::Range{1e-6, 1e6, "1e-6 to 1e6 [m]"});
  read(node, "scene", p.scene, "the path of a file", anyText);
  read(node, "threads", p.threads, 0, 256);
  read(node, "spring_damping", p.spring_damping, {"relative", "own"});
  read(node, "max_particles", p.max_particles, 0,
       static_cast<int>(core::SceneLimits::kMostParticles));
  read(node, "max_springs", p.max_springs, 0, static_cast<int>(core::SceneLimits::kMostSprings));
  read(node, "scene_directory", p.scene_directory, "the path of a directory", someText);
  return p;
}

core::Simulation::Settings Parameters::simulation() const {
  core::Simulation::Settings settings;
  settings.method = core::integrationMethod(integrator);
  settings.time_step = time_step;
  settings.system.spring_damping =
      spring_damping == "own" ? core::SpringDamping::own : core::SpringDamping::relative;
  settings.system.threads = threads > 0 ? threads : core::availableThreads();
  settings.limits.particles = max_particles;
  settings.limits.springs = max_springs;
  return settings;
}

}  // namespace spherical_springs
