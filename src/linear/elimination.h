// The elimination of a front, which elimination_*.cpp compile for each instruction set.
#pragma once

#include <Eigen/Cholesky>

#include "linear/elimination_kernels.h"
#include "linear/small_elimination.h"

namespace spherical_springs::core {
namespace {

using Matrix = Eigen::Map<Eigen::MatrixXd>;

constexpr std::ptrdiff_t kPanel = 128;  // columns between interludes; fewer cost time

/// Eliminates the unknowns of a panel of columns, and takes them from all further columns.
bool eliminatePanel(Matrix& own, Matrix& below, std::ptrdiff_t begin, std::ptrdiff_t width) {
  const std::ptrdiff_t end = begin + width, after = own.cols() - end;
  Eigen::Ref<Eigen::MatrixXd> corner = own.block(begin, begin, width, width);
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(corner);
  if (factor.info() != Eigen::Success) return false;
  const auto triangle = corner.triangularView<Eigen::Lower>().transpose();
  auto beside = own.block(end, begin, after, width);
  if (after > 0) {
    triangle.solveInPlace<Eigen::OnTheRight>(beside);
    own.bottomRightCorner(after, after).triangularView<Eigen::Lower>() -=
        beside * beside.transpose();
  }
  if (below.rows() == 0) return true;
  auto rows = below.middleCols(begin, width);
  triangle.solveInPlace<Eigen::OnTheRight>(rows);
  if (after > 0) below.rightCols(after).noalias() -= rows * beside.transpose();
  return true;
}

bool eliminate(const FrontMatrix& front, const Interlude& interlude) {
  if (front.own_size < kPanel) return eliminateSmall(front);  // Eigen's preparations cost more
  Matrix own(front.own, front.own_size, front.own_size);
  Matrix below(front.below, front.rest_size, front.own_size);
  Matrix rest(front.rest, front.rest_size, front.rest_size);
  const auto widthFrom = [](std::ptrdiff_t begin, std::ptrdiff_t end) {
    return end - begin < kPanel ? end - begin : kPanel;
  };
  for (std::ptrdiff_t begin = 0; begin < own.cols(); begin += kPanel) {
    interlude.call(interlude.data);
    if (!eliminatePanel(own, below, begin, widthFrom(begin, own.cols()))) return false;
  }
  for (std::ptrdiff_t begin = 0; begin < rest.cols(); begin += kPanel) {
    interlude.call(interlude.data);
    const std::ptrdiff_t width = widthFrom(begin, rest.cols()), rows = rest.rows() - begin;
    rest.block(begin, begin, rows, width).noalias() =
        -below.bottomRows(rows) * below.middleRows(begin, width).transpose();
  }
  return true;
}

constexpr EliminationKernels kKernels{eliminate};

}  // namespace
}  // namespace spherical_springs::core
