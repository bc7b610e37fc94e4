// SPDX-License-Identifier: BSD-3-Clause
// Written by lab/run assessment_counts from docs/health.md.
#pragma once

namespace hjt::assessment_counts
{
constexpr double TOOTH_WEAR_FOUND = 8.0;
constexpr double TOOTH_WEAR_RUNS = 9.0;
constexpr double TOOTH_WEAR_ESTIMATE = 0.80;  // mean estimated over true severity [-]
constexpr double INTERFACE_WEAR_FOUND = 7.0;
constexpr double INTERFACE_WEAR_RUNS = 9.0;
constexpr double INTERFACE_WEAR_ESTIMATE = 0.94;  // mean estimated over true severity [-]
constexpr double LUBRICANT_DEGRADATION_FOUND = 8.0;
constexpr double LUBRICANT_DEGRADATION_RUNS = 9.0;
constexpr double LUBRICANT_DEGRADATION_ESTIMATE = 0.72;  // mean estimated over true severity [-]
constexpr double ALARMS = 14.0;
constexpr double RIGHT_CAUSES = 13.0;
constexpr double IN_SETS = 13.0;
constexpr double SOUND_RUNS = 144.0;
constexpr double SOUND_ALARMS = 0.0;
constexpr double ESTIMATE_SPREAD = 0.37;   // spread over mean of estimates [-]
constexpr double STATED_DEVIATION = 0.50;  // stated deviation over mean [-]
}  // namespace hjt::assessment_counts
