// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/statics/tooth_stress.hpp"
#include "solver/ring_equilibrium.hpp"
#include "statics/gear_rules.hpp"

namespace hjt
{
/// Length of the rim between two teeth, in which all its bending takes place [m].
inline double toothSpace(const GearParameters& gear, const StressParameters& stress) noexcept
{
  return segmentLength(gear) * (1.0 - stress.tooth_base);
}

/// Stress of the flexspline from the shape of its ring: what the rim's bending and tension, and the torque through the
/// cup, do at the three places where it breaks. docs/life.md derives it.
///
///   tooth space  E t/2 eta / (p (1 - c)) + N / (b t)   the rim bends between rigid teeth alone
///   transition   E s/(2 (1 - nu)) k z/L                the wall follows the rim, which cones,
///                + q E s/(1 - nu^2) (f^2 d + f m)      and bends along the axis as far as the rim does not
///   flange       h E k r^3 / (6 L^2)                   the end of the cup does not warp freely
///   wall         C / (2 pi r^2 s), shear               transition and flange
/// where eta  turn of the rim at a tooth, less that at rest [rad]; k = eta/p [1/m]
///       p, c tooth pitch; share of it that the tooth takes
///       N    tension, mean of both sides of the tooth
///       t, s thickness of rim and wall; b face width; L, z: from the flange to the middle and to the end of the teeth
///       w    k r^2/3, how far the rim stands out; d = w (1 - z/L), m = w/L: mismatch of a rim that does not cone
///       f    (3 (1 - nu^2))^(1/4) / sqrt(r s), how fast the wall's edge bending fades [1/m]
///       q, h stress.coning_restraint, stress.warping_restraint; C: torque of the cup
/// A cracked segment has its net section. It follows from the curvature alone: ring.bending_stiffness shapes the ring,
/// but does not enter the stress.
class FlexsplineStress
{
public:
  explicit FlexsplineStress(const Parameters& parameters);

  /// `stress`: sized for the ring's teeth; that of tooth i goes to i + `shift`. No allocation.
  void at(const RingEquilibrium& ring, int shift, ToothStress& stress) const noexcept;

  /// The two parts of the stress in the tooth spaces beside tooth i [Pa].
  struct Parts
  {
    double bending;
    double tension;
  };
  Parts inToothSpace(const RingEquilibrium& ring, int i) const noexcept { return parts(ring, i, turn(ring, i)); }

  /// The same of a sound rim by its turn at the tooth [rad] and its mean tension there [N].
  double inToothSpace(double turn, double tension) const noexcept
  {
    return by_turn_[static_cast<std::size_t>(StressPlace::TOOTH_SPACE)] * turn + tension / section_;
  }

private:
  static double turn(const RingEquilibrium& ring, int i) noexcept;
  Parts parts(const RingEquilibrium& ring, int i, double turn) const noexcept;

  double tension_stiffness_;                     // of a sound segment [N/m]
  double section_;                               // of the rim [m^2]
  std::array<double, STRESS_PLACES> by_turn_{};  // of the rim at a tooth [Pa/rad]
  double shear_by_torque_;                       // [Pa/(N.m)]
};
}  // namespace hjt
