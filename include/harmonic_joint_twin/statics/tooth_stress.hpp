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
/// Names of the places of the flexspline, in the order of StressPlace. Laws and sources: docs/life.md.
constexpr std::array<const char*, STRESS_PLACES> STRESS_PLACE_NAMES{ "tooth space", "transition", "flange" };

/// Nominal stress (without notch factor) at a place of the flexspline over a turn at constant load.
struct StressCycle
{
  double lowest{};   ///< least normal stress [Pa]
  double highest{};  ///< largest normal stress [Pa]
  double shear{};    ///< shear stress, constant over the turn [Pa]

  double amplitude() const noexcept { return 0.5 * (highest - lowest); }  ///< amplitude of the normal stress [Pa]
  double mean() const noexcept { return 0.5 * (highest + lowest); }       ///< mean of the normal stress [Pa]
  /// Largest equivalent stress by von Mises [Pa].
  double largest() const noexcept { return equivalent(std::max(highest, -lowest), shear); }

  /// Equivalent stress by von Mises of a normal and a shear stress [Pa].
  static double equivalent(double normal, double shear) noexcept
  {
    return std::sqrt(normal * normal + 3.0 * shear * shear);
  }
};

/// Nominal stress (without notch factor) of the flexspline at every tooth at one instant.
struct ToothStress
{
  explicit ToothStress(int teeth = 0) { normal.fill(std::vector<double>(static_cast<std::size_t>(teeth))); }

  /// Normal stress by place and tooth [Pa]. In the tooth spaces on both sides of the tooth the stress acts along the
  /// circumference, at transition and flange along the axis.
  std::array<std::vector<double>, STRESS_PLACES> normal;
  /// Shear stress by place, constant around the circumference [Pa].
  std::array<double, STRESS_PLACES> shear{};

  /// Stress cycle at a place < STRESS_PLACES: range of the stress over all teeth at this instant. If all teeth are
  /// equal, this range is also the range at one tooth over a turn.
  StressCycle cycle(std::size_t place) const noexcept
  {
    const auto [lowest, highest] = std::minmax_element(normal[place].begin(), normal[place].end());
    return { *lowest, *highest, shear[place] };
  }

  /// Tooth with the largest magnitude of the normal stress at a place.
  std::size_t worstTooth(std::size_t place) const noexcept
  {
    const auto worst = std::max_element(normal[place].begin(), normal[place].end(),
                                        [](double a, double b) { return std::abs(a) < std::abs(b); });
    return static_cast<std::size_t>(worst - normal[place].begin());
  }
};
}  // namespace hjt
