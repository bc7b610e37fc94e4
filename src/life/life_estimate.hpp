// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "life/remaining_life.hpp"
#include "life/revolution_load_map.hpp"
#include "life/usage_history.hpp"

namespace hjt
{
/// What a record of use says of the drive.
struct LifeEstimate
{
  double hours{};            ///< of use so far
  double turns{};            ///< of the wave generator so far
  RemainingHours remaining;  ///< of drives of this kind that are in use still, if they go on being used like this
  std::array<double, ENDS_OF_LIFE> used{};  ///< share of each limit that the nominal drive has behind it [-]
  double grease_used{};                     ///< share of the grease's life since the change that was due last [-]

  double usedOf(EndOfLife limit) const { return used[static_cast<std::size_t>(limit)]; }
  EndOfLife nearest() const;  ///< limit of which most is used
};

/// Ages a drive by its record of use. Its grease is taken to be changed when it is due.
class LifeEstimator
{
public:
  explicit LifeEstimator(const Parameters& parameters);

  /// `record`: with turns in it. Takes seconds where it holds loads that were not met before.
  /// @throws ParameterError if the ring finds no equilibrium under one of its loads.
  LifeEstimate estimate(const UsageHistory& record);

private:
  Parameters parameters_;
  RevolutionLoadMap load_map_;
};
}  // namespace hjt
