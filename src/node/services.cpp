#include "node/services.h"

#include "node/answering_service.h"

namespace spherical_springs {

template <class Service, class Handle>
void Services::advertiseAny(ros::NodeHandle& node, const std::string& name, const Handle& handle) {
  refusals_.emplace_back(name, news_);
  servers_.push_back(advertiseAnswering<Service>(node, name, limits_, handle, refusals_.back()));
}

template <class Service>
void Services::advertiseReader(ros::NodeHandle& node, const std::string& name,
                               Handler<Service> handle) {
  advertiseAny<Service>(node, name, [this, handle](const auto& request, auto& answer) {
    (handlers_.*handle)(request, answer);
  });
}

template <class Service>
void Services::advertise(ros::NodeHandle& node, const std::string& name, Handler<Service> handle) {
  advertiseAny<Service>(node, name, [this, handle](const auto& request, auto& answer) {
    const StatusChange told_at_the_end(news_);
    (handlers_.*handle)(request, answer);
    news_.sceneChanged();
  });
}

Services::Services(ros::NodeHandle node, ros::NodeHandle cancelling, ros::NodeHandle pausing,
                   Handlers& handlers, News& news, const core::SceneLimits& limits)
    : handlers_(handlers), news_(news), limits_(limits) {
  advertise<AddParticles>(node, "add_particles", &Handlers::addParticles);
  advertise<SetParticles>(node, "set_particles", &Handlers::setParticles);
  advertise<RemoveParticles>(node, "remove_particles", &Handlers::removeParticles);
  advertise<AddSprings>(node, "add_springs", &Handlers::addSprings);
  advertise<SetSprings>(node, "set_springs", &Handlers::setSprings);
  advertise<RemoveSprings>(node, "remove_springs", &Handlers::removeSprings);
  advertiseReader<GetScene>(node, "get_scene", &Handlers::getScene);
  advertiseReader<GetStrains>(node, "get_strains", &Handlers::getStrains);
  advertiseReader<GetCovariance>(node, "get_covariance", &Handlers::getCovariance);
  advertise<LoadScene>(node, "load_scene", &Handlers::loadScene);
  advertiseReader<SaveScene>(node, "save_scene", &Handlers::saveScene);
  advertise<std_srvs::Trigger>(node, "clear", &Handlers::clear);
  advertise<std_srvs::Trigger>(node, "reset", &Handlers::reset);
  advertise<std_srvs::SetBool>(pausing, "set_running", &Handlers::setRunning);
  // Without steps it only reports; it tells of those that it does itself.
  advertiseReader<Step>(node, "step", &Handlers::step);
  advertise<Relax>(node, "relax", &Handlers::relax);
  advertise<std_srvs::Trigger>(cancelling, "cancel", &Handlers::cancel);
}

}  // namespace spherical_springs
