// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harmonic_joint_twin/health/assessment.hpp"
#include "health/signature_terms.hpp"
#include "output/report.hpp"

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
}  // namespace hjt
