// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/statics/tooth_stress.hpp"
#include "solver/ring_equilibrium.hpp"
#include "statics/gear_rules.hpp"

namespace hjt
{
/// Length of the rim between two teeth, which does all of the bending [m].
inline double toothSpace(const GearParameters& gear, const StressParameters& stress) noexcept
{
  return segmentLength(gear) * (1.0 - stress.tooth_base);
}

/// Stress of the flexspline by the shape of its ring: the effect of the rim's bending and tension, and of the cup's
/// torque, at the three places where it breaks. docs/life.md gives the derivation.
///
///   tooth space  E t/2 eta / (p (1 - c)) + N / (b t)   the rim bends only between the rigid teeth
///   transition   E s/(2 (1 - nu)) k z/L                the wall follows the coning rim
///                + q E s/(1 - nu^2) (f^2 d + f m)      and bends along the axis where the rim does not cone
///   flange       h E k r^3 / (6 L^2)                   the flange restrains the warping of the cup
///   wall         C / (2 pi r^2 s), shear               at transition and flange
/// where eta  rotation of the rim at a tooth, minus that at rest [rad]; k = eta/p [1/m]
///       p, c tooth pitch; share of the pitch that the tooth's base takes
///       N    tension, mean of both sides of the tooth
///       t, s thickness of rim and wall; b face width; L, z: distance from the flange to middle and end of the teeth
///       w    k r^2/3, radial displacement of the rim; d = w (1 - z/L), m = w/L: mismatch of a rim that does not cone
///       f    (3 (1 - nu^2))^(1/4) / sqrt(r s), decay of the wall's edge bending [1/m]
///       q, h stress.coning_restraint, stress.warping_restraint; C: torque of the cup
/// A cracked segment has its net section. The stress depends on the curvature alone: ring.bending_stiffness changes the
/// shape of the ring, but is not part of the law.
class FlexsplineStress
{
public:
  explicit FlexsplineStress(const Parameters& parameters);

  /// Stress at each tooth; `stress` must have the ring's number of teeth. The stress of tooth i has index i + `shift`.
  /// The function does not allocate.
  void at(const RingEquilibrium& ring, int shift, ToothStress& stress) const noexcept;

  /// The two parts, bending and tension, of the stress in the tooth spaces beside tooth i [Pa].
  struct Parts
  {
    double bending;
    double tension;
  };
  Parts inToothSpace(const RingEquilibrium& ring, int i) const noexcept { return parts(ring, i, turn(ring, i)); }

  /// Stress of a sound rim for its rotation at the tooth [rad] and its mean tension there [N].
  double inToothSpace(double turn, double tension) const noexcept
  {
    return by_turn_[static_cast<std::size_t>(StressPlace::TOOTH_SPACE)] * turn + tension / section_;
  }

private:
  static double turn(const RingEquilibrium& ring, int i) noexcept;
  Parts parts(const RingEquilibrium& ring, int i, double turn) const noexcept;

  double tension_stiffness_;                     // stiffness of a sound segment [N/m]
  double section_;                               // section of the rim [m^2]
  std::array<double, STRESS_PLACES> by_turn_{};  // stress per rotation of the rim at a tooth [Pa/rad]
  double shear_by_torque_;                       // shear stress per torque [Pa/(N.m)]
};

/// S-N curve of the flexspline: Basquin's line to the endurance limit at its knee, beyond it a loss of 5 % of strength
/// in a decade (Sonsino, Int. J. Fatigue 29, 2007), Goodman's mean stress correction, Peterson's notch sensitivity.
/// Sources: docs/life.md.
class FatigueLaw
{
public:
  FatigueLaw(const LifeParameters& life, const StressParameters& stress)
    : ultimate_(life.ultimate_strength)
    , limit_(life.endurance_limit)
    , cycles_(life.endurance_cycles)
    , exponent_(life.fatigue_exponent)
  {
    const double length = 0.0254e-3 * std::pow(2070e6 / ultimate_, 1.8);  // Peterson's length for steels [m]
    for (std::size_t place = 0; place < STRESS_PLACES; ++place)
    {
      const double sensitivity = 1.0 / (1.0 + length / stress.notch_radius[place]);
      notch_factor_[place] = 1.0 + sensitivity * (stress.concentration[place] - 1.0);
    }
  }

  /// Fatigue notch factor at a place [-].
  double notchFactor(std::size_t place) const noexcept { return notch_factor_[place]; }

  /// Amplitude at zero mean stress that does the same damage at the notch of a place [Pa]. Mean compression has no
  /// effect.
  double equivalentAmplitude(std::size_t place, const StressCycle& cycle) const noexcept
  {
    constexpr double LEAST_MARGIN = 1e-3;  // an immediate failure counts as a large amplitude
    const double mean =
        notch_factor_[place] * StressCycle::equivalent(std::max(cycle.mean(), 0.0), cycle.shear) / ultimate_;
    return notch_factor_[place] * cycle.amplitude() / std::max(1.0 - mean, LEAST_MARGIN);
  }

  /// Equivalent amplitude over the endurance limit [-].
  double enduranceShare(std::size_t place, const StressCycle& cycle) const noexcept
  {
    return equivalentAmplitude(place, cycle) / limit_;
  }

  /// Damage by one cycle, the inverse of the cycles to failure [-]. `share`: amplitude over the endurance limit.
  /// `overloaded`: there are also cycles above the limit, so that those below it do damage (Haibach, exponent 2 k - 1).
  /// Otherwise only the part of the curve beyond its knee applies.
  double damage(double share, bool overloaded) const noexcept
  {
    constexpr double BEYOND_KNEE = 45.0;  // 5 % in a decade
    const double below = overloaded ? 2.0 * exponent_ - 1.0 : BEYOND_KNEE;
    return std::pow(share, share < 1.0 ? below : exponent_) / cycles_;
  }

private:
  double ultimate_;
  double limit_;
  double cycles_;
  double exponent_;
  std::array<double, STRESS_PLACES> notch_factor_{};
};

/// Miner's sum over the loads of one place. Loads below the endurance limit do more damage if any load is above it.
class MinerSum
{
public:
  /// `share`: amplitude over the endurance limit of the given strength.
  void add(const FatigueLaw& law, double cycles, double share) noexcept
  {
    if (share >= 1.0)
    {
      above_ += cycles * law.damage(share, true);
      return;
    }
    below_ += cycles * law.damage(share, true);
    alone_ += cycles * law.damage(share, false);
  }

  double sum() const noexcept { return above_ > 0.0 ? above_ + below_ : alone_; }

private:
  double alone_{};  // damage of loads below the limit if none is above
  double below_{};  // damage of loads below the limit if some are above
  double above_{};
};
}  // namespace hjt
