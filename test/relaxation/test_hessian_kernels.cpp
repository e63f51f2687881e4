// The kernels of every instruction set that this processor has against the springs' own formulas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/instruction_set.h"
#include "relaxation/hessian_kernels.h"
#include "relaxation/tangent_energy.h"
#include "support/scenes.h"

namespace spherical_springs::core {

extern const HessianKernels kPlainHessianKernels;
#if defined(__x86_64__)
extern const HessianKernels kAvx2HessianKernels, kAvx512HessianKernels;
#endif

namespace {

using testing::Random;

std::vector<HessianKernels> kernelsHere() {
  std::vector<HessianKernels> kernels = {kPlainHessianKernels};
#if defined(__x86_64__)
  if (hasAvx2()) kernels.push_back(kAvx2HessianKernels);
  if (hasAvx512()) kernels.push_back(kAvx512HessianKernels);
#endif
  return kernels;
}

template <class Spring>
HessianKernel<Spring::kParticles> kernelOf(const HessianKernels& kernels) {
  if constexpr (Spring::kParticles == 2) {
    return kernels.angle_springs;
  } else {
    return kernels.solid_angle_springs;
  }
}

template <class Spring>
auto& restOf(Spring& spring) {
  if constexpr (Spring::kParticles == 2) {
    return spring.rest_angle;
  } else {
    return spring.rest_solid_angle;
  }
}

/// Springs, each on particles and blocks of its own, and what a kernel has made of them.
template <class Spring>
struct Bench {
  static constexpr std::size_t N = Spring::kParticles;

  std::vector<Spring> springs;
  std::vector<TangentPlace> at;
  std::vector<std::array<std::uint32_t, N * N>> places;
  std::uint32_t free_count = 0;
  std::vector<Eigen::Vector2d> gradient;  // of pinned particles too, which must stay 0
  std::vector<Eigen::Matrix2d> hessian;
  std::vector<std::uint32_t> left_out;
  double energy = 0;

  /// `size`: largest distance of the ends of a spring, of those of random ones. A `pinned` share of
  /// the particles is.
  Bench(std::uint32_t count, double size, double pinned, unsigned seed) {
    Random random(seed);
    std::vector<std::uint32_t> rows(N * count);
    std::iota(rows.begin(), rows.end(), 0);
    for (std::size_t i = rows.size(); i > 1; --i) {
      std::swap(rows[i - 1], rows[random.below(static_cast<std::uint32_t>(i))]);
    }
    at.resize(rows.size());
    free_count = static_cast<std::uint32_t>((1 - pinned) * static_cast<double>(rows.size()));
    std::uint32_t blocks = 0;
    for (std::uint32_t s = 0; s < count; ++s) {
      Spring spring;
      for (std::size_t i = 0; i < N; ++i) spring.particles[i] = rows[N * s + i];
      const Vector3 first = random.unitVector();
      std::array<Vector3, N> ends = random.unitVectors<N>();
      for (Vector3& end : ends) end = (first + size * (end - first)).normalized();
      rest(spring, ends);
      restOf(spring) *= random.between(0.5, 1.5);
      spring.stiffness = random.between(0.5, 2);
      springs.push_back(spring);
      put(s, ends, random);
      places.emplace_back();
      for (std::size_t i = 0; i < N; ++i) {
        for (std::size_t j = 0; j < N; ++j) {
          const bool stored = std::max(spring.particles[i], spring.particles[j]) < free_count;
          places[s][N * i + j] = stored ? blocks++ : HessianArrays::kNotStored;
        }
      }
    }
    hessian.resize(blocks);
  }

  void put(std::uint32_t s, const std::array<Vector3, N>& ends, Random& random) {
    for (std::size_t i = 0; i < N; ++i) {
      const double turn = random.between(0, 6);  // frames of any direction
      Eigen::Matrix2d turned;
      turned << std::cos(turn), -std::sin(turn), std::sin(turn), std::cos(turn);
      at[springs[s].particles[i]] = {tangentFrame(ends[i]) * turned, ends[i]};
    }
  }

  void run(const HessianKernels& kernels, Curvature curvature) {
    gradient.assign(at.size(), Eigen::Vector2d::Zero());
    std::fill(hessian.begin(), hessian.end(), Eigen::Matrix2d::Zero());
    const SpringFields<N> fields = {{springs[0].particles.data(), sizeof(Spring)},
                                    {&restOf(springs[0]), sizeof(Spring)},
                                    {&springs[0].stiffness, sizeof(Spring)},
                                    {places.data(), sizeof(places[0])}};
    const HessianArrays arrays = {at[0].frame.data(),
                                  free_count,
                                  gradient[0].data(),
                                  hessian[0].data(),
                                  curvature == Curvature::definite,
                                  leastCurvature(curvature)};
    const auto count = static_cast<std::uint32_t>(springs.size());
    left_out.resize(count);
    std::uint32_t left_out_count = 0;
    energy = kernelOf<Spring>(kernels)(fields, 0, count, arrays, left_out.data(), left_out_count);
    left_out.resize(left_out_count);
  }

  /// Against tangentCondition; nothing of those left out.
  void check(Curvature curvature) const {
    constexpr double kRelative = 1e-13;
    double expected_energy = 0, energy_scale = 0;
    for (std::uint32_t s = 0; s < springs.size(); ++s) {
      const Spring& spring = springs[s];
      const bool is_left_out = std::count(left_out.begin(), left_out.end(), s) > 0;
      const double k = is_left_out ? 0 : spring.stiffness;
      std::array<Vector3, N> ends;
      std::array<TangentFrame, N> end_frames;
      for (std::size_t i = 0; i < N; ++i) {
        ends[i] = at[spring.particles[i]].point;
        end_frames[i] = at[spring.particles[i]].frame;
      }
      const auto c = tangentCondition(spring, ends, end_frames, curvature);
      const double value = std::abs(c.value) + std::abs(restOf(spring));
      double slope = 0, bend = 0;
      for (std::size_t i = 0; i < N; ++i) {
        slope = std::max(slope, c.gradient[i].norm());
        for (std::size_t j = 0; j < N; ++j) bend = std::max(bend, c.hessian[i][j].norm());
      }
      expected_energy += 0.5 * k * c.value * c.value;
      energy_scale += 0.5 * k * value * value;
      for (std::size_t i = 0; i < N; ++i) {
        const bool free = spring.particles[i] < free_count;
        const Eigen::Vector2d torque = free ? k * c.value * c.gradient[i] : 0 * c.gradient[i];
        EXPECT_LE((gradient[spring.particles[i]] - torque).norm(), kRelative * k * value * slope)
            << "spring " << s;
        for (std::size_t j = 0; j < N; ++j) {
          if (places[s][N * i + j] == HessianArrays::kNotStored) continue;
          const Eigen::Matrix2d block =
              k * (c.gradient[i] * c.gradient[j].transpose() + c.value * c.hessian[i][j]);
          EXPECT_LE((hessian[places[s][N * i + j]] - block).norm(),
                    kRelative * k * (slope * slope + value * bend))
              << "spring " << s << ", block " << i << ", " << j;
        }
      }
    }
    EXPECT_NEAR(energy, expected_energy, kRelative * energy_scale);
  }
};

constexpr Curvature kCurvatures[] = {Curvature::exact, Curvature::tempered, Curvature::definite};

template <class Spring>
class HessianKernelsOf : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kCount = 43, kWhole = 40;  // the rest does not fill the lanes

  /// For all kernels and curvatures; `whole`: how many springs are to be computed.
  void check(double size, double pinned, std::uint32_t whole) {
    for (const HessianKernels& kernels : kernelsHere()) {
      for (const Curvature curvature : kCurvatures) {
        Bench<Spring> bench(kCount, size, pinned, 1);
        bench.run(kernels, curvature);
        std::vector<std::uint32_t> expected(kCount - whole);
        std::iota(expected.begin(), expected.end(), whole);
        EXPECT_EQ(bench.left_out, expected) << "at size " << size;
        bench.check(curvature);
      }
    }
  }
};
using KindsWithKernel = ::testing::Types<AngleSpring, SolidAngleSpring>;
TYPED_TEST_SUITE(HessianKernelsOf, KindsWithKernel, );

TYPED_TEST(HessianKernelsOf, OrdinarySpringsAreThoseOfTheConditions) {
  for (const double size : {0.3, 0.1, 0.01}) this->check(size, 0, this->kWhole);
}

TYPED_TEST(HessianKernelsOf, TinySpringsAreThoseOfTheConditions) {
  for (const double size : {1e-4, 1e-6, 1e-7}) this->check(size, 0, this->kWhole);
}

TYPED_TEST(HessianKernelsOf, PinnedEndsTakeNothing) {
  for (const double share : {0.2, 0.5, 0.9}) this->check(0.2, share, this->kWhole);
}

TEST(HessianKernelsOfArcs, TakeArcsOfAnyLength) {
  for (const HessianKernels& kernels : kernelsHere()) {
    for (const Curvature curvature : kCurvatures) {
      for (const double size : {0.7, 1., 2.}) {
        Bench<AngleSpring> bench(1003, size, 0.1, 4);
        bench.run(kernels, curvature);
        EXPECT_EQ(bench.left_out.size(), 3) << "at size " << size;
        bench.check(curvature);
      }
    }
  }
}

TEST(HessianKernelsOfArcs, TakeArcsNextToThePlacesWhereTheirFormulaChanges) {
  Random random(5);
  for (const HessianKernels& kernels : kernelsHere()) {
    for (const Curvature curvature : kCurvatures) {
      Bench<AngleSpring> bench(40, 0.2, 0, 6);
      std::uint32_t s = 0;
      for (const double angle : {kPi / 3, kPi / 2, 2 * kPi / 3, kPi - 1e-3}) {
        for (const double change : {-1e-6, 0., 1e-6}) {
          const Vector3 end = random.unitVector();
          bench.put(s++, {end, rotated(end, (angle + change) * perpendicular(end))}, random);
        }
      }
      bench.run(kernels, curvature);
      EXPECT_TRUE(bench.left_out.empty());
      bench.check(curvature);
    }
  }
}

// One that is too long takes with it those that are computed at the same time, and no others.
TYPED_TEST(HessianKernelsOf, LongSpringsAreLeftOut) {
  for (const HessianKernels& kernels : kernelsHere()) {
    for (const Curvature curvature : kCurvatures) {
      Bench<TypeParam> bench(this->kCount, 0.2, 0.1, 2);
      Random random(3);
      std::array<Vector3, TypeParam::kParticles> ends;
      ends.fill(Vector3(0.6, -0.48, 0.64));
      const double lacking = TypeParam::kParticles == 2 ? 1e-7 : 0.1;  // to antipodal ends
      ends.back() = -rotated(ends[0], lacking * perpendicular(ends[0]));
      bench.put(19, ends, random);
      bench.run(kernels, curvature);
      const std::vector<std::uint32_t> of_four = {16, 17, 18, 19, 40, 41, 42};
      const std::vector<std::uint32_t> of_eight = {16, 17, 18, 19, 20, 21, 22, 23, 40, 41, 42};
      EXPECT_TRUE(bench.left_out == of_four || bench.left_out == of_eight)
          << ::testing::PrintToString(bench.left_out);
      bench.check(curvature);
    }
  }
}

// Springs of any length are computed right, or reported as left out.
TYPED_TEST(HessianKernelsOf, SpringsOfAnySizeAreRightOrLeftOut) {
  std::size_t left_out = 0, all = 0;
  for (const double size : {0.8, 0.55, 0.5, 0.4, 0.3}) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
      for (const HessianKernels& kernels : kernelsHere()) {
        for (const Curvature curvature : kCurvatures) {
          Bench<TypeParam> bench(8, size, 0.1, seed);
          bench.run(kernels, curvature);
          bench.check(curvature);
          left_out += bench.left_out.size();
          all += 8;
        }
      }
    }
  }
  const bool takes_all = TypeParam::kParticles == 2;
  EXPECT_EQ(left_out > all / 10, !takes_all);
  EXPECT_LT(left_out, 9 * all / 10);
}

TEST(HessianKernels, LeaveOutArcsThatRoundingHasTheDirectionOf) {
  for (const double size : {1e-8, 1e-12, 0.}) {
    Bench<AngleSpring> bench(16, size, 0, 4);
    for (const HessianKernels& kernels : kernelsHere()) {
      bench.run(kernels, Curvature::exact);
      EXPECT_EQ(bench.left_out.size(), 16) << size;
      EXPECT_EQ(bench.energy, 0);
    }
  }
}

}  // namespace
}  // namespace spherical_springs::core
