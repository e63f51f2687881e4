// The node as relax_mesh calls it.
#pragma once

#include <ros/service_client.h>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "relax_mesh/network.h"

namespace spherical_springs::relax_mesh {

/// Says that somebody else works with the scene of a node.
struct OtherClient : std::runtime_error {
  explicit OtherClient(const std::string& node)
      : std::runtime_error("another client has changed the scene of " + node +
                           " meanwhile; relax_mesh needs a node to itself") {}
};

/// Has a node relax a network in the place of its scene. Where that fails, the node's scene ends as
/// it was before, or as the whole network.
class SpringsNode {
 public:
  /// Waits for the node, and looks at its scene, which is the one that may be replaced.
  /// @throw Interrupted; std::runtime_error where no master or no node of that name answers in
  /// time.
  explicit SpringsNode(const std::string& name);

  const std::string& name() const { return name_; }

  /// Returns the lines in which the node has said what it did with its scene and the network.
  const std::vector<std::string>& said() const { return said_; }

  /// Whether the node relaxed for another client when it was looked at.
  bool wasBusy() const { return was_busy_; }

  /// @throw std::runtime_error where the node's limits leave no room for so much beside its scene.
  void requireRoomFor(std::size_t particles, std::size_t springs) const;

  /// Relaxes the network without folds, and returns where its vertices come to. The node is left
  /// paused. A node that has been started again is waited for, and used.
  /// @param max_time wall [s]
  /// @throw Interrupted; OtherClient where the scene is not the one that was looked at, or does not
  /// stay the one that was sent; std::runtime_error for a call that fails or is refused, with the
  /// node's reason.
  Points relax(const Network& network, double max_time);

 private:
  template <class Service>
  typename Service::Response call(const char* service,
                                  const typename Service::Request& request = {}) const;
  void waitUntilThere() const;
  void look();
  Ids sceneIds() const;
  void setRunning(bool running) const;
  Points relaxOnce(const Network& network, double max_time);
  Points positionsOf(const Ids& own) const;
  Ids replaceScene(const Network& network);
  void removeOthers(const Ids& own);
  void withdraw(const Ids& own) const;

  const std::string name_;
  std::vector<std::string> said_;
  double patience_ = 30;     // for an answer that takes no work [s]
  ros::ServiceClient link_;  // breaks when the node that was looked at ends
  Ids known_;                // of the particles of the scene that may be replaced
  std::size_t known_springs_ = 0;
  bool was_running_ = false, was_busy_ = false;
};

}  // namespace spherical_springs::relax_mesh
