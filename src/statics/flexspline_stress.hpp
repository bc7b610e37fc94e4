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
/// Length of the tooth space between two rigid teeth, where all of the rim's bending occurs [m].
inline double toothSpace(const GearParameters& gear, const StressParameters& stress) noexcept
{
  return segmentLength(gear) * (1.0 - stress.tooth_base);
}

/// Stress at the three places where a flexspline breaks, computed from bending and tension of the rim and the torque of
/// the cup. docs/life.md gives the derivation.
///
///   tooth space  E t/2 eta / (p (1 - c)) + N / (b t)   the rim bends only between the rigid teeth
///   transition   E s/(2 (1 - nu)) k z/L                the wall follows the coning rim
///                + q E s/(1 - nu^2) (f^2 d + f m)      and bends along the axis where the rim does not cone
///   flange       h E k r^3 / (6 L^2)                   the flange restrains the warping of the cup
///   wall         C / (2 pi r^2 s), shear               at transition and flange
/// where eta  rotation of the rim at a tooth, minus that at rest [rad]; k = eta/p [1/m]
///       p, c tooth pitch [m]; share of the pitch that the tooth's base takes
///       N    tension of the rim, mean of both sides of the tooth [N]; E, nu: elastic modulus [Pa], Poisson's ratio
///       t, s thickness of rim and wall; b face width; r radius; L, z distance from flange to middle, end of teeth [m]
///       w    k r^2/3, radial displacement of the rim; d = w (1 - z/L), m = w/L: mismatch of a rim that does not cone
///       f    (3 (1 - nu^2))^(1/4) / sqrt(r s), decay of the wall's edge bending [1/m]
///       q, h stress.coning_restraint, stress.warping_restraint; C: torque of the cup [N.m]
/// For a cracked segment the law uses the section that the crack leaves. The bending stress depends on the curvature
/// alone: ring.bending_stiffness changes the shape of the ring, but is not part of the law.
class FlexsplineStress
{
public:
  explicit FlexsplineStress(const Parameters& parameters);

  /// Computes the stress at each tooth. `stress` must have the ring's number of teeth, and holds the stress of tooth i
  /// at index i + `shift`. The function does not allocate.
  void at(const RingEquilibrium& ring, int shift, ToothStress& stress) const noexcept;

  /// Stress by bending and stress by tension in the tooth spaces on both sides of a tooth [Pa].
  struct Parts
  {
    double bending;
    double tension;
  };
  Parts inToothSpace(const RingEquilibrium& ring, int i) const noexcept { return parts(ring, i, turn(ring, i)); }

  /// Stress in the tooth space of a sound rim [Pa]. `turn`: rotation of the rim at the tooth [rad]; `tension`: mean
  /// tension of the rim on both sides of the tooth [N].
  double inToothSpace(double turn, double tension) const noexcept
  {
    return by_turn_[static_cast<std::size_t>(StressPlace::TOOTH_SPACE)] * turn + tension / section_;
  }

private:
  static double turn(const RingEquilibrium& ring, int i) noexcept;
  Parts parts(const RingEquilibrium& ring, int i, double turn) const noexcept;

  double tension_stiffness_;                     // stiffness of a sound segment [N/m]
  double section_;                               // cross section of the rim [m^2]
  std::array<double, STRESS_PLACES> by_turn_{};  // stress per rotation of the rim at a tooth [Pa/rad]
  double shear_by_torque_;                       // shear stress per torque [Pa/(N.m)]
};

/// S-N curve of the flexspline, with Goodman's mean stress correction and Peterson's notch sensitivity. Basquin's line
/// ends at the knee of the curve, the endurance limit. Beyond the knee the strength falls by 5 % in a decade of cycles
/// (Sonsino, Int. J. Fatigue 29, 2007). Sources: docs/life.md.
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

  /// Amplitude at zero mean stress that does as much damage as `cycle` at the notch of a place [Pa]. A mean stress in
  /// compression has no effect.
  double equivalentAmplitude(std::size_t place, const StressCycle& cycle) const noexcept
  {
    constexpr double LEAST_MARGIN = 1e-3;  // least value of 1 - mean, so that the amplitude stays finite [-]
    const double mean =
        notch_factor_[place] * StressCycle::equivalent(std::max(cycle.mean(), 0.0), cycle.shear) / ultimate_;
    return notch_factor_[place] * cycle.amplitude() / std::max(1.0 - mean, LEAST_MARGIN);
  }

  /// Equivalent amplitude over the endurance limit [-].
  double enduranceShare(std::size_t place, const StressCycle& cycle) const noexcept
  {
    return equivalentAmplitude(place, cycle) / limit_;
  }

  /// Damage by one cycle: 1 / number of cycles to failure [-]. `share`: amplitude over the endurance limit;
  /// `overloaded`: whether other cycles exceed the limit. If they do, cycles below the limit do more damage (Haibach,
  /// exponent 2 k - 1 with k the exponent of Basquin's line) than the S-N curve beyond its knee states.
  double damage(double share, bool overloaded) const noexcept
  {
    constexpr double BEYOND_KNEE = 45.0;  // exponent for a loss of 5 % of strength in a decade of cycles
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

/// Miner's sum over the loads at a place. Loads below the endurance limit do more damage if a load exceeds the limit.
class MinerSum
{
public:
  /// Adds the damage of `cycles` cycles. `share`: amplitude over the endurance limit for the strength of the drive [-].
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
  double alone_{};  // damage of loads below the limit, valid if no load exceeds the limit
  double below_{};  // damage of loads below the limit, valid if a load exceeds the limit
  double above_{};  // damage of loads above the limit
};
}  // namespace hjt
