#pragma once

#include <ros/node_handle.h>

#include <string>

#include "spherical_springs/simulation.h"

namespace spherical_springs {

/// The parameters that may change while the node runs, with their defaults.
struct Pace {
  static constexpr double kLongestTimeStep = 1e6;  // [s]

  double time_step = 0.001;           ///< [s]
  std::string integrator = "verlet";  ///< as core::integrationMethod has it
  double real_time_factor = 1;        ///< simulated time / time of the clock
  double publish_rate = 30;           ///< of poses, energies and markers [Hz]
  bool running = true;                ///< whether time goes on

  /// Calls `visit(name, field, accepted, allowed in words)` for each field of `pace`.
  template <class PaceOrConst, class Visitor>
  static void forEachField(PaceOrConst& pace, const Visitor& visit);

  /// @throw std::invalid_argument naming the parameter, its value and what is allowed.
  void requireValid() const;
};

/// The node's parameters, with their defaults.
struct Parameters : Pace {
  std::string frame_id = "map";             ///< of poses, energies and markers
  double radius = 1;                        ///< of the published poses and markers [m]
  std::string scene;                        ///< a file to load at start; empty: none
  int threads = 0;                          ///< 0: core::availableThreads()
  std::string spring_damping = "relative";  ///< "relative", "own"
  int max_particles = 20'000'000;
  int max_springs = 100'000'000;
  std::string scene_directory = "~/.ros/spherical_springs";  ///< of files named in services

  /// Reads what is set under `node`.
  /// @throw std::invalid_argument naming the parameter, its value and what is allowed.
  static Parameters from(const ros::NodeHandle& node);

  core::Simulation::Settings simulation() const;
};

}  // namespace spherical_springs
