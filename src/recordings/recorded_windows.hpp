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
  /// The default configuration, over it the parameters of the run, if there is one, and over both those of the options.
  Parameters values;
  std::optional<Parameters> run;  ///< parameters that a run of a data set was made with; none if the file holds none
  const char* origin{};           ///< source of the parameters, in words
};

/// Finds the parameters of a recording. @throws ParameterError naming the file or option, InputError.
RecordingParameters recordingParameters(const SignalOptions& options, const std::string& recording);

/// The windows that the file of a run holds. None if the file has no windows, or if the options change what windows
/// depend on: the columns, or parameters other than those of reference and assessment.
std::optional<std::vector<SignalIndicators>> windowsOfRun(const std::string& recording, const SignalOptions& options,
                                                          const RecordingParameters& parameters);

/// The windows that a node published while a bag was recorded. Each message repeats the last window.
std::vector<SignalIndicators> publishedWindows(const std::string& path, const std::string& topic);

/// The assessment of a recording that came nearest to a verdict.
class ClosestAssessment
{
public:
  void take(const Assessment& assessment);
  bool isJudged() const { return closest_.state == AssessmentState::ASSESSED; }

  /// Text with the recording's name, as "a.csv: too few windows: ...".
  std::string whyNotJudged(const std::string& recording) const;

private:
  Assessment closest_;
};
}  // namespace hjt
