// Energies and torques of the springs at given positions, several springs at a time.
#pragma once

#include <vector>

#include "spherical_springs/plan.h"
#include "stepping/layout.h"
#include "stepping/scratch.h"
#include "stepping/step_kernels.h"

namespace spherical_springs::core {

/// The plan must live longer. Results do not depend on the number of threads, to the last bit.
class Evaluation {
 public:
  /// `positions`: one column a particle, in the order of ids.
  Evaluation(const Plan& plan, const Points& positions, const StepKernels& kernels = stepKernels());

  PotentialEnergies potential() const;

  /// Largest torque of the springs on a particle that is not pinned [N m].
  double maxTorque() const;

  struct LargestTorque {
    double torque = 0;  ///< [N m]
    double excess = 0;  ///< as a multiple of what is allowed; of another particle, maybe
  };

  /// `allowed`: [N m], one a particle in the order of ids.
  LargestTorque largestTorque(const Eigen::VectorXd& allowed) const;

 private:
  int threads() const;
  template <class Work>
  void forEachPatch(const Work& work) const;
  PotentialEnergies potentialOf(const Patch& patch) const;
  template <class Group>
  void addEnergies(Kind<Group>, const Patch& patch, Scratch& scratch,
                   PotentialEnergies& energies) const;
  template <class Visit>
  void forEachTorque(const Patch& patch, const Visit& visit) const;

  const System& system_;
  const Layout& layout_;
  const StepKernels& kernels_;
  std::vector<Row> positions_;
  mutable ScratchPool scratches_;  // for many threads
};

}  // namespace spherical_springs::core
