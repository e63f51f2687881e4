#include "services.h"

#include "answering_service.h"
#include "conversion.h"
#include "spherical_springs/range.h"

namespace spherical_springs {
namespace {

std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

double secondsSince(const ros::WallTime& begin) { return (ros::WallTime::now() - begin).toSec(); }

template <class Message>
std::size_t springCount(const Message& message) {
  return message.angle_springs.size() + message.solid_angle_springs.size() +
         message.oriented_angle_springs.size();
}

/// Has the status published whether a call succeeds or not.
class StatusChange {
 public:
  explicit StatusChange(Publisher& publisher) : publisher_(publisher) {}
  ~StatusChange() { publisher_.statusChanged(); }
  StatusChange(const StatusChange&) = delete;
  StatusChange& operator=(const StatusChange&) = delete;

 private:
  Publisher& publisher_;
};

}  // namespace

template <class Service, class Handle>
void Services::advertiseAny(ros::NodeHandle& node, const std::string& name, const Handle& handle) {
  const auto limits = runner_.read([](const core::Simulation& s) { return s.settings().limits; });
  servers_.push_back(advertiseAnswering<Service>(
      node, name, limits, [this, handle](const auto& request, auto& response) {
        try {
          handle(request, response);
        } catch (const core::NonFinite& fault) {
          publisher_.diagnostics().refused(fault.what());
          throw;
        }
      }));
}

template <class Service>
void Services::advertiseReader(ros::NodeHandle& node, const std::string& name,
                               Handler<Service> handle) {
  advertiseAny<Service>(node, name, [this, handle](const auto& request, auto& response) {
    (this->*handle)(request, response);
  });
}

template <class Service>
void Services::advertise(ros::NodeHandle& node, const std::string& name, Handler<Service> handle) {
  advertiseAny<Service>(node, name, [this, handle](const auto& request, auto& response) {
    const StatusChange told_at_the_end(publisher_);
    (this->*handle)(request, response);
  });
}

Services::Services(ros::NodeHandle node, ros::NodeHandle cancelling, ros::NodeHandle pausing,
                   core::Runner& runner, Publisher& publisher, const SceneDirectory& directory)
    : runner_(runner), publisher_(publisher), directory_(directory) {
  advertise<AddParticles>(node, "add_particles", &Services::addParticles);
  advertise<SetParticles>(node, "set_particles", &Services::setParticles);
  advertise<RemoveParticles>(node, "remove_particles", &Services::removeParticles);
  advertise<AddSprings>(node, "add_springs", &Services::addSprings);
  advertise<SetSprings>(node, "set_springs", &Services::setSprings);
  advertise<RemoveSprings>(node, "remove_springs", &Services::removeSprings);
  advertiseReader<GetScene>(node, "get_scene", &Services::getScene);
  advertise<LoadScene>(node, "load_scene", &Services::loadScene);
  advertiseReader<SaveScene>(node, "save_scene", &Services::saveScene);
  advertise<std_srvs::Trigger>(node, "clear", &Services::clear);
  advertise<std_srvs::Trigger>(node, "reset", &Services::reset);
  advertise<std_srvs::SetBool>(pausing, "set_running", &Services::setRunning);
  advertiseReader<Step>(node, "step", &Services::step);
  advertise<Relax>(node, "relax", &Services::relax);
  advertise<std_srvs::Trigger>(cancelling, "cancel", &Services::cancel);
}

void Services::addParticles(const AddParticles::Request& request,
                            AddParticles::Response& response) {
  auto particles = fromMessages(request.particles);
  response.ids =
      runner_.change([&](core::Simulation& s) { return s.addParticles(std::move(particles)); });
  response.message = "added " + counted(response.ids.size(), "particle");
}

void Services::setParticles(const SetParticles::Request& request,
                            SetParticles::Response& response) {
  auto particles = fromMessages(request.particles);
  runner_.change([&](core::Simulation& s) { s.setParticles(request.ids, std::move(particles)); });
  response.message = "set " + counted(request.ids.size(), "particle");
}

void Services::removeParticles(const RemoveParticles::Request& request,
                               RemoveParticles::Response& response) {
  const std::size_t springs =
      runner_.change([&](core::Simulation& s) { return s.removeParticles(request.ids); });
  response.springs_removed = static_cast<std::uint32_t>(springs);
  response.message = "removed " + counted(request.ids.size(), "particle") + " and " +
                     counted(response.springs_removed, "spring");
}

void Services::addSprings(const AddSprings::Request& request, AddSprings::Response& response) {
  auto springs = springsFrom(request);
  setSpringIds(
      runner_.change([&](core::Simulation& s) { return s.addSprings(std::move(springs)); }),
      response);
  response.message = "added " + counted(springCount(request), "spring");
}

void Services::setSprings(const SetSprings::Request& request, SetSprings::Response& response) {
  auto springs = springsFrom(request);
  const auto ids = springIdsFrom(request);
  runner_.change([&](core::Simulation& s) { s.setSprings(ids, std::move(springs)); });
  response.message = "set " + counted(springCount(request), "spring");
}

void Services::removeSprings(const RemoveSprings::Request& request,
                             RemoveSprings::Response& response) {
  const auto ids = springIdsFrom(request);
  runner_.change([&](core::Simulation& s) { s.removeSprings(ids); });
  response.message =
      "removed " + counted(request.angle_spring_ids.size() + request.solid_angle_spring_ids.size() +
                               request.oriented_angle_spring_ids.size(),
                           "spring");
}

void Services::getScene(const GetScene::Request&, GetScene::Response& response) {
  const auto [scene, time] = runner_.present();
  response.time = time;
  const auto fill = [](const auto& table, auto& ids, auto& messages) {
    ids = table.ids();
    messages.reserve(table.size());
    for (const auto& item : table.items()) messages.push_back(toMessage(item));
  };
  fill(scene.particles(), response.particle_ids, response.particles);
  fill(scene.springs<core::AngleSpring>(), response.angle_spring_ids, response.angle_springs);
  fill(scene.springs<core::SolidAngleSpring>(), response.solid_angle_spring_ids,
       response.solid_angle_springs);
  fill(scene.springs<core::OrientedAngleSpring>(), response.oriented_angle_spring_ids,
       response.oriented_angle_springs);
}

void Services::loadScene(const LoadScene::Request& request, LoadScene::Response& response) {
  const auto path = directory_.inside(request.path);
  const auto limits = runner_.read([](const core::Simulation& s) { return s.settings().limits; });
  auto file = core::readScene(path, limits);
  runner_.change([&](core::Simulation& s) { s.load(std::move(file)); });
  publisher_.diagnostics().relaxed("");
  response.message = "loaded " + core::onOneLine(path);
  publisher_.tell(response.message);
}

void Services::saveScene(const SaveScene::Request& request, SaveScene::Response& response) {
  const auto path = directory_.inside(request.path);
  directory_.make();
  const auto [scene, time] = runner_.present();
  core::writeScene(path, scene, time);
  response.message = "saved " + core::onOneLine(path);
  publisher_.tell(response.message);
}

void Services::clear(const std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  runner_.change([&](core::Simulation& s) {
    response.message = "removed " + counted(s.scene().particles().size(), "particle") + " and " +
                       counted(s.scene().springCount(), "spring") + ", time 0";
    s.clear();
  });
  publisher_.diagnostics().relaxed("");
}

void Services::reset(const std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  runner_.change([](core::Simulation& s) { s.reset(); });
  publisher_.diagnostics().relaxed("");
  response.message = "every particle is where it was last added or set, time 0";
}

void Services::setRunning(const std_srvs::SetBool::Request& request,
                          std_srvs::SetBool::Response& response) {
  runner_.setRunning(request.data);
  response.message = request.data ? "running" : "paused";
}

void Services::step(const Step::Request& request, Step::Response& response) {
  const auto begin = ros::WallTime::now();
  if (request.steps > 0) {
    const StatusChange told_at_the_end(publisher_);
    const std::uint64_t done = runner_.step(request.steps);
    response.message = done == request.steps ? "did " + counted(done, "step")
                                             : "cancelled after " + counted(done, "step") + " of " +
                                                   std::to_string(request.steps);
  }
  response.wall_time = secondsSince(begin);
  const auto now = runner_.snapshot();
  response.time = now.state.time;
  response.energies = publisher_.energies(now);
}

void Services::relax(const Relax::Request& request, Relax::Response& response) {
  const auto begin = ros::WallTime::now();
  core::RelaxationOptions options;
  options.method = core::relaxationMethod(request.method);
  options.tolerance = request.tolerance;
  options.max_time = request.max_time;
  options.keep_orientation = request.keep_orientation;
  publisher_.statusChanged();
  const auto result = runner_.relax(options);
  response.converged = result.converged;
  response.iterations = result.iterations;
  response.wall_time = secondsSince(begin);
  response.energy_before = result.energy_before;
  response.energy_after = result.energy_after;
  response.max_torque = result.max_torque;
  response.message = result.message;
  publisher_.diagnostics().relaxed(result.converged ? "" : result.message);
  publisher_.tell("relax: " + result.message);
}

void Services::cancel(const std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  response.message = runner_.cancel() ? "cancelling" : "nothing was under way";
}

}  // namespace spherical_springs
