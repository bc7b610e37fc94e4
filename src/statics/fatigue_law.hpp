// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/statics/tooth_stress.hpp"

namespace hjt
{
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
