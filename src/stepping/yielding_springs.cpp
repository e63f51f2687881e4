#include "stepping/yielding_springs.h"

#include <Eigen/Cholesky>

namespace spherical_springs::core {

// The torques t become (1 + K M^-1 d^2 / 2)^-1 t, where K is the sum of k g g^T over the springs
// and M the masses. With d^2 / 4 the step would be that of A. Stern and E. Grinspun,
// "Implicit-explicit variational integration of highly oscillatory problems", Multiscale Model.
// Simul. 7 (2009), 1779-1794; with more it is inside the limit of stability.
void yieldTo(const std::vector<StiffSpring>& springs, const std::vector<double>& inverse_masses,
             double duration, std::vector<Vector3>& torques) {
  const auto count = static_cast<Eigen::Index>(springs.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(count);
  for (Eigen::Index s = 0; s < count; ++s) {
    const StiffSpring& one = springs[s];
    matrix(s, s) = 2 / (duration * duration * one.stiffness);
    for (std::size_t i = 0; i < one.ends; ++i) {
      const std::uint32_t particle = one.particles[i];
      const Vector3 moved = inverse_masses[particle] * one.gradient[i];
      rates[s] += moved.dot(torques[particle]);
      for (Eigen::Index r = 0; r < count; ++r) {
        const StiffSpring& other = springs[r];
        for (std::size_t j = 0; j < other.ends; ++j) {
          if (other.particles[j] == particle) matrix(r, s) += moved.dot(other.gradient[j]);
        }
      }
    }
  }
  const Eigen::VectorXd given = matrix.ldlt().solve(rates);
  for (Eigen::Index s = 0; s < count; ++s) {
    const StiffSpring& one = springs[s];
    for (std::size_t i = 0; i < one.ends; ++i) {
      torques[one.particles[i]] -= given[s] * one.gradient[i];
    }
  }
}

}  // namespace spherical_springs::core
