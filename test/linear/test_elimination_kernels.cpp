// The kernels of every instruction set that this processor has against the definition.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/instruction_set.h"
#include "linear/elimination_kernels.h"
#include "support/scenes.h"

namespace spherical_springs::core {

extern const EliminationKernels kPlainEliminationKernels;
#if defined(__x86_64__)
extern const EliminationKernels kAvx2EliminationKernels, kAvx512EliminationKernels;
#endif

namespace {

std::vector<EliminationKernels> kernelsHere() {
  std::vector<EliminationKernels> kernels = {kPlainEliminationKernels};
#if defined(__x86_64__)
  if (hasAvx2()) kernels.push_back(kAvx2EliminationKernels);
  if (hasAvx512()) kernels.push_back(kAvx512EliminationKernels);
#endif
  return kernels;
}

Eigen::MatrixXd randomDefinite(Eigen::Index size) {
  testing::Random random(7);
  Eigen::MatrixXd root(size, size);
  for (Eigen::Index i = 0; i < root.size(); ++i) root(i) = random.between(-1, 1);
  return root * root.transpose() + Eigen::MatrixXd::Identity(size, size);
}

struct Parts {
  Parts(const Eigen::MatrixXd& matrix, Eigen::Index own_size)
      : own(matrix.topLeftCorner(own_size, own_size)),
        below(matrix.bottomLeftCorner(matrix.rows() - own_size, own_size)),
        rest(Eigen::MatrixXd::Constant(below.rows(), below.rows(), std::nan(""))) {}
  FrontMatrix view() { return {own.data(), below.data(), rest.data(), own.rows(), rest.rows()}; }

  Eigen::MatrixXd own, below, rest;
};

TEST(EliminationKernels, LeaveTheFactorAndWhatItAddsToTheRest) {
  for (const EliminationKernels& kernels : kernelsHere()) {
    for (const auto& [own, rest] : {std::pair{1, 0}, {2, 4}, {7, 3}, {60, 100}, {131, 90}}) {
      const Eigen::MatrixXd matrix = randomDefinite(own + rest);
      Parts parts(matrix, own);
      ASSERT_TRUE(kernels.eliminate(parts.view()));
      const Eigen::MatrixXd factor = parts.own.triangularView<Eigen::Lower>();
      const Eigen::MatrixXd added = parts.rest.selfadjointView<Eigen::Lower>();
      const double rounding = 1e-13 * matrix.norm();
      const Parts was(matrix, own);
      EXPECT_LT((factor * factor.transpose() - was.own).norm(), rounding);
      EXPECT_LT((parts.below * factor.transpose() - was.below).norm(), rounding);
      EXPECT_LE((parts.below * parts.below.transpose() + added).norm(), rounding);
    }
  }
}

TEST(EliminationKernels, TellWhatIsNotDefinite) {
  for (const EliminationKernels& kernels : kernelsHere()) {
    Eigen::MatrixXd matrix = randomDefinite(90);
    matrix(70, 70) = -1;
    Parts parts(matrix, 80);
    EXPECT_FALSE(kernels.eliminate(parts.view()));
  }
}

}  // namespace
}  // namespace spherical_springs::core
