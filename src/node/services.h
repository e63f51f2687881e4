// The services of the node. Each is a thin shell: message in, runner, message out.
#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <spherical_springs/AddParticles.h>
#include <spherical_springs/AddSprings.h>
#include <spherical_springs/GetScene.h>
#include <spherical_springs/LoadScene.h>
#include <spherical_springs/Relax.h>
#include <spherical_springs/RemoveParticles.h>
#include <spherical_springs/RemoveSprings.h>
#include <spherical_springs/SaveScene.h>
#include <spherical_springs/SetParticles.h>
#include <spherical_springs/SetSprings.h>
#include <spherical_springs/Step.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <vector>

#include "publisher.h"
#include "scene_directory.h"
#include "spherical_springs/runner.h"

namespace spherical_springs {

class Services {
 public:
  /// Advertises all services: ~cancel and ~set_running under handles of their own, whose queues are
  /// to be called while long calls occupy the threads of the others. What is passed must live
  /// longer.
  Services(ros::NodeHandle node, ros::NodeHandle cancelling, ros::NodeHandle pausing,
           core::Runner& runner, Publisher& publisher, const SceneDirectory& directory);

 private:
  void addParticles(const AddParticles::Request& request, AddParticles::Response& response);
  void setParticles(const SetParticles::Request& request, SetParticles::Response& response);
  void removeParticles(const RemoveParticles::Request& request,
                       RemoveParticles::Response& response);
  void addSprings(const AddSprings::Request& request, AddSprings::Response& response);
  void setSprings(const SetSprings::Request& request, SetSprings::Response& response);
  void removeSprings(const RemoveSprings::Request& request, RemoveSprings::Response& response);
  void getScene(const GetScene::Request& request, GetScene::Response& response);
  void loadScene(const LoadScene::Request& request, LoadScene::Response& response);
  void saveScene(const SaveScene::Request& request, SaveScene::Response& response);
  void clear(const std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void reset(const std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void setRunning(const std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  void step(const Step::Request& request, Step::Response& response);
  void relax(const Relax::Request& request, Relax::Response& response);
  void cancel(const std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  template <class Service>
  using Handler = void (Services::*)(const typename Service::Request&, typename Service::Response&);

  template <class Service>
  void advertiseReader(ros::NodeHandle& node, const std::string& name, Handler<Service> handle);

  /// A service after whose calls, refused ones too, the status is published.
  template <class Service>
  void advertise(ros::NodeHandle& node, const std::string& name, Handler<Service> handle);

  template <class Service, class Handle>
  void advertiseAny(ros::NodeHandle& node, const std::string& name, const Handle& handle);

  core::Runner& runner_;
  Publisher& publisher_;
  const SceneDirectory& directory_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace spherical_springs
