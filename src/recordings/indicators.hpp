// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "recordings/indicators_report.hpp"
#include "recordings/recorded_signals.hpp"

namespace hjt
{
struct IndicatorsOptions : SignalOptions
{
  std::vector<std::string> models;  ///< none, or one for each recording
  std::string baseline;             ///< the reference; empty: learned from the first windows
  std::string save_baseline;        ///< where to write the learned one; empty: nowhere
  std::string out;                  ///< CSV with a row for each window; empty: none
  bool carry{};                     ///< the reference is of another motion
  bool windows{};                   ///< the recordings hold the windows' indicators, not the signals
};

void addOptions(OptionTable& table, IndicatorsOptions& options);

/// Health indicators of recordings and their assessment, from encoders and torque or current; writes the files that are
/// asked for. A recording that cannot be read is named and left out.
/// @throws ParameterError, InputError: none can be read, too short for a window, or not one model for each.
AssessedWindows indicators(const IndicatorsOptions& options);
}  // namespace hjt
