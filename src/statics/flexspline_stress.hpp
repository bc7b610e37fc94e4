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

/// S-N curve of the flexspline: Basquin's line down to the endurance limit at its knee, beyond that 5 % of strength a
/// decade (Sonsino, Int. J. Fatigue 29, 2007), Goodman's mean stress, Peterson's notch sensitivity. Sources:
/// docs/life.md.
class FatigueLaw
{
public:
  FatigueLaw(const LifeParameters& life, const StressParameters& stress)
    : ultimate_(life.ultimate_strength)
    , limit_(life.endurance_limit)
    , cycles_(life.endurance_cycles)
    , exponent_(life.fatigue_exponent)
  {
    const double length = 0.0254e-3 * std::pow(2070e6 / ultimate_, 1.8);  // Peterson, steels [m]
    for (std::size_t place = 0; place < STRESS_PLACES; ++place)
    {
      const double sensitivity = 1.0 / (1.0 + length / stress.notch_radius[place]);
      notch_factor_[place] = 1.0 + sensitivity * (stress.concentration[place] - 1.0);
    }
  }

  /// Fatigue notch factor of a place [-].
  double notchFactor(std::size_t place) const noexcept { return notch_factor_[place]; }

  /// Amplitude without mean stress that does as much damage at the notch of a place [Pa]. Compression is no help.
  double equivalentAmplitude(std::size_t place, const StressCycle& cycle) const noexcept
  {
    constexpr double LEAST_MARGIN = 1e-3;  // immediate failure counts as a large amplitude
    const double mean =
        notch_factor_[place] * StressCycle::equivalent(std::max(cycle.mean(), 0.0), cycle.shear) / ultimate_;
    return notch_factor_[place] * cycle.amplitude() / std::max(1.0 - mean, LEAST_MARGIN);
  }

  /// Share of the endurance limit [-].
  double enduranceShare(std::size_t place, const StressCycle& cycle) const noexcept
  {
    return equivalentAmplitude(place, cycle) / limit_;
  }

  /// Damage by one cycle of a share of the endurance limit: 1 over the cycles to failure [-].
  /// `overloaded`: the drive also bears cycles above the limit, which take those below it along (Haibach: exponent
  /// 2 k - 1); without, they break it beyond the knee of the curve alone.
  double damage(double share, bool overloaded) const noexcept
  {
    constexpr double BEYOND_KNEE = 45.0;  // 5 % a decade
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

/// Miner's sum over loads of one place: those below the endurance limit count for more if any lies above it.
class MinerSum
{
public:
  /// `share` of the endurance limit, of the strength at hand.
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
  double alone_{};  // of those below, were they all
  double below_{};  // of those below beside some above
  double above_{};
};
}  // namespace hjt
