// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Names of the places, in the order of the arrays by place. Laws and sources: docs/life.md.
constexpr std::array<const char*, STRESS_PLACES> STRESS_PLACE_NAMES{ "tooth space", "transition", "flange" };

/// Stress of one place of the flexspline over a turn of the wave generator at a steady load: nominal stresses,
/// without the notch.
struct StressCycle
{
  double lowest{};   ///< normal stress [Pa]
  double highest{};  ///< [Pa]
  double shear{};    ///< constant over the turn [Pa]

  double amplitude() const noexcept { return 0.5 * (highest - lowest); }  ///< [Pa]
  double mean() const noexcept { return 0.5 * (highest + lowest); }       ///< [Pa]
  /// Largest equivalent stress after von Mises [Pa].
  double largest() const noexcept { return equivalent(std::max(highest, -lowest), shear); }

  /// Equivalent stress after von Mises of a normal and a shear stress [Pa].
  static double equivalent(double normal, double shear) noexcept
  {
    return std::sqrt(normal * normal + 3.0 * shear * shear);
  }
};

/// Stress of the flexspline at every tooth at one instant, nominal: without the notch.
struct ToothStress
{
  explicit ToothStress(int teeth = 0) { normal.fill(std::vector<double>(static_cast<std::size_t>(teeth))); }

  /// Normal stress by place and tooth [Pa]: around the rim in the tooth spaces beside the tooth, along the axis at the
  /// transition and the flange.
  std::array<std::vector<double>, STRESS_PLACES> normal;
  /// By place, the same all around [Pa].
  std::array<double, STRESS_PLACES> shear{};

  /// Stress of one tooth over a turn: that of all teeth at one instant, if they are equal. `place`:
  /// below STRESS_PLACES.
  StressCycle cycle(std::size_t place) const noexcept
  {
    const auto [lowest, highest] = std::minmax_element(normal[place].begin(), normal[place].end());
    return { *lowest, *highest, shear[place] };
  }

  /// Tooth where the normal stress of a place is largest in magnitude.
  std::size_t worstTooth(std::size_t place) const noexcept
  {
    const auto worst = std::max_element(normal[place].begin(), normal[place].end(),
                                        [](double a, double b) { return std::abs(a) < std::abs(b); });
    return static_cast<std::size_t>(worst - normal[place].begin());
  }
};
}  // namespace hjt
