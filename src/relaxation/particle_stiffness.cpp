#include "relaxation/particle_stiffness.h"

namespace spherical_springs::core {

Eigen::VectorXd particleStiffness(const System& system, const Points& positions) {
  constexpr double kLeastShare = 1e-12;
  Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(system.particleCount());
  forEachKind([&](auto kind) {
    for (const auto& spring : system.springs<typename decltype(kind)::type>()) {
      const auto c = condition(spring, System::points(spring, positions));
      for (std::size_t j = 0; j < spring.particles.size(); ++j) {
        stiffness[spring.particles[j]] += spring.stiffness * c.gradient[j].squaredNorm();
      }
    }
  });
  const double largest = stiffness.size() > 0 ? stiffness.maxCoeff() : 0;
  return stiffness.cwiseMax(largest > 0 ? kLeastShare * largest : 1);
}

}  // namespace spherical_springs::core
