// The handlers of services that only read.
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "node/conversion.h"
#include "node/handlers.h"
#include "node/kinds.h"
#include "scene/checks.h"
#include "spherical_springs/covariance.h"
#include "spherical_springs/measures.h"

namespace spherical_springs {
namespace {

/// The indices of particles by their ids; without ids those of all.
/// @throw std::invalid_argument for an id that no particle has, and for too many.
std::vector<std::uint32_t> indicesOf(const core::IdTable<core::Particle>& particles,
                                     const std::vector<std::uint32_t>& ids) {
  constexpr std::size_t kMost = 1000;
  const std::vector<std::uint32_t>& asked = ids.empty() ? particles.ids() : ids;
  if (asked.size() > kMost) {
    throw std::invalid_argument("covariances of " + std::to_string(asked.size()) +
                                " particles are asked for; allowed: up to " +
                                std::to_string(kMost) + " a call");
  }
  const auto indices = core::indicesOf(particles, asked, "ids", "a particle");
  return {indices.begin(), indices.end()};
}

}  // namespace

void Handlers::getScene(const GetScene::Request&, Answer<GetScene>& answer) {
  auto& response = answer.response;
  const core::SceneFile present = runner_.present();
  response.time = present.time;
  const auto fill = [](const auto& table, auto& ids, auto& messages) {
    ids = table.ids();
    messages.reserve(table.size());
    for (const auto& item : table.items()) messages.push_back(toMessage(item));
  };
  fill(present.scene.particles(), response.particle_ids, response.particles);
  forEachKindInMessages([&](auto kind) {
    fill(present.scene.springs<typename decltype(kind)::Spring>(), kind.ids(response),
         kind.springs(response));
  });
}

void Handlers::getStrains(const GetStrains::Request&, Answer<GetStrains>& answer) {
  const auto now = runner_.snapshot();
  const core::System& system = *now.plan->system();
  core::Strains strains = core::strains(system, now.state.positions);
  forEachKindInMessages([&](auto kind) {
    using Spring = typename decltype(kind)::Spring;
    auto& ids = kind.ids(answer.response);
    ids.resize(system.springs<Spring>().size());
    for (std::size_t s = 0; s < ids.size(); ++s) ids[s] = system.springId<Spring>(s);
    kind.conditions(answer.response) = std::move(strains.get<Spring>().conditions);
    kind.energies(answer.response) = std::move(strains.get<Spring>().energies);
  });
}

void Handlers::getCovariance(const GetCovariance::Request& request, Answer<GetCovariance>& answer) {
  const auto options = runner_.read([](core::Simulation& s) { return s.settings().system; });
  const core::Scene scene = runner_.present().scene;
  const auto indices = indicesOf(scene.particles(), request.ids);
  const core::System system(scene, options);
  core::Points positions(3, system.particleCount());
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    positions.col(i) = scene.particles().item(i).position;
  }
  const auto covariances = core::covariances(system, positions, indices);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const core::TangentFrame axes = axesOfPose(positions.col(indices[i]));
    const Eigen::Matrix2d block = axes.transpose() * covariances[i] * axes;
    for (const double value : {block(0, 0), block(0, 1), block(1, 0), block(1, 1)}) {
      answer.response.covariances.push_back(value);
    }
  }
}

}  // namespace spherical_springs
