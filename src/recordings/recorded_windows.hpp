// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "recordings/recorded_signals.hpp"

#include "harmonic_joint_twin/health/assessment.hpp"

namespace hjt
{
struct RecordingParameters
{
  /// The default configuration, overridden by the parameters of the run, if there are any, and then by the options.
  Parameters values;
  std::optional<Parameters> run;  ///< parameters that a run was simulated with; none if the file holds none
  const char* origin{};           ///< source of the parameters, as words for the report
};

/// Finds the parameters of a recording. @throws ParameterError that names the file or option, InputError.
RecordingParameters recordingParameters(const SignalOptions& options, const std::string& recording);

/// Windows that the file of a run holds. None if the file has no windows, or if the options name columns, a joint, a
/// torque scale, or other parameters than the run's, except for those of reference and assessment.
std::optional<std::vector<SignalIndicators>> windowsOfRun(const std::string& recording, const SignalOptions& options,
                                                          const RecordingParameters& parameters);

/// Windows that a node published while the bag was recorded. Messages that repeat the last window are ignored.
std::vector<SignalIndicators> publishedWindows(const std::string& path, const std::string& topic);

/// The judged assessment of a recording or, if the recording has none, the one that was nearest to being judged.
class ClosestAssessment
{
public:
  void take(const Assessment& assessment);
  bool isJudged() const { return closest_.state == AssessmentState::ASSESSED; }

  /// Text with the recording's name and the reason, for example "a.csv: too few windows: ...".
  std::string whyNotJudged(const std::string& recording) const;

private:
  Assessment closest_;
};
}  // namespace hjt
