// The elimination of a front, which elimination_*.cpp compile for each instruction set.
#pragma once

#include <Eigen/Cholesky>

#include "linear/elimination_kernels.h"
#include "linear/small_elimination.h"

namespace spherical_springs::core {
namespace {

bool eliminate(const FrontMatrix& front) {
  constexpr std::ptrdiff_t kSmall = 128;  // below which Eigen's preparations cost more
  if (front.own_size < kSmall) return eliminateSmall(front);
  using Matrix = Eigen::Map<Eigen::MatrixXd>;
  Matrix own(front.own, front.own_size, front.own_size);
  Matrix below(front.below, front.rest_size, front.own_size);
  Matrix rest(front.rest, front.rest_size, front.rest_size);
  Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(own);
  if (factor.info() != Eigen::Success) return false;
  if (front.rest_size == 0) return true;
  own.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(below);
  rest.triangularView<Eigen::Lower>() = -below * below.transpose();
  return true;
}

constexpr EliminationKernels kKernels{eliminate};

}  // namespace
}  // namespace spherical_springs::core
