#include "spherical_springs/damping.h"

#include <cmath>
#include <utility>

namespace spherical_springs::core {

Damping::Damping(const Values& inverse_masses, const Values& viscous, std::vector<Damper> dampers,
                 std::vector<std::uint32_t> end_particles)
    : inverse_masses_(inverse_masses),
      viscous_(viscous),
      viscous_any_((viscous.array() * inverse_masses.array() > 0).any()),
      dampers_(std::move(dampers)),
      end_particles_(std::move(end_particles)) {}

namespace {

/// (1 - exp(-x)) / x
double meanDecay(double x) { return x == 0 ? 1 : -std::expm1(-x) / x; }

/// (1 - 2 meanDecay(x) + meanDecay(2 x)) / x^2; by Taylor's series where that cancels.
double meanSquareRise(double x) {
  constexpr double kSmall = 0.5;
  if (std::abs(x) > kSmall) return (1 - 2 * meanDecay(x) + meanDecay(2 * x)) / (x * x);
  constexpr int kTerms = 20;
  double sum = 0;
  double power = 2, factor = 1. / 6;  // 2^(n + 1) and (-x)^n / (n + 3)!
  for (int n = 0; n < kTerms; ++n) {
    sum += (2 * power - 2) * factor;
    power *= 2;
    factor *= -x / (n + 4);
  }
  return sum;
}

}  // namespace

// With rate r = c / m the velocity is w exp(-r t) + torque / m s(t), s(t) = (1 - exp(-r t)) / r,
// and c times the integral of its square is taken.
Damping::ViscousFlow Damping::viscousFlow(Eigen::Index particle, double duration) const {
  const double c = viscous_[particle];
  const double mobility = inverse_masses_[particle];
  if (mobility == 0) return {1, 0, {0, 0, 0}};
  const double x = c * mobility * duration;
  const double mean = meanDecay(x);
  const double gain = mobility * duration * mean;
  return {std::exp(-x),
          gain,
          {c * duration * meanDecay(2 * x), c * mobility * duration * duration * mean * mean,
           c * mobility * mobility * duration * duration * duration * meanSquareRise(x)}};
}

double Damping::fastestRate(const std::vector<Vector3>& gradients) const {
  Values rows = viscous_.cwiseProduct(inverse_masses_);
  for (const Damper& damper : dampers_) {
    const auto lever = [&](std::uint32_t end) {
      return gradients[end].norm() * std::sqrt(inverse_masses_[end_particles_[end]]);
    };
    double sum = 0;
    for (std::uint32_t j = 0; j < damper.end_count; ++j) sum += lever(damper.first_end + j);
    for (std::uint32_t j = 0; j < damper.end_count; ++j) {
      const std::uint32_t end = damper.first_end + j;
      rows[end_particles_[end]] += damper.coefficient * sum * lever(end);
    }
  }
  return rows.size() > 0 ? rows.maxCoeff() : 0;
}

int Damping::seriesTerms(double decays) {
  constexpr double kNegligible = 1e-18;
  int terms = 1;
  for (double next = decays * decays / 2; next > kNegligible; next *= decays / (terms + 1)) ++terms;
  return terms;
}

double Damping::kick(const Points& positions, const std::vector<Vector3>& gradients,
                     const Points& torques, double duration, Points& velocities) const {
  const double decays = fastestRate(gradients) * std::abs(duration);
  if (takenBySeries(decays)) {
    return kickBySeries(gradients, torques, duration, seriesTerms(decays), velocities);
  }
  if (duration < 0) {
    velocities += duration * torques * inverse_masses_.asDiagonal();
    return 0;
  }
  double taken = sweep(gradients, duration / 2, velocities);
  velocities += duration * torques * inverse_masses_.asDiagonal();
  taken += sweep(gradients, duration / 2, velocities);
  for (Eigen::Index i = 0; i < velocities.cols(); ++i) {
    velocities.col(i) = tangentPart(positions.col(i), velocities.col(i));
  }
  return taken;
}

/// `sum` += factor M^-1 D velocities.
void Damping::addRate(const std::vector<Vector3>& gradients, const Points& velocities,
                      double factor, Points& sum) const {
  if (viscous_any_) {
    sum += factor * velocities * viscous_.cwiseProduct(inverse_masses_).asDiagonal();
  }
  for (const Damper& damper : dampers_) {
    double rate = 0;
    for (std::uint32_t j = 0; j < damper.end_count; ++j) {
      const std::uint32_t end = damper.first_end + j;
      rate += gradients[end].dot(velocities.col(end_particles_[end]));
    }
    for (std::uint32_t j = 0; j < damper.end_count; ++j) {
      const std::uint32_t end = damper.first_end + j;
      const std::uint32_t particle = end_particles_[end];
      sum.col(particle) +=
          (factor * damper.coefficient * rate * inverse_masses_[particle]) * gradients[end];
    }
  }
}

// Taylor's series in time: each derivative of the velocities is -M^-1 D times the one before.
double Damping::kickBySeries(const std::vector<Vector3>& gradients, const Points& torques,
                             double duration, int terms, Points& velocities) const {
  const Points start = velocities;
  Points term = duration * torques * inverse_masses_.asDiagonal();
  addRate(gradients, velocities, -duration, term);
  Points path = duration * velocities;  // the integral of the velocities
  velocities += term;
  for (int n = 2; n <= terms + 1; ++n) {
    path += duration / n * term;
    if (n > terms || term.isZero(0)) break;
    Points next = Points::Zero(3, term.cols());
    addRate(gradients, term, -duration / n, next);
    velocities += next;
    term = std::move(next);
  }
  // The work of the torques less the gain of kinetic energy, which comes from a difference of
  // momenta and not of energies, to keep its digits: d (m w^2 / 2) = m dw . (w + w') / 2.
  double taken = torques.cwiseProduct(path).sum();
  for (Eigen::Index i = 0; i < velocities.cols(); ++i) {
    if (inverse_masses_[i] == 0) continue;
    taken -= 0.5 / inverse_masses_[i] *
             (velocities.col(i) - start.col(i)).dot(velocities.col(i) + start.col(i));
  }
  return taken;
}

// One damper after another, each by its exact flow, and back in the opposite order: symmetric in
// time, and as a map of momenta symmetric and positive, so that however strong the damping, torques
// still move particles down the energy.
double Damping::sweep(const std::vector<Vector3>& gradients, double duration,
                      Points& velocities) const {
  const double half = duration / 2;
  double taken = dampViscously(half, velocities);
  for (auto d = dampers_.begin(); d != dampers_.end(); ++d) {
    taken += dampEnds(*d, gradients, half, velocities);
  }
  for (auto d = dampers_.rbegin(); d != dampers_.rend(); ++d) {
    taken += dampEnds(*d, gradients, half, velocities);
  }
  return taken + dampViscously(half, velocities);
}

double Damping::dampViscously(double duration, Points& velocities) const {
  if (!viscous_any_) return 0;
  double taken = 0;
  for (Eigen::Index i = 0; i < velocities.cols(); ++i) {
    const double exponent = -viscous_[i] * inverse_masses_[i] * duration;
    if (exponent == 0) continue;
    taken -= 0.5 / inverse_masses_[i] * velocities.col(i).squaredNorm() * std::expm1(2 * exponent);
    velocities.col(i) *= std::exp(exponent);
  }
  return taken;
}

double Damping::dampEnds(const Damper& damper, const std::vector<Vector3>& gradients,
                         double duration, Points& velocities) const {
  double rate = 0;
  double mobility = 0;
  for (std::uint32_t j = 0; j < damper.end_count; ++j) {
    const std::uint32_t end = damper.first_end + j;
    rate += gradients[end].dot(velocities.col(end_particles_[end]));
    mobility += gradients[end].squaredNorm() * inverse_masses_[end_particles_[end]];
  }
  if (mobility == 0) return 0;
  const double exponent = -damper.coefficient * mobility * duration;
  const double impulse = rate * std::expm1(exponent) / mobility;
  for (std::uint32_t j = 0; j < damper.end_count; ++j) {
    const std::uint32_t end = damper.first_end + j;
    const std::uint32_t particle = end_particles_[end];
    velocities.col(particle) += impulse * inverse_masses_[particle] * gradients[end];
  }
  return -0.5 * rate * rate * std::expm1(2 * exponent) / mobility;
}

}  // namespace spherical_springs::core
