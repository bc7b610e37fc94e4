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
  /// Hours of use of the drive [h]: one number, or one for each recording, ascending. Empty: those of the recordings.
  std::vector<double> hours;
  std::string baseline;                     ///< file of the new drive's reference; empty: nothing is assessed
  std::string duty;                         ///< duty cycle of the use so far, in place of the recordings' use
  std::optional<double> lost_motion_limit;  ///< lost motion that ends the use of the drive [rad]
  std::string use_record;                   ///< file to write the use to, as a duty cycle; empty: none
};

void addOptions(OptionTable& table, RemainingOptions& options);

struct Remaining
{
  LifeEstimate estimate;
  std::optional<Assessment> assessment;  ///< last assessment that counts; none if nothing was assessed
  std::optional<WearReading> wear;       ///< last reading of the wear
  std::optional<SeenFrom> seen_from;     ///< severities that would show, if no fault was found
  const char* parameters{};              ///< source of the parameters, in words
};

/// Estimates from recordings how a joint is used, and how long a drive lasts that is used so.
/// @throws ParameterError, InputError if a file is unreadable, the motor does not turn, or nothing can be judged.
Remaining remaining(const RemainingOptions& options);

Report reportOf(const Remaining& found);
}  // namespace hjt
