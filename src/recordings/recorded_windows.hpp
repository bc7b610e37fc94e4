// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "recordings/recorded_signals.hpp"

#include "harmonic_joint_twin/health/assessment.hpp"

namespace hjt
{
/// Parameters that hold for a recording.
struct RecordingParameters
{
  /// The default configuration, over it those of the run if there is one, over both those of the options.
  Parameters values;
  std::optional<Parameters> run;  ///< that a run of a data set was made with; none: no run, or it holds none
  const char* origin{};           ///< in words
};

/// @throws ParameterError naming the file or option, InputError.
RecordingParameters recordingParameters(const SignalOptions& options, const std::string& recording);

/// The windows that a run of a data set holds itself. None where there are none, and where the options change what they
/// would be made of: its columns, or parameters other than those of reference and assessment.
std::optional<std::vector<SignalIndicators>> windowsOfRun(const std::string& recording, const SignalOptions& options,
                                                          const RecordingParameters& parameters);

/// The windows that were published while a bag was recorded; each message repeats the last one.
std::vector<SignalIndicators> publishedWindows(const std::string& path, const std::string& topic);

/// How near a recording came to a verdict.
class ClosestAssessment
{
public:
  void take(const Assessment& assessment);
  bool isJudged() const { return closest_.state == AssessmentState::ASSESSED; }

  /// "a.csv: too few windows: ..."
  std::string whyNotJudged(const std::string& recording) const;

private:
  Assessment closest_;
};
}  // namespace hjt
