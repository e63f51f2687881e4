#include "node/actions.h"

#include <ros/serialization.h>
#include <spherical_springs/MapMeshAction.h>
#include <spherical_springs/RelaxAction.h>
#include <spherical_springs/StepAction.h>

#include <cmath>
#include <memory>
#include <optional>

#include "node/action_server.h"

namespace spherical_springs {
namespace {

/// Copies a message into one of another name that has the same fields.
template <class To, class From>
To sameFields(const From& from) {
  using ros::message_traits::MD5Sum;
  static_assert(MD5Sum<To>::static_value1 == MD5Sum<From>::static_value1 &&
                    MD5Sum<To>::static_value2 == MD5Sum<From>::static_value2,
                "an action has the fields of the service of its name");
  const ros::SerializedMessage bytes = ros::serialization::serializeMessage(from);
  ros::serialization::IStream stream(bytes.message_start,
                                     ros::serialization::serializationLength(from));
  To to;
  stream.next(to);
  return to;
}

struct RelaxWork {
  using ActionSpec = RelaxAction;
  using Doer = Handlers;
  using Progress = core::RelaxProgress;

  static constexpr auto kName = "relax";

  static std::optional<RelaxFeedback> feedback(const Progress&, const Progress& now,
                                               double elapsed) {
    if (now.best == nullptr) return {};
    RelaxFeedback feedback;
    feedback.progress = now.fraction;
    feedback.iterations = now.best->iterations;
    feedback.energy = now.best->energy_after;
    feedback.max_torque = now.best->max_torque;
    feedback.wall_time = elapsed;
    return feedback;
  }

  static void handle(Handlers& handlers, const RelaxGoal& goal, RelaxResult& result,
                     core::RelaxFollower& follower) {
    Answer<Relax> answer;
    handlers.relax(sameFields<Relax::Request>(goal), answer, &follower);
    result = sameFields<RelaxResult>(answer.response);
  }
};

struct StepWork {
  using ActionSpec = StepAction;
  using Doer = Handlers;
  using Progress = core::StepProgress;

  static constexpr auto kName = "step";

  static std::optional<StepFeedback> feedback(const Progress& begin, const Progress& now,
                                              double elapsed) {
    StepFeedback feedback;
    feedback.steps = now.steps;
    feedback.time = now.time;
    feedback.real_time_factor = (now.time - begin.time) / elapsed;
    return feedback;
  }

  static void handle(Handlers& handlers, const StepGoal& goal, StepResult& result,
                     core::StepFollower& follower) {
    Answer<Step> answer;
    handlers.step(sameFields<Step::Request>(goal), answer, &follower);
    result = sameFields<StepResult>(answer.response);
  }
};

struct MapWork {
  using ActionSpec = MapMeshAction;
  using Doer = MapHandler;
  using Progress = mesh::MapProgress;

  static constexpr auto kName = "map_mesh";

  static std::optional<MapMeshFeedback> feedback(const Progress&, const Progress& now,
                                                 double elapsed) {
    MapMeshFeedback feedback;
    feedback.progress = now.fraction;
    feedback.spread = std::isinf(now.spread) ? 0 : now.spread;
    feedback.wall_time = elapsed;
    return feedback;
  }

  static void handle(MapHandler& handler, const MapMeshGoal& goal, MapMeshResult& result,
                     MapFollower& follower) {
    handler.map(goal, result, follower);
  }
};

}  // namespace

Actions::Actions(const ros::NodeHandle& receiving, ros::CallbackQueueInterface& calls,
                 Handlers& handlers, MapHandler& mapper, News& news)
    : servers_{std::make_shared<WorkServer<RelaxWork>>(receiving, calls, handlers, news),
               std::make_shared<WorkServer<StepWork>>(receiving, calls, handlers, news),
               std::make_shared<WorkServer<MapWork>>(receiving, calls, mapper, news)} {}

}  // namespace spherical_springs
