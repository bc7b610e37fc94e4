// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harmonic_joint_twin/health/assessment.hpp"
#include "health/signature_terms.hpp"
#include "output/report.hpp"
#include "recordings/recorded_signals.hpp"

namespace hjt
{
/// One window of the signals and its assessment.
struct WindowResult
{
  std::string recording;
  const char* origin;      ///< source of the window, in words
  const char* parameters;  ///< source of the parameters, in words
  SignalIndicators indicators;
  Deviations deviations;
  WindowResidual residual;
  Assessment assessment;
  std::optional<SeenFrom> seen_from{};  ///< severities that would show; for the last window, if it is OK
};

struct UnreadRecording
{
  std::string recording;
  std::string why;
};

/// The windows of all recordings.
struct AssessedWindows
{
  std::vector<WindowResult> windows;    ///< none if stopped before the first window
  double threshold{};                   ///< threshold of the scores
  bool is_judged{};                     ///< whether at least one window is judged
  std::vector<UnreadRecording> unread;  ///< recordings that could not be read
};

/// Severity from which on each cause with signatures would show; null if it would show at none.
Json seenFromJson(const SeenFrom& seen_from);

/// Writes a CSV file with a row for each window, unless the path is empty.
void writeWindows(const std::string& path, const std::vector<WindowResult>& windows);

/// Report with every window.
Report reportOf(const AssessedWindows& found);

/// Prints the last window for people.
void printSummary(const std::vector<WindowResult>& windows);

struct IndicatorsOptions : SignalOptions
{
  std::vector<std::string> models;  ///< recordings of the twin, none or one for each recording
  std::string baseline;             ///< file of the reference; empty: it is learned from the first windows
  std::string save_baseline;        ///< file for the learned reference; empty: none
  std::string out;                  ///< CSV file with a row for each window; empty: none
  bool carry{};                     ///< the reference is of another motion
  bool windows{};                   ///< the recordings hold the windows' indicators, not the signals
};

void addOptions(OptionTable& table, IndicatorsOptions& options);

/// Computes and assesses health indicators of recordings from encoders and torque or current, and writes the files of
/// the options. A recording that cannot be read is left out, and a notice names it.
/// @throws ParameterError, InputError if no recording can be read or has a whole window, or a model is missing.
AssessedWindows indicators(const IndicatorsOptions& options);
}  // namespace hjt
