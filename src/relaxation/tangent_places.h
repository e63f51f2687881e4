// Where a minimisation has the particles, with frames of their tangent planes.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "geometry/tangent_place.h"
#include "relaxation/particle_order.h"

namespace spherical_springs::core {

/// Places of particles by their number in an order. The tangent coordinates of free particle f are
/// elements 2 f and 2 f + 1 of a step [rad], in the frame of its place.
class TangentPlaces {
 public:
  TangentPlaces(ParticleOrder order, int threads) : order_(std::move(order)), threads_(threads) {}

  const ParticleOrder& order() const { return order_; }
  std::size_t freeCount() const { return order_.free_count; }
  const TangentPlace& operator[](std::size_t number) const { return places_[number]; }

  /// Puts the particles at `positions`, one column a particle in the order of ids.
  void place(const Points& positions);
  /// Puts the particles at `positions`, with frames carried along from where they were.
  void carry(const Points& positions);
  /// Moves the free particles by a step and back onto the sphere along their radius, frames along
  /// with them.
  void move(const Eigen::VectorXd& step);
  /// Keeps the places, to go back to.
  void mark() { marked_ = places_; }
  void goBack() { places_ = marked_; }

  /// Returns the positions of all particles, one column a particle in the order of ids.
  Points positions() const;
  /// Returns the tangent vectors by which a step moves the particles, in the same order.
  Points moves(const Eigen::VectorXd& step) const;
  /// Returns for each free particle the matrix that takes a rotation vector of the scene to the
  /// particle's two coordinates.
  template <class Real>
  std::vector<Eigen::Matrix<Real, 2, 3>> rotations() const;

 private:
  ParticleOrder order_;
  int threads_;
  std::vector<TangentPlace> places_, marked_;
};

}  // namespace spherical_springs::core
