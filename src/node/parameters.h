#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <string>

#include "spherical_springs/simulation.h"

namespace spherical_springs {

/// Values that a parameter may have.
template <class Value>
struct Allowed {
  std::string words;  ///< for messages
  std::function<bool(const Value&)> contains;
};

/// The parameters that may change while the node runs, with their defaults.
struct Pace {
  double time_step = 0.001;           ///< [s]; above an accuracy of 0, the one that it chose
  std::string integrator = "verlet";  ///< as core::integrationMethod has it, or "automatic"
  double accuracy = 0;                ///< error per simulated second [rad/s]; 0: off
  double real_time_factor = 1;        ///< simulated time / time of the clock
  double publish_rate = 30;           ///< of poses, energies and markers [Hz]
  bool running = true;                ///< whether time goes on

  /// Calls `visit(name, fields...)` for each parameter, with the field of that name of each holder.
  template <class Visitor, class... Holders>
  static void forEachField(const Visitor& visit, Holders&... holders) {
    visit("time_step", holders.time_step...);
    visit("integrator", holders.integrator...);
    visit("accuracy", holders.accuracy...);
    visit("real_time_factor", holders.real_time_factor...);
    visit("publish_rate", holders.publish_rate...);
    visit("running", holders.running...);
  }

  /// @throw std::invalid_argument naming the parameter, its value and what is allowed; a
  /// core::NonFinite where the value is a number that is not finite.
  void requireValid() const;

  /// Returns how the simulation is to step.
  core::StepWish stepWish() const;

  /// Names each parameter that differs from `other`, and its value here; empty where none does.
  std::string differenceFrom(const Pace& other) const;
};

/// Returns the directory in which ROS keeps files: $ROS_HOME, or ~/.ros.
std::string directoryOfRos();

/// The node's parameters, with their defaults.
struct Parameters : Pace {
  std::string frame_id = "map";             ///< of poses, energies and markers
  double radius = 1;                        ///< of the published poses and markers [m]
  std::string scene;                        ///< a file to load at start; empty: none
  int threads = 0;                          ///< 0: core::availableThreads()
  std::string spring_damping = "relative";  ///< "relative", "own"
  int max_particles = 20'000'000;
  int max_springs = 100'000'000;
  std::string scene_directory = directoryOfRos() + "/spherical_springs";  ///< of files of services

  /// Reads what is set under `node`.
  /// @throw std::invalid_argument as `requireValid` does, for every parameter.
  static Parameters from(const ros::NodeHandle& node);

  core::Simulation::Settings simulation() const;
};

}  // namespace spherical_springs
