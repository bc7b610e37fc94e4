// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "output/json.hpp"
#include "recordings/recording_comparison.hpp"
#include "recordings/recording_contents.hpp"

#include "tracking/verdict.hpp"

namespace hjt
{
/// All that a report is made of.
struct ComparisonRecord
{
  std::string recording;
  std::string joint;
  std::string made_with;  ///< name and version of the program
  MotionFindings found;
  FrictionFactor friction;
  bool is_friction_judged{};
  RecordingContents contents;
  Decimated<TwinState> twin_states;
  Verdict verdict;
};

/// The fields of Verdict.msg; level and reason by name.
Json verdictFields(const Verdict& verdict);

/// Writes COMPARISON_FILE, BASELINE_FILE and tables beside them, as CSV: course, friction, friction_twin, spectrum,
/// teeth, health, and where the recording has them torsion, torsion_twin, twin_states. Solves the ring under the loads
/// of the recording. Gives what COMPARISON_FILE holds; with an empty `directory` that alone, and nothing is written.
/// @throws InputError if a file cannot be written.
Json writeComparison(const std::string& directory, const RecordingComparison& comparison, const Parameters& parameters,
                     const ComparisonRecord& record);
}  // namespace hjt
