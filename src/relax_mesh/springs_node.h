// The node as relax_mesh calls it.
#pragma once

#include <ros/node_handle.h>

#include <string>

#include "spherical_springs/mesh/triangle_mesh.h"

namespace spherical_springs::relax_mesh {

using core::Points;

/// A surface on the sphere as springs, each of which holds 1/2 J where it is off by all of its
/// rest: a solid-angle spring a face, and an angle spring an edge, at rest at the start.
struct Network {
  const Points& start;  ///< one unit vector a vertex
  const mesh::Faces& faces;
  const Eigen::VectorXd& rests;  ///< one a face [sr]
  double arc_weight;             ///< of the angle springs beside the others, above 0
};

class SpringsNode {
 public:
  /// @throw std::runtime_error where no master or no node of that name answers in time.
  explicit SpringsNode(const std::string& name);

  /// Relaxes the network in place of the scene that the node has, without folds, and returns where
  /// its vertices come to. The node is left paused.
  /// @param max_time wall [s]
  /// @throw std::runtime_error for a call that fails or is refused, with the node's reason, after
  /// an interruption, and where the scene at the end is not the one that was sent.
  Points relax(const Network& network, double max_time);

 private:
  template <class Service>
  typename Service::Response call(const char* service,
                                  const typename Service::Request& request = {});

  const std::string name_;
};

}  // namespace spherical_springs::relax_mesh
