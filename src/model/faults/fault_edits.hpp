// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
class BearingSag;

/// What faults together change on a sound joint. Several on one part compose: factors multiply, lengths and forces add.
struct FaultEdits
{
  explicit FaultEdits(int teeth);

  void setNone() noexcept;

  Eigen::VectorXd mesh_stiffness;   ///< N, factor [-]
  Eigen::VectorXd clearance;        ///< N, more half clearance, across [m]
  Eigen::VectorXd tip_loss;         ///< N, height lost at the tip [m]
  Eigen::VectorXd flank_friction;   ///< N, factor [-]
  Eigen::VectorXd tension;          ///< N, factor on the stiffness of segment i [-]
  Eigen::VectorXd bending;          ///< N, factor on the stiffness at tooth i [-]
  Eigen::VectorXd preset;           ///< N, angle that the free rim keeps at tooth i [rad]
  Eigen::VectorXd contact_gap;      ///< N, between wave generator and rim [m]
  std::array<double, 2> lobe_wear;  ///< off the major semi-axis, by lobe [m]
  double preload_loss;              ///< of the bearing's outer race [N]
  double spaces_off_axis;           ///< of the circular spline [m]
  double cup_stiffness;             ///< factor [-]
  double cup_friction;              ///< factor [-]
  double viscosity;                 ///< factor [-]
  double mesh_friction;             ///< factor [-]
  double interface_friction;        ///< factor [-]
};

/// What one fault adds to the edits; `bearing` takes the spalls.
using FaultEdit = void (*)(const Fault& fault, const Parameters& parameters, FaultEdits& edits,
                           BearingSag& bearing) noexcept;

// One per kind; docs/faults.md says what each stands for.
void editInterfaceWear(const Fault&, const Parameters&, FaultEdits&, BearingSag&) noexcept;
void editRearSectionCrack(const Fault&, const Parameters&, FaultEdits&, BearingSag&) noexcept;
void editLubricantDegradation(const Fault&, const Parameters&, FaultEdits&, BearingSag&) noexcept;
void editToothWear(const Fault&, const Parameters&, FaultEdits&, BearingSag&) noexcept;
void editToothRootCrack(const Fault&, const Parameters&, FaultEdits&, BearingSag&) noexcept;
void editFlangeCrack(const Fault&, const Parameters&, FaultEdits&, BearingSag&) noexcept;
void editToothTipCrack(const Fault&, const Parameters&, FaultEdits&, BearingSag&) noexcept;
void editPitting(const Fault&, const Parameters&, FaultEdits&, BearingSag&) noexcept;
void editWaveGeneratorWear(const Fault&, const Parameters&, FaultEdits&, BearingSag&) noexcept;
void editFlexsplineCrack(const Fault&, const Parameters&, FaultEdits&, BearingSag&) noexcept;
void editBuckling(const Fault&, const Parameters&, FaultEdits&, BearingSag&) noexcept;
void editRatcheting(const Fault&, const Parameters&, FaultEdits&, BearingSag&) noexcept;
void editBearingInnerRace(const Fault&, const Parameters&, FaultEdits&, BearingSag&) noexcept;
void editBearingOuterRace(const Fault&, const Parameters&, FaultEdits&, BearingSag&) noexcept;
void editBearingBall(const Fault&, const Parameters&, FaultEdits&, BearingSag&) noexcept;
void editBearingCage(const Fault&, const Parameters&, FaultEdits&, BearingSag&) noexcept;

/// A crack into the rim behind a tooth, `severity` times fault_scale.rim_crack_depth of its thickness.
void crackRim(int segment, double severity, const Parameters& parameters, FaultEdits& edits) noexcept;

/// `change` the entry of a place, or to all for WHOLE_MEMBER.
template <class Change>
void atPlace(int place, Eigen::VectorXd& values, const Change& change) noexcept
{
  for (Eigen::Index i = 0; i < values.size(); ++i)
  {
    if (place == WHOLE_MEMBER || place == i)
    {
      change(values[i]);
    }
  }
}
}  // namespace hjt
