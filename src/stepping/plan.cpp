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

/// The layout of the first of several plans that differ in parameters, made when it is needed.
class Plan::FirstLayout {
 public:
  FirstLayout(std::shared_ptr<const System> system, Points positions)
      : system_(std::move(system)), positions_(std::move(positions)) {}

  const Layout& get() {
    std::call_once(made_, [this] {
      layout_ = std::make_unique<const Layout>(*system_, positions_);
      positions_.resize(3, 0);
      system_.reset();
    });
    return *layout_;
  }

 private:
  std::shared_ptr<const System> system_;
  Points positions_;
  std::once_flag made_;
  std::unique_ptr<const Layout> layout_;
};

Plan::Plan(const Scene& scene, System::Options options)
    : Plan(std::make_shared<const System>(scene, options), positionsIn(scene)) {}

Plan::Plan(std::shared_ptr<const System> system, Points positions)
    : system_(std::move(system)),
      first_(std::make_shared<FirstLayout>(system_, std::move(positions))),
      is_first_(true) {}

Plan::Plan(const Scene& scene, System::Options options, const Plan& earlier)
    : system_(std::make_shared<const System>(scene, options)),
      first_(earlier.first_),
      is_first_(false) {}

Plan::~Plan() = default;

const Layout& Plan::layout() const {
  if (is_first_) return first_->get();
  std::call_once(layout_made_,
                 [this] { layout_ = std::make_unique<const Layout>(first_->get(), *system_); });
  return *layout_;
}

}  // namespace spherical_springs::core
