#include "springs_node.h"

#include <ros/master.h>
#include <ros/service.h>
#include <ros/spinner.h>
#include <spherical_springs/AddParticles.h>
#include <spherical_springs/AddSprings.h>
#include <spherical_springs/GetScene.h>
#include <spherical_springs/Relax.h>
#include <spherical_springs/Status.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <cmath>
#include <iostream>
#include <stdexcept>
#include <thread>

#include "interruption.h"
#include "progress_line.h"

namespace spherical_springs::relax_mesh {
namespace {

constexpr double kPatience = 10;     // for a node that is about to start [s]
constexpr double kPrecision = 1e-6;  // of the areas' shares

AddParticles::Request particles(const Points& positions) {
  AddParticles::Request request;
  request.particles.resize(positions.cols());
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    auto& position = request.particles[i].position;
    position.x = positions(0, i);
    position.y = positions(1, i);
    position.z = positions(2, i);
  }
  return request;
}

/// A spring that holds 1/2 J where its angle, or solid angle, is off by all of `rest`.
double stiffnessAt(double rest) { return 1 / (rest * rest); }

/// `ids`: of the vertices. Each edge of a closed surface rises in one of its two faces.
AddSprings::Request springs(const Network& network, const std::vector<std::uint32_t>& ids) {
  AddSprings::Request request;
  for (Eigen::Index f = 0; f < network.faces.cols(); ++f) {
    const auto face = network.faces.col(f);
    SolidAngleSpring area;
    area.particles = {ids[face[0]], ids[face[1]], ids[face[2]]};
    area.rest_solid_angle = network.rests[f];
    area.stiffness = stiffnessAt(area.rest_solid_angle);
    request.solid_angle_springs.push_back(area);
    for (int i = 0; i < 3; ++i) {
      const auto from = face[i], to = face[(i + 1) % 3];
      if (from > to) continue;
      AngleSpring arc;
      arc.particles = {ids[from], ids[to]};
      arc.rest_angle = core::arc(network.start.col(from), network.start.col(to)).angle;
      arc.stiffness = network.arc_weight * stiffnessAt(arc.rest_angle);
      request.angle_springs.push_back(arc);
    }
  }
  return request;
}

/// [N m]; a face of the mean size that is off by this share turns its vertices so.
double torqueOf(double share, const Network& network) {
  return share * std::sqrt(network.faces.cols() / (4 * core::kPi));
}

Points positionsOf(const GetScene::Response& scene) {
  Points result(3, scene.particles.size());
  for (Eigen::Index i = 0; i < result.cols(); ++i) {
    const auto& position = scene.particles[i].position;
    result.col(i) << position.x, position.y, position.z;
  }
  return result;
}

/// As long as it lives, an interruption is passed on to the node, which is at work elsewhere.
class CancelOnInterruption {
 public:
  explicit CancelOnInterruption(const std::string& service)
      : thread_([this, service] {
          for (; !over_; ros::WallDuration(0.02).sleep()) {
            std_srvs::Trigger cancel;
            if (interrupted()) ros::service::call(service, cancel);
          }
        }) {}
  ~CancelOnInterruption() {
    over_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> over_{false};
  std::thread thread_;
};

/// As long as it lives, what the node says of its relaxation is shown.
class ShowProgress {
 public:
  explicit ShowProgress(const std::string& topic)
      : status_(node_.subscribe<Status>(topic, 1, [this](const Status::ConstPtr& status) {
          if (status->state == "relaxing") line_.show(status->relax_progress);
        })) {
    spinner_.start();
  }
  ~ShowProgress() { spinner_.stop(); }

 private:
  ros::NodeHandle node_;
  ProgressLine line_{"relaxing"};
  ros::Subscriber status_;
  ros::AsyncSpinner spinner_{1};
};

/// `name`: resolved.
std::string howToStart(const std::string& name) {
  const auto slash = name.rfind('/');
  const std::string space = slash == 0 ? "" : "ROS_NAMESPACE=" + name.substr(0, slash) + " ";
  return "; start one: " + space +
         "roslaunch spherical_springs spherical_springs.launch running:=false name:=" +
         name.substr(slash + 1);
}

}  // namespace

SpringsNode::SpringsNode(const std::string& name) : name_(ros::names::resolve(name)) {
  const std::string remedy = howToStart(name_);
  // Without a master every other call of ROS would wait for one, for ever.
  if (!ros::master::check()) {
    throw std::runtime_error("no ROS master answers at " + ros::master::getURI() + remedy);
  }
  ros::start();
  const auto deadline = ros::WallTime::now() + ros::WallDuration(kPatience);
  while (!ros::service::exists(name_ + "/relax", false)) {
    throwIfInterrupted();
    if (ros::WallTime::now() > deadline) {
      throw std::runtime_error("no node " + name_ + " answers" + remedy);
    }
    ros::WallDuration(0.02).sleep();
  }
}

template <class Service>
typename Service::Response SpringsNode::call(const char* service,
                                             const typename Service::Request& request) {
  typename Service::Response response;
  const std::string full_name = name_ + "/" + service;
  auto to_send = request;
  if (!ros::service::call(full_name, to_send, response)) {
    throwIfInterrupted();
    throw std::runtime_error(full_name + " does not answer");
  }
  if (!response.success) throw std::runtime_error(full_name + ": " + response.message);
  return response;
}

Points SpringsNode::relax(const Network& network, double max_time) {
  std_srvs::SetBool::Request pause;
  pause.data = false;
  call<std_srvs::SetBool>("set_running", pause);
  std::cout << name_ << ": " << call<std_srvs::Trigger>("clear").message << std::endl;
  const auto ids = call<AddParticles>("add_particles", particles(network.start)).ids;
  call<AddSprings>("add_springs", springs(network, ids));
  Relax::Request request;
  request.keep_orientation = true;
  request.max_time = max_time;
  request.tolerance = torqueOf(kPrecision, network);
  const auto relaxed = [&] {
    const ShowProgress progress(name_ + "/status");
    const CancelOnInterruption cancel(name_ + "/cancel");
    return call<Relax>("relax", request);
  }();
  throwIfInterrupted();
  std::cout << name_ << ": " << relaxed.message << std::endl;
  const auto scene = call<GetScene>("get_scene");
  if (scene.particle_ids != ids) {
    throw std::runtime_error("another client has changed the scene of " + name_ +
                             " meanwhile; relax_mesh needs a node to itself");
  }
  return positionsOf(scene);
}

}  // namespace spherical_springs::relax_mesh
