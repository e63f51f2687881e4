#include "difference_hessian.h"

#include <algorithm>
#include <array>
#include <limits>

#include "spherical_springs/springs/condition.h"

namespace benchmark_scenes {
namespace {

using namespace spherical_springs::core;  // NOLINT: names of the core throughout

using Graph = std::vector<std::vector<std::uint32_t>>;

/// Groups of free particles, no two of a group with a neighbour in common.
Graph independentGroups(const System& system, const Graph& neighbours) {
  Graph groups;
  std::vector<std::size_t> group(neighbours.size(), SIZE_MAX);
  std::vector<std::size_t> seen_for;  // the last particle that may not be in the group
  for (std::uint32_t i = 0; i < neighbours.size(); ++i) {
    if (system.pinned(i)) continue;
    for (const std::uint32_t j : neighbours[i]) {
      for (const std::uint32_t k : neighbours[j]) {
        if (group[k] != SIZE_MAX) seen_for[group[k]] = i;
      }
    }
    const auto free = std::find_if(seen_for.begin(), seen_for.end(),
                                   [&](std::size_t particle) { return particle != i; });
    group[i] = free - seen_for.begin();
    if (free == seen_for.end()) {
      groups.emplace_back();
      seen_for.push_back(SIZE_MAX);
    }
    groups[group[i]].push_back(i);
  }
  return groups;
}

/// A thousandth of the shortest arc to a neighbour, in bounds that keep rounding small [rad].
double stepOf(std::uint32_t particle, const std::vector<std::uint32_t>& neighbours,
              const Points& positions) {
  double shortest = 1;
  for (const std::uint32_t other : neighbours) {
    if (other == particle) continue;
    shortest = std::min(shortest, arc(positions.col(particle), positions.col(other)).angle);
  }
  return 1e-3 * std::max(shortest, 1e-3);
}

class Differences {
 public:
  Differences(const System& system, const Points& positions)
      : system_(system),
        positions_(positions),
        neighbours_(neighbours(system)),
        unknown_(positions.cols(), SIZE_MAX),
        steps_(positions.cols()) {
    for (Eigen::Index i = 0; i < positions.cols(); ++i) {
      steps_[i] = stepOf(static_cast<std::uint32_t>(i), neighbours_[i], positions);
      frames_.push_back(tangentFrame(positions.col(i)));
      if (!system.pinned(i)) unknown_[i] = 2 * free_count_++;
    }
  }

  SparseMatrix hessian() {
    for (const auto& group : independentGroups(system_, neighbours_)) {
      for (int axis = 0; axis < 2; ++axis) addColumns(group, axis);
    }
    SparseMatrix columns(2 * free_count_, 2 * free_count_);
    columns.setFromTriplets(entries_.begin(), entries_.end());
    return symmetric(columns);
  }

 private:
  void addColumns(const std::vector<std::uint32_t>& group, int axis) {
    constexpr std::array<double, 4> kShifts = {-2, -1, 1, 2};
    constexpr std::array<double, 4> kWeights = {1. / 12, -2. / 3, 2. / 3, -1. / 12};
    for (int shift = 0; shift < 4; ++shift) {
      Points turned = positions_;
      for (const std::uint32_t i : group) {
        turned.col(i) = rotated(positions_.col(i), kShifts[shift] * steps_[i] * axisOf(i, axis));
      }
      system_.evaluate(turned, workspace_);
      for (const std::uint32_t i : group) {
        for (const std::uint32_t j : neighbours_[i]) {
          if (unknown_[j] == SIZE_MAX) continue;
          TangentFrame frame = frames_[j];
          if (i == j) {
            const int other = 1 - axis;
            frame.col(other) = turned.col(j).cross(frame.col(axis)) * (other == 1 ? 1 : -1);
          }
          const Eigen::Vector2d torque = frame.transpose() * workspace_.torques.col(j);
          for (int row = 0; row < 2; ++row) {
            entries_.emplace_back(unknown_[j] + row, unknown_[i] + axis,
                                  -kWeights[shift] * torque[row] / steps_[i]);
          }
        }
      }
    }
  }

  /// The mean of the matrix and its transpose, weighted by the variance that the rounding of a
  /// row's torques gives to its entries: beside a stiff particle it is the soft one's row that
  /// counts.
  SparseMatrix symmetric(const SparseMatrix& columns) const {
    const Eigen::VectorXd variance =
        columns.diagonal().cwiseAbs2().cwiseMax(std::numeric_limits<double>::min());
    SparseMatrix result = columns;
    const SparseMatrix transposed = columns.transpose();
    for (Eigen::Index j = 0; j < result.outerSize(); ++j) {
      SparseMatrix::InnerIterator other(transposed, j);
      for (SparseMatrix::InnerIterator entry(result, j); entry; ++entry, ++other) {
        const double own = variance[entry.row()], others = variance[j];
        entry.valueRef() = (entry.value() * others + other.value() * own) / (own + others);
      }
    }
    return result;
  }

  Vector3 axisOf(std::uint32_t particle, int axis) const { return frames_[particle].col(axis); }

  const System& system_;
  const Points& positions_;
  const Graph neighbours_;
  std::vector<std::size_t> unknown_;  // the first of each particle's two
  std::vector<double> steps_;
  std::vector<TangentFrame> frames_;
  std::size_t free_count_ = 0;
  System::Workspace workspace_;
  std::vector<Eigen::Triplet<double>> entries_;
};

}  // namespace

Graph neighbours(const System& system) {
  Graph result(system.particleCount());
  for (std::uint32_t i = 0; i < result.size(); ++i) result[i].push_back(i);
  forEachKind([&](auto kind) {
    for (const auto& spring : system.springs<typename decltype(kind)::type>()) {
      for (const std::uint32_t i : spring.particles) {
        result[i].insert(result[i].end(), spring.particles.begin(), spring.particles.end());
      }
    }
  });
  for (auto& list : result) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return result;
}

SparseMatrix differenceHessian(const System& system, const Points& positions) {
  return Differences(system, positions).hessian();
}

}  // namespace benchmark_scenes
