#include "relax_mesh/map_by_node.h"

#include <actionlib/client/action_client.h>
#include <ros/callback_queue.h>
#include <ros/init.h>
#include <ros/master.h>
#include <spherical_springs/MapMeshAction.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "relax_mesh/interruption.h"
#include "relax_mesh/progress_line.h"
#include "spherical_springs/range.h"

namespace spherical_springs::relax_mesh {
namespace {

/// `name`: resolved.
std::string howToStart(const std::string& name) {
  const auto slash = name.rfind('/');
  const std::string space = slash == 0 ? "" : "ROS_NAMESPACE=" + name.substr(0, slash) + " ";
  return "; start one: " + space +
         "roslaunch spherical_springs spherical_springs.launch running:=false name:=" +
         name.substr(slash + 1);
}

std::vector<geometry_msgs::Point> messagesOf(const Points& points) {
  std::vector<geometry_msgs::Point> messages(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    messages[i].x = points(0, i);
    messages[i].y = points(1, i);
    messages[i].z = points(2, i);
  }
  return messages;
}

MapMeshGoal goalOf(const Task& task, const Options& options) {
  MapMeshGoal goal;
  goal.mesh.vertices = messagesOf(task.surface.vertices);
  goal.mesh.triangles.resize(task.surface.faces.cols());
  for (Eigen::Index f = 0; f < task.surface.faces.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      goal.mesh.triangles[f].vertex_indices[k] =
          static_cast<std::uint32_t>(task.surface.faces(k, f));
    }
  }
  if (task.start) goal.start = messagesOf(*task.start);
  goal.density.assign(task.density.data(), task.density.data() + task.density.size());
  goal.spread = options.spread;
  goal.max_time = timeFor(task, options);
  goal.angle_weight = options.angle_weight;
  goal.load = options.load;
  return goal;
}

/// The action of a node, called back on the thread of its user alone.
class MapAction {
 public:
  explicit MapAction(const std::string& node)
      : node_(node),
        handle_(handleWith(queue_)),
        client_(handle_, node + "/map_mesh", &queue_),
        status_(handle_.subscribe<actionlib_msgs::GoalStatusArray>(
            node + "/map_mesh/status", 1, [this](const auto&) { heard(); })) {
    constexpr double kStart = 10;  // for a node that is about to start [s]
    heard();
    while (!client_.isServerConnected()) {
      throwIfInterrupted();
      if (sinceHeard() > kStart) {
        throw std::runtime_error("no node " + node_ + " answers" + howToStart(node_));
      }
      queue_.callAvailable(kPatience);
    }
  }

  /// Nothing where the result is lost on the way.
  MapMeshResultConstPtr resultOf(const MapMeshGoal& goal) {
    constexpr double kOnTheWay = 30;  // [s]
    ProgressLine line;
    auto handle =
        client_.sendGoal(goal, {}, [&](const auto&, const MapMeshFeedbackConstPtr& feedback) {
          line.show({feedback->progress, feedback->spread > 0
                                             ? feedback->spread
                                             : std::numeric_limits<double>::infinity()});
        });
    heard();
    bool cancelled = false;
    ros::WallTime working = heard_;
    while (handle.getCommState() != actionlib::CommState::DONE) {
      if (handle.getCommState() != actionlib::CommState::WAITING_FOR_RESULT) working = heard_;
      if ((heard_ - working).toSec() > kOnTheWay) return nullptr;
      if (interrupted() && !cancelled) {
        handle.cancel();
        cancelled = true;
      }
      requireAlive();
      queue_.callAvailable(kPatience);
    }
    return handle.getResult();
  }

 private:
  const ros::WallDuration kPatience{0.02};

  static ros::NodeHandle handleWith(ros::CallbackQueue& queue) {
    ros::NodeHandle handle;
    handle.setCallbackQueue(&queue);
    return handle;
  }

  void heard() { heard_ = ros::WallTime::now(); }
  double sinceHeard() const { return (ros::WallTime::now() - heard_).toSec(); }

  /// A node that lives sends the states of goals several times a second.
  void requireAlive() {
    constexpr double kSilence = 30;  // [s]
    if (!ros::ok()) throw std::runtime_error("ROS has been shut down");
    if (!client_.isServerConnected()) throw std::runtime_error(node_ + " has ended");
    if (sinceHeard() > kSilence) throw std::runtime_error(node_ + " does not answer");
  }

  const std::string node_;
  ros::WallTime heard_;  // from the node, last
  ros::CallbackQueue queue_;
  ros::NodeHandle handle_;
  actionlib::ActionClient<MapMeshAction> client_;
  ros::Subscriber status_;
};

Points pointsOf(const MapMeshResult& result) {
  Points points(3, static_cast<Eigen::Index>(result.sphere.size()));
  for (std::size_t i = 0; i < result.sphere.size(); ++i) {
    const auto& point = result.sphere[i];
    points.col(static_cast<Eigen::Index>(i)) << point.x, point.y, point.z;
  }
  return points;
}

bool areUnitVectors(const Points& points, Eigen::Index count) {
  constexpr double kRounding = 1e-9;
  return points.cols() == count && ((points.colwise().norm().array() - 1).abs() < kRounding).all();
}

/// @throw std::runtime_error where the points are no map of the mesh.
mesh::MeshMap mapOf(const Task& task, Points points, const std::string& node) {
  mesh::MeshMap map;
  map.points = std::move(points);
  if (areUnitVectors(map.points, task.surface.vertices.cols())) {
    map.faces = mesh::faceDistortion(task.surface, task.shares, map.points);
    map.distortion = summary(map.faces);
    if (coversOnce(map.distortion)) return map;
  }
  throw std::runtime_error(node + " has answered no map");
}

}  // namespace

mesh::MeshMap mapByNode(const Task& task, const Options& options) {
  const std::string node = ros::names::resolve(options.node);
  // Without a master every other call of ROS would wait for one, for ever.
  if (!ros::master::check()) {
    throw std::runtime_error("no ROS master answers at " + ros::master::getURI() +
                             howToStart(node));
  }
  ros::start();
  const auto result = MapAction(node).resultOf(goalOf(task, options));
  if (!result) throw std::runtime_error(node + " has lost its result; its log may tell why");
  if (result->sphere.empty()) {
    throwIfInterrupted();
    throw std::runtime_error(node + ": " + result->message);
  }
  mesh::MeshMap map = mapOf(task, pointsOf(*result), node);
  if (interrupted()) map.end = mesh::MapEnd::told;
  // A map that could not be loaded is one all the same.
  (result->success ? std::cout : std::cerr << "warning: ")
      << node << ": " << core::onOneLine(result->message) << std::endl;
  return map;
}

}  // namespace spherical_springs::relax_mesh
