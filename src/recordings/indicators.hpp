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
  const char* origin;      ///< source of the window, as words for the report
  const char* parameters;  ///< source of the parameters, as words for the report
  SignalIndicators indicators;
  Deviations deviations;
  WindowResidual residual;
  Assessment assessment;
  /// Severities at which faults would have raised an alarm. Only the last window has them, and only if its level is OK.
  std::optional<SeenFrom> seen_from{};
};

struct UnreadRecording
{
  std::string recording;
  std::string why;
};

struct AssessedWindows
{
  std::vector<WindowResult> windows;    ///< none if the program was stopped before the first window
  double threshold{};                   ///< threshold of the scores, beyond which a score is an alarm [-]
  bool is_judged{};                     ///< whether at least one window is judged
  std::vector<UnreadRecording> unread;  ///< recordings that could not be read
};

/// Severity from which each fault with signatures would have raised an alarm, as JSON; null if no severity would have.
Json seenFromJson(const SeenFrom& seen_from);

/// Writes a CSV file with a row for each window, unless the path is empty.
void writeWindows(const std::string& path, const std::vector<WindowResult>& windows);

Report reportOf(const AssessedWindows& found);

void printSummary(const std::vector<WindowResult>& windows);

struct IndicatorsOptions : SignalOptions
{
  std::vector<std::string> models;  ///< recordings of the twin: none, or one for each recording of the joint
  std::string baseline;             ///< file of the reference; empty: the first windows become the reference
  std::string save_baseline;        ///< file that the learned reference is written to; empty: no file
  std::string out;                  ///< CSV file with a row for each window; empty: no file
  bool carry{};                     ///< whether the reference is from another motion
  bool windows{};                   ///< whether the recordings hold indicators of windows in place of signals
};

void addOptions(OptionTable& table, IndicatorsOptions& options);

/// Computes and assesses indicators from recordings of encoders and of torque or current, and writes the files that the
/// options name. A notice names each recording that cannot be read. @throws ParameterError, InputError if no recording
/// can be read or has a whole window, or a model is missing.
AssessedWindows indicators(const IndicatorsOptions& options);
}  // namespace hjt
