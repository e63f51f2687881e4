// A compiled system with the memory layout in which it is stepped and evaluated.
#pragma once

#include <memory>
#include <mutex>

#include "spherical_springs/scene.h"
#include "spherical_springs/system.h"

namespace spherical_springs::core {

class Layout;

/// Unchanging but for the layout, which is made when first asked for; for many threads.
class Plan {
 public:
  /// The layout depends on where `scene` has its particles, so that neighbours come to lie
  /// together.
  Plan(const Scene& scene, System::Options options);

  /// `positions`: one unit vector a particle, in the order of ids.
  Plan(std::shared_ptr<const System> system, Points positions);

  ~Plan();
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;

  const std::shared_ptr<const System>& system() const { return system_; }

  /// @throw std::bad_alloc; the next call tries again.
  const Layout& layout() const;

 private:
  const std::shared_ptr<const System> system_;
  mutable std::once_flag layout_made_;
  mutable Points positions_;  // until the layout is made
  mutable std::unique_ptr<const Layout> layout_;
};

}  // namespace spherical_springs::core
