// A compiled system with the memory layout in which it is stepped and evaluated.
#pragma once

#include <memory>
#include <mutex>

#include "spherical_springs/scene.h"
#include "spherical_springs/system.h"

namespace spherical_springs::core {

class Layout;

/// Unchanging but for the layout, which is made when first asked for; for many threads.
/// \snippet test_headers.cpp integrator
class Plan {
 public:
  /// The layout depends on where `scene` has its particles, so that neighbours come to lie
  /// together.
  Plan(const Scene& scene, System::Options options);

  /// `positions`: one unit vector a particle, in the order of ids.
  Plan(std::shared_ptr<const System> system, Points positions);

  /// `earlier`: of a scene with the same particles and springs, which differ in their numbers alone
  /// (masses, damping, pins; rest, stiffness). The layout has the order of the earlier one.
  Plan(const Scene& scene, System::Options options, const Plan& earlier);

  ~Plan();
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;

  const std::shared_ptr<const System>& system() const { return system_; }  ///< never null

  /// @throw std::bad_alloc; the next call tries again.
  const Layout& layout() const;

 private:
  class FirstLayout;

  const std::shared_ptr<const System> system_;
  const std::shared_ptr<FirstLayout> first_;  // of this topology
  const bool is_first_;
  mutable std::once_flag layout_made_;
  mutable std::unique_ptr<const Layout> layout_;  // unless it is the first
};

}  // namespace spherical_springs::core
