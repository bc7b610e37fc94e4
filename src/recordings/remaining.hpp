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
  /// Hours of use of the drive [h]: one number, or one for each recording, ascending. Empty: the recordings' duration.
  std::vector<double> hours;
  std::string baseline;  ///< file with the reference of the new drive; empty: nothing is assessed
  std::string duty;      ///< duty cycle of the use so far, in place of the recordings' use; empty: none
  std::optional<double> lost_motion_limit;  ///< largest lost motion of a usable drive; none: no limit [rad]
  std::string use_record;                   ///< file that the use is written to, as a duty cycle; empty: no file
};

void addOptions(OptionTable& table, RemainingOptions& options);

struct Remaining
{
  LifeEstimate estimate;
  std::optional<Assessment> assessment;  ///< latest assessment; none if nothing was assessed
  std::optional<WearReading> wear;       ///< last reading of the wear; none if the wear was not read
  std::optional<SeenFrom> seen_from;  ///< severities from which faults would have raised an alarm; none after an alarm
  const char* parameters{};           ///< source of the parameters, as words for the report
};

/// Estimates from recordings how a joint is used, and how long a drive with this use lasts.
/// @throws ParameterError, InputError if a file is unreadable, the motor does not turn, or nothing can be judged.
Remaining remaining(const RemainingOptions& options);

Report reportOf(const Remaining& found);
}  // namespace hjt
