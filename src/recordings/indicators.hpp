// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harmonic_joint_twin/health/assessment.hpp"
#include "health/seen_from.hpp"
#include "output/report.hpp"
#include "recordings/recorded_signals.hpp"

namespace hjt
{
/// One window and what was made of it.
struct WindowResult
{
  std::string recording;
  const char* origin;      ///< source of the window, in words
  const char* parameters;  ///< and with whose parameters
  SignalIndicators indicators;
  Deviations deviations;
  WindowResidual residual;
  Assessment assessment;
  std::optional<SeenFrom> seen_from{};  ///< of the last window of a recording, where the verdict is OK
};

struct UnreadRecording
{
  std::string recording;
  std::string why;
};

/// The windows of all recordings.
struct AssessedWindows
{
  std::vector<WindowResult> windows;    ///< none: stopped before the first
  double threshold{};                   ///< of the scores
  bool is_judged{};                     ///< at least one of them
  std::vector<UnreadRecording> unread;  ///< the recordings that have none
};

/// Severities by cause, of causes with signatures; null: at none of theirs.
Json seenFromJson(const SeenFrom& seen_from);

/// A CSV file with a row per window; no path: none.
void writeWindows(const std::string& path, const std::vector<WindowResult>& windows);

/// The document with every window.
Report reportOf(const AssessedWindows& found);

/// The last window, for people.
void printSummary(const std::vector<WindowResult>& windows);

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
