// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/joint_dynamics.hpp"

namespace hjt
{
/// All teeth at the joint's present angles, for output.
///
/// While the joint runs on the response surface its own ring stays where it was: a second ring is brought to the
/// present angles instead, so that looking changes nothing in the run. Allocates at construction only.
class ObservedRing
{
public:
  /// `model` must outlive this.
  ObservedRing(const RingModel& model, const SolverParameters& parameters) : ring_(model, parameters) {}

  void setModel(const RingModel& copied) noexcept { ring_.setModel(copied); }  ///< see RingEquilibrium

  /// To be called after a reset of the joint or an edit of its model.
  void restart() noexcept { started_ = false; }

  /// The ring in equilibrium at the present angles; null: none was found. Valid until the joint's next step.
  const RingEquilibrium* at(const JointDynamics& joint) noexcept
  {
    if (!joint.onSurface())
    {
      return &joint.ring();
    }
    // From the joint's own ring, which is in equilibrium at the angles of its last use.
    started_ = started_ || ring_.solveFrom(joint.ring().shape().points, joint.ring().position()).ok();
    return started_ && ring_.moveTo(joint.position()).ok() ? &ring_ : nullptr;
  }

private:
  RingEquilibrium ring_;
  bool started_{};
};
}  // namespace hjt
