#include "spherical_springs/plan.h"

#include <utility>

#include "stepping/layout.h"

namespace spherical_springs::core {
namespace {

Points positionsIn(const Scene& scene) {
  const auto& particles = scene.particles().items();
  Points positions(3, particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) positions.col(i) = particles[i].position;
  return positions;
}

}  // namespace

Plan::Plan(const Scene& scene, System::Options options)
    : Plan(std::make_shared<const System>(scene, options), positionsIn(scene)) {}

Plan::Plan(std::shared_ptr<const System> system, Points positions)
    : system_(std::move(system)), positions_(std::move(positions)) {}

Plan::~Plan() = default;

const Layout& Plan::layout() const {
  std::call_once(layout_made_, [this] {
    layout_ = std::make_unique<const Layout>(*system_, positions_);
    positions_.resize(3, 0);
  });
  return *layout_;
}

}  // namespace spherical_springs::core
