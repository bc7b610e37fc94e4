// SPDX-License-Identifier: BSD-3-Clause
// Written by lab/run assessment_counts from docs/health.md.
#pragma once

namespace hjt::assessment_counts
{
constexpr double TOOTH_WEAR_FOUND = 9.0;
constexpr double TOOTH_WEAR_RUNS = 9.0;
constexpr double TOOTH_WEAR_ESTIMATE = 0.96;  // over the truth
constexpr double INTERFACE_WEAR_FOUND = 9.0;
constexpr double INTERFACE_WEAR_RUNS = 9.0;
constexpr double INTERFACE_WEAR_ESTIMATE = 0.68;  // over the truth
constexpr double LUBRICANT_DEGRADATION_FOUND = 9.0;
constexpr double LUBRICANT_DEGRADATION_RUNS = 9.0;
constexpr double LUBRICANT_DEGRADATION_ESTIMATE = 0.76;  // over the truth
constexpr double ALARMS = 15.0;
constexpr double RIGHT_CAUSES = 11.0;
constexpr double IN_SETS = 14.0;
constexpr double SOUND_RUNS = 144.0;
constexpr double SOUND_ALARMS = 0.0;
constexpr double ESTIMATE_SPREAD = 0.30;   // over the estimate, of all kinds
constexpr double STATED_DEVIATION = 0.53;  // likewise
}  // namespace hjt::assessment_counts
