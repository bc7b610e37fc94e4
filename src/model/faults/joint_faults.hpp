// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "harmonic_joint_twin/model/faults/fault_list.hpp"
#include "model/faults/fault_edits.hpp"
#include "model/joint_model.hpp"

namespace hjt
{
/// Where the crack at a tooth's root runs, by the backup ratio rim thickness / tooth height (thesis 3.4.2): through the
/// tooth above 1, into the rim below; between 0.4 and 1 it may do either, and the worse is taken.
bool rootCrackRunsThroughTooth(const GearParameters& gear) noexcept;

/// Edits a joint to its faults. It always starts from the sound joint, so a fault that has gone leaves nothing behind.
/// Allocates on construction only.
class JointFaults
{
public:
  /// `model`: sound as yet; must outlive this.
  JointFaults(const Parameters& parameters, JointModel& model);

  /// The joint with these faults, each valid, and no others.
  void apply(const FaultList& faults) noexcept;

private:
  void edit() noexcept;

  Parameters parameters_;
  JointModel& model_;
  FaultEdits edits_;
  Eigen::VectorXd mesh_stiffness_;  // of the sound joint
  Eigen::VectorXd tension_stiffness_;
  Eigen::VectorXd bending_stiffness_;
};

/// The joint of these parameters with the faults that it has from the start.
JointModel startingJoint(const Parameters& parameters);
}  // namespace hjt
