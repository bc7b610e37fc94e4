// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "output/report.hpp"
#include "recordings/recorded_signals.hpp"

#include "harmonic_joint_twin/health/assessment.hpp"
#include "health/signature_terms.hpp"
#include "life/life_estimate.hpp"

namespace hjt
{
struct RemainingOptions : SignalOptions
{
  /// Use that the drive has behind it; none: that of the recordings. Or one for each recording, ascending [h]
  std::vector<double> hours;
  std::string baseline;                     ///< reference of the new drive; empty: nothing is assessed
  std::string duty;                         ///< use so far, as a duty cycle; the recordings are then assessed only
  std::optional<double> lost_motion_limit;  ///< that ends its use too [rad]
  std::string use_record;                   ///< where to write the use as a duty cycle; empty: nowhere
};

void addOptions(OptionTable& table, RemainingOptions& options);

struct Remaining
{
  LifeEstimate estimate;
  std::optional<Assessment> assessment;  ///< the last one that counts; none: nothing was assessed
  std::optional<WearReading> wear;       ///< the last one
  std::optional<SeenFrom> seen_from;     ///< of the assessment, where nothing was found
  const char* parameters{};              ///< whose they are, in words
};

/// The use of a recorded joint, and how long a drive lasts that is used so.
/// @throws ParameterError, InputError: unreadable, a motor that does not turn, or nothing that can be judged.
Remaining remaining(const RemainingOptions& options);

Report reportOf(const Remaining& found);
}  // namespace hjt
