// The kernels of every instruction set that this processor has against the definition.
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <cmath>
#include <cstring>
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

const Interlude kNoInterlude{[](const void*) {}, nullptr};

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
    for (const auto& [own, rest] :
         {std::pair{1, 0}, {2, 4}, {7, 3}, {60, 100}, {131, 90}, {300, 0}, {280, 290}}) {
      const Eigen::MatrixXd matrix = randomDefinite(own + rest);
      Parts parts(matrix, own);
      ASSERT_TRUE(kernels.eliminate(parts.view(), kNoInterlude));
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

/// Memory followed by a page that must not be touched.
class GuardedMemory {
 public:
  explicit GuardedMemory(const Eigen::MatrixXd& content)
      : size_(content.size() * sizeof(double)), pages_((size_ + kPage - 1) / kPage) {
    base_ = static_cast<char*>(mmap(nullptr, (pages_ + 1) * kPage, PROT_READ | PROT_WRITE,
                                    MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    mprotect(base_ + pages_ * kPage, kPage, PROT_NONE);
    if (size_ > 0) std::memcpy(data(), content.data(), size_);
  }
  ~GuardedMemory() { munmap(base_, (pages_ + 1) * kPage); }
  GuardedMemory(const GuardedMemory&) = delete;
  GuardedMemory& operator=(const GuardedMemory&) = delete;

  double* data() { return reinterpret_cast<double*>(base_ + pages_ * kPage - size_); }

 private:
  static constexpr std::size_t kPage = 4096;
  std::size_t size_, pages_;
  char* base_;
};

TEST(EliminationKernels, ReadNothingBeyondTheirMatrices) {
  for (const EliminationKernels& kernels : kernelsHere()) {
    for (int own = 1; own < 12; ++own) {
      for (int rest = 0; rest < 20; ++rest) {
        Parts parts(randomDefinite(own + rest), own);
        GuardedMemory own_block(parts.own), below(parts.below), the_rest(parts.rest);
        EXPECT_TRUE(kernels.eliminate(
            {own_block.data(), below.data(), the_rest.data(), parts.own.rows(), parts.rest.rows()},
            kNoInterlude));
      }
    }
  }
}

TEST(EliminationKernels, TellWhatIsNotDefinite) {
  for (const EliminationKernels& kernels : kernelsHere()) {
    for (const auto& [own, wrong] : {std::pair{80, 70}, {300, 20}, {300, 290}}) {
      Eigen::MatrixXd matrix = randomDefinite(own + 10);
      matrix(wrong, wrong) = -1;
      Parts parts(matrix, own);
      EXPECT_FALSE(kernels.eliminate(parts.view(), kNoInterlude)) << own << " " << wrong;
    }
  }
}

TEST(EliminationKernels, MayBeLeftInTheMiddle) {
  struct Left {};
  for (const EliminationKernels& kernels : kernelsHere()) {
    Parts parts(randomDefinite(700), 300);
    int calls = 0;
    const Interlude count{[](const void* data) { ++**static_cast<int* const*>(data); }, nullptr};
    int* const counter = &calls;
    ASSERT_TRUE(kernels.eliminate(parts.view(), {count.call, &counter}));
    EXPECT_GT(calls, 5);
    const Interlude leave{[](const void*) { throw Left(); }, nullptr};
    EXPECT_THROW(kernels.eliminate(parts.view(), leave), Left);
  }
}

}  // namespace
}  // namespace spherical_springs::core
