#include "relax_mesh/springs_node.h"

#include <ros/callback_queue.h>
#include <ros/master.h>
#include <ros/param.h>
#include <ros/service.h>
#include <ros/spinner.h>
#include <spherical_springs/GetScene.h>
#include <spherical_springs/Relax.h>
#include <spherical_springs/RemoveParticles.h>
#include <spherical_springs/Status.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <algorithm>
#include <iostream>
#include <iterator>

#include "node/kinds.h"
#include "relax_mesh/interruption.h"
#include "relax_mesh/progress_line.h"
#include "relax_mesh/service_call.h"
#include "spherical_springs/range.h"

namespace spherical_springs::relax_mesh {
namespace {

constexpr double kStart = 10;        // for a node that is about to start [s]
constexpr double kStatus = 10;       // for the status, which a node that lives sends at once [s]
constexpr double kPrecision = 1e-6;  // of the areas' shares

const ros::WallDuration kBetweenLooks(0.02);

/// For one look after another, until a time has gone by.
class Deadline {
 public:
  explicit Deadline(double seconds) : end_(ros::WallTime::now() + ros::WallDuration(seconds)) {}
  bool isOver() const { return ros::WallTime::now() > end_; }

 private:
  ros::WallTime end_;
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

/// "running", "paused" or "relaxing"; an empty text where the node says nothing in time.
std::string stateOf(const std::string& node) {
  ros::CallbackQueue queue;
  ros::NodeHandle handle;
  handle.setCallbackQueue(&queue);
  std::string state;
  const ros::Subscriber status = handle.subscribe<Status>(
      node + "/status", 1, [&](const Status::ConstPtr& message) { state = message->state; });
  for (const Deadline deadline(kStatus); state.empty() && !deadline.isOver();) {
    queue.callAvailable(kBetweenLooks);
  }
  return state;
}

/// `name`: resolved.
std::string howToStart(const std::string& name) {
  const auto slash = name.rfind('/');
  const std::string space = slash == 0 ? "" : "ROS_NAMESPACE=" + name.substr(0, slash) + " ";
  return "; start one: " + space +
         "roslaunch spherical_springs spherical_springs.launch running:=false name:=" +
         name.substr(slash + 1);
}

/// `limit`: the parameter, which is set where it is not the node's default, above any mesh's need.
void requireRoom(const std::string& node, const std::string& limit, const std::string& items,
                 std::size_t present, std::size_t further) {
  int most;
  if (!ros::param::get(node + "/" + limit, most)) return;
  if (present + further <= static_cast<std::size_t>(most)) return;
  const std::string has =
      present > 0 ? " and has " + std::to_string(present) + " until the map replaces them" : "";
  const std::string remedy = present > 0 ? ", or clear its scene" : "";
  throw std::runtime_error(node + " takes " + std::to_string(most) + " " + items + has +
                           "; the map needs " + std::to_string(further) +
                           "; start the node with a larger ~" + limit + remedy);
}

/// The ids of one rising list that are not in another.
Ids without(const Ids& all, const Ids& some) {
  Ids rest;
  std::set_difference(all.begin(), all.end(), some.begin(), some.end(), std::back_inserter(rest));
  return rest;
}

}  // namespace

SpringsNode::SpringsNode(const std::string& name) : name_(ros::names::resolve(name)) {
  // Without a master every other call of ROS would wait for one, for ever.
  if (!ros::master::check()) {
    throw std::runtime_error("no ROS master answers at " + ros::master::getURI() +
                             howToStart(name_));
  }
  ros::start();
  waitUntilThere();
  look();
}

void SpringsNode::waitUntilThere() const {
  const Deadline deadline(kStart);
  while (!ros::service::exists(name_ + "/relax", false)) {
    throwIfInterrupted();
    if (!ros::ok()) throw std::runtime_error("ROS has been shut down");
    if (deadline.isOver()) {
      throw std::runtime_error("no node " + name_ + " answers" + howToStart(name_));
    }
    kBetweenLooks.sleep();
  }
}

template <class Service>
typename Service::Response SpringsNode::call(const char* service,
                                             const typename Service::Request& request) const {
  Patience patience;
  patience.seconds = patience_;
  return callService<Service>(name_ + "/" + service, request, patience);
}

void SpringsNode::look() {
  constexpr bool kPersistent = true;
  link_ = ros::NodeHandle().serviceClient<GetScene>(name_ + "/get_scene", kPersistent);
  const auto scene = call<GetScene>("get_scene");
  known_ = scene.particle_ids;
  known_springs_ = springIdCount(scene);
  const std::string state = stateOf(name_);
  was_running_ = state == "running";
  was_busy_ = state == "relaxing";
}

void SpringsNode::requireRoomFor(std::size_t particles, std::size_t springs) const {
  requireRoom(name_, "max_particles", "particles", known_.size(), particles);
  requireRoom(name_, "max_springs", "springs", known_springs_, springs);
}

Points SpringsNode::relax(const Network& network, double max_time) {
  constexpr double kPerFace = 1e-4;  // some 30 times what a node takes [s]
  patience_ += kPerFace * static_cast<double>(network.faces.cols());
  for (bool again = false;; again = true) {
    try {
      waitUntilThere();
      if (!link_.isValid()) look();
      return relaxOnce(network, max_time);
    } catch (const NoAnswer&) {
      throwIfInterrupted();
      if (again || link_.isValid()) throw;
    }
  }
}

Points SpringsNode::relaxOnce(const Network& network, double max_time) {
  const Ids own = replaceScene(network);
  Relax::Request request;
  request.keep_orientation = true;
  request.max_time = max_time;
  request.tolerance = torqueOf(kPrecision, network);
  Patience patience;
  patience.seconds = patience_ + max_time;
  patience.on_interruption = [&] {
    try {
      call<std_srvs::Trigger>("cancel");
    } catch (const std::exception&) {  // the relaxation may have ended
    }
  };
  const auto relaxed = [&] {
    const ShowProgress progress(name_ + "/status");
    return callService<Relax>(name_ + "/relax", request, patience);
  }();
  throwIfInterrupted();
  said_.push_back(relaxed.message);
  return positionsOf(own);
}

Points SpringsNode::positionsOf(const Ids& own) const {
  const auto scene = call<GetScene>("get_scene");
  if (!without(own, scene.particle_ids).empty()) throw OtherClient(name_);
  Points result(3, static_cast<Eigen::Index>(own.size()));
  std::size_t place = 0;
  for (std::size_t i = 0; i < own.size(); ++i, ++place) {
    while (scene.particle_ids[place] != own[i]) ++place;
    const auto& position = scene.particles[place].position;
    result.col(static_cast<Eigen::Index>(i)) << position.x, position.y, position.z;
  }
  return result;
}

/// Puts the network beside the scene that is there, and only then takes that away.
/// @return the ids of its particles.
Ids SpringsNode::replaceScene(const Network& network) {
  if (!without(sceneIds(), known_).empty()) throw OtherClient(name_);
  setRunning(false);
  Ids own;
  try {
    own = call<AddParticles>("add_particles", particlesOf(network)).ids;
    throwIfInterrupted();
    call<AddSprings>("add_springs", springsOf(network, own));
    throwIfInterrupted();
    removeOthers(own);
  } catch (const OtherClient&) {
    withdraw(own);
    throw;
  } catch (...) {
    withdraw(own);
    if (was_running_) setRunning(true);
    throw;
  }
  throwIfInterrupted();
  return own;
}

/// Removes the particles of all others. Where two clients add to the scene at once, the one who was
/// first has the lower ids, and waits until the other has withdrawn.
void SpringsNode::removeOthers(const Ids& own) {
  constexpr double kWithdrawal = 5;  // [s]
  const Deadline deadline(kWithdrawal);
  RemoveParticles::Request request;
  for (;;) {
    request.ids = without(sceneIds(), own);
    const Ids foreign = without(request.ids, known_);
    if (foreign.empty()) break;
    if (foreign.front() < own.front() || deadline.isOver()) throw OtherClient(name_);
    throwIfInterrupted();
    kBetweenLooks.sleep();
  }
  if (request.ids.empty()) return;
  said_.push_back(call<RemoveParticles>("remove_particles", request).message);
}

/// Takes the network off the scene again if it is not all that is left of it. While the other
/// client's relaxation is under way the node refuses that.
void SpringsNode::withdraw(const Ids& own) const {
  constexpr double kLongest = 30;  // [s]
  RemoveParticles::Request request;
  request.ids = own;
  for (const Deadline deadline(kLongest); !own.empty(); kBetweenLooks.sleep()) {
    try {
      if (!known_.empty() && without(sceneIds(), own).empty()) return;
      call<RemoveParticles>("remove_particles", request);
      return;
    } catch (const NoAnswer&) {
      return;
    } catch (const std::exception& fault) {
      if (!interrupted() && !deadline.isOver()) continue;
      std::cerr << "warning: " << own.size()
                << " particles of the map are left in the scene: " << core::onOneLine(fault.what())
                << std::endl;
      return;
    }
  }
}

Ids SpringsNode::sceneIds() const { return call<GetScene>("get_scene").particle_ids; }

void SpringsNode::setRunning(bool running) const {
  std_srvs::SetBool::Request request;
  request.data = running;
  call<std_srvs::SetBool>("set_running", request);
}

}  // namespace spherical_springs::relax_mesh
