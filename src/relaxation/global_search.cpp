#include "relaxation/global_search.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>

#include "relaxation/freedom.h"
#include "relaxation/minimum_search.h"
#include "relaxation/new_starts.h"
#include "relaxation/newton.h"
#include "relaxation/spring_sweeps.h"
#include "relaxation/torque_limit.h"
#include "relaxation/turn_back.h"
#include "spherical_springs/range.h"

namespace spherical_springs::core {
namespace {

/// Every free particle that springs join at a random place, every direction alike.
Points scattered(const System& system, Points positions, std::mt19937_64& generator) {
  const auto unit = [&] { return std::ldexp(static_cast<double>(generator() >> 11), -53); };
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    if (system.pinned(i) || !system.joined(i)) continue;
    const double z = 2 * unit() - 1;
    const double turn = 2 * kPi * unit();
    const double across = std::sqrt(1 - z * z);
    positions.col(i) = direction({across * std::cos(turn), across * std::sin(turn), z});
  }
  return positions;
}

}  // namespace

GlobalSearch::GlobalSearch(const System& system, const Points& positions,
                           const RelaxationOptions& options)
    : system_(system), start_(positions), options_(options), groups_(system) {}

RelaxationResult GlobalSearch::run() {
  const double share = 1. / (1 + options_.starts);
  best_ = descend(start_, 0, share);
  energies_ = groups_.energies(best_.positions);
  rounding_ = roundingOf(energies_, groups_.stiffness());
  const std::vector<bool> differ = mirrorImagesDiffer(groups_, best_.positions);
  const bool mirrors = std::find(differ.begin(), differ.end(), true) != differ.end();
  if (mirrors && !isOver()) consider(descend(groups_.mirrored(best_.positions), share, 0));
  std::uint32_t tried = 0;
  while (tried < options_.starts && !isOver()) {
    Points places = start(tried);
    if (!sweep(tried, places)) break;
    const RelaxationResult minimum = descend(places, (tried + 1.5) * share, share / 2);
    double energy = consider(minimum);
    if (mirrors && !isOver()) {
      const RelaxationResult other = descend(groups_.mirrored(minimum.positions), 0, 0);
      energy = std::min(energy, consider(other));
    }
    found_.push_back(energy);
    ++tried;
  }
  return finished(tried);
}

/// Whether the time is over, or the search has been cancelled.
bool GlobalSearch::isOver() {
  const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
  late_ = late_ || (options_.max_time > 0 && elapsed >= options_.max_time);
  return late_ || cancelled_;
}

/// Where the sweeps of a start begin. The present places count but for a little: from particles on
/// one spot or on one circle no spring leads away.
Points GlobalSearch::start(std::uint32_t number) const {
  constexpr double kLittle = 0.01;
  if (number == 0) return displaced(system_, start_, kLittle, options_.seed);
  std::mt19937_64 generator((std::uint64_t(options_.seed) << 32) + number);
  return scattered(system_, start_, generator);
}

bool GlobalSearch::sweep(std::uint32_t number, Points& positions) {
  SpringSweeps sweeps(system_, (std::uint64_t(options_.seed) << 32) + number);
  for (int i = 0; i < SpringSweeps::kCount; ++i) {
    const double done = (1 + number + 0.5 * i / SpringSweeps::kCount) / (1. + options_.starts);
    if (isOver() || !show(best_, done)) return false;
    sweeps.sweep(i, positions);
  }
  return true;
}

/// Newton's method from somewhere; on the way `fraction` goes on from `done` by up to `share`.
RelaxationResult GlobalSearch::descend(const Points& from, double done, double share) {
  RelaxationOptions options = options_;
  options.method = RelaxationMethod::newton;
  if (options_.max_time > 0) {
    const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
    options.max_time = std::max(options_.max_time - elapsed, 1e-9);
  }
  options.go_on = [&](const RelaxationProgress& progress) {
    const bool lower =
        best_.positions.cols() == 0 || progress.best.energy_after < best_.energy_after;
    return show(lower ? progress.best : best_, done + share * progress.fraction);
  };
  Newton newton(system_, from);
  RelaxationResult result = MinimumSearch(system_, from, options, newton, false).run();
  iterations_ += result.iterations;
  return result;
}

/// Takes each group whose energy is lower there than in what is kept.
/// @return the energy of all groups there [J].
double GlobalSearch::consider(const RelaxationResult& found) {
  const Eigen::VectorXd energies = groups_.energies(found.positions);
  bool all = true, any = false;
  for (Eigen::Index g = 0; g < energies.size(); ++g) {
    const bool lower = energies[g] < energies_[g] - rounding_[g];
    all = all && lower;
    any = any || lower;
    if (!lower) continue;
    energies_[g] = energies[g];
    for (const std::uint32_t i : groups_.particles(g)) {
      best_.positions.col(i) = found.positions.col(i);
    }
  }
  if (any) {
    improved_ = true;
    best_.converged = found.converged && (all || best_.converged);
    best_.message = all || !found.converged ? found.message : best_.message;
    best_.energy_after = system_.potential(best_.positions).total();
    best_.max_torque = largestTorque(system_, best_.positions);
  }
  return energies.sum();
}

/// Tells how far the search has come. @return false where that ends it.
bool GlobalSearch::show(const RelaxationResult& best, double fraction) {
  RelaxationResult shown = best;
  shown.iterations = iterations_;
  if (best_.positions.cols() > 0) shown.energy_before = best_.energy_before;
  fraction_ = std::max(fraction_, std::min(fraction, 1.));
  cancelled_ = cancelled_ || !options_.go_on({shown, fraction_});
  return !cancelled_;
}

RelaxationResult GlobalSearch::finished(std::uint32_t tried) {
  if (improved_) {
    const TorqueLimit limit(system_, options_.tolerance);
    turnBack(system_, start_, areWithin(system_, start_, limit), best_);
    best_.max_torque = largestTorque(system_, best_.positions);
  }
  best_.iterations = iterations_;
  const std::string starts =
      std::to_string(tried) + " of " + std::to_string(options_.starts) + " starts";
  if (late_ || cancelled_) {
    best_.message = (late_ ? "max_time is over after " : "cancelled after ") + starts +
                    "; largest torque " + toText(best_.max_torque) + " N m";
    return std::move(best_);
  }
  const double low = energies_.sum() + rounding_.sum();
  const auto as_low =
      std::count_if(found_.begin(), found_.end(), [&](double energy) { return energy <= low; });
  best_.message += "; " + std::to_string(as_low) + " of " + std::to_string(options_.starts) +
                   " starts ended there";
  return std::move(best_);
}

}  // namespace spherical_springs::core
