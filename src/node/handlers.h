// The services' work: message in, runner, message out. No network, so that tests can do without.
#pragma once

#include <spherical_springs/AddParticles.h>
#include <spherical_springs/AddSprings.h>
#include <spherical_springs/GetCovariance.h>
#include <spherical_springs/GetScene.h>
#include <spherical_springs/GetStrains.h>
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

#include <string>

#include "node/answer.h"
#include "node/map_turn.h"
#include "node/news.h"
#include "node/scene_directory.h"
#include "simulation/runner.h"

namespace spherical_springs {

/// One function a service, for many threads. Each fills the response or throws; one that throws has
/// changed nothing. That is why answers are reserved before the change, and why nothing after it
/// takes memory. A follower, of a call that may take long, is null for none.
class Handlers {
 public:
  /// The arguments must live longer. `mappings`: those that `cancel` ends too. `frame_id`: that of
  /// energies.
  Handlers(core::Runner& runner, News& news, MapTurn& mappings, const SceneDirectory& directory,
           const core::SceneLimits& limits, const std::string& frame_id)
      : runner_(runner),
        news_(news),
        mappings_(mappings),
        directory_(directory),
        limits_(limits),
        frame_id_(frame_id) {}

  void addParticles(const AddParticles::Request& request, Answer<AddParticles>& answer);
  void setParticles(const SetParticles::Request& request, Answer<SetParticles>& answer);
  void removeParticles(const RemoveParticles::Request& request, Answer<RemoveParticles>& answer);
  void addSprings(const AddSprings::Request& request, Answer<AddSprings>& answer);
  void setSprings(const SetSprings::Request& request, Answer<SetSprings>& answer);
  void removeSprings(const RemoveSprings::Request& request, Answer<RemoveSprings>& answer);
  void getScene(const GetScene::Request& request, Answer<GetScene>& answer);
  void getStrains(const GetStrains::Request& request, Answer<GetStrains>& answer);
  void getCovariance(const GetCovariance::Request& request, Answer<GetCovariance>& answer);
  void loadScene(const LoadScene::Request& request, Answer<LoadScene>& answer);
  void saveScene(const SaveScene::Request& request, Answer<SaveScene>& answer);
  void clear(const std_srvs::Trigger::Request& request, Answer<std_srvs::Trigger>& answer);
  void reset(const std_srvs::Trigger::Request& request, Answer<std_srvs::Trigger>& answer);
  void setRunning(const std_srvs::SetBool::Request& request, Answer<std_srvs::SetBool>& answer);
  void step(const Step::Request& request, Answer<Step>& answer) { step(request, answer, nullptr); }
  void step(const Step::Request& request, Answer<Step>& answer, core::StepFollower* follower);
  void relax(const Relax::Request& request, Answer<Relax>& answer) {
    relax(request, answer, nullptr);
  }
  void relax(const Relax::Request& request, Answer<Relax>& answer, core::RelaxFollower* follower);
  void cancel(const std_srvs::Trigger::Request& request, Answer<std_srvs::Trigger>& answer);

 private:
  core::Runner& runner_;
  News& news_;
  MapTurn& mappings_;
  const SceneDirectory& directory_;
  const core::SceneLimits limits_;
  const std::string frame_id_;
};

}  // namespace spherical_springs
