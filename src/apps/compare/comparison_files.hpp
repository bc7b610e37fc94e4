// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "comparison.hpp"
#include "recording_contents.hpp"
#include "verdict.hpp"

namespace hjt
{
/// All that a report is made of.
struct ComparisonRecord
{
  std::string recording;
  std::string joint;
  std::string made_with;  ///< name and version of the program
  MotionCount count;
  std::uint64_t refused{};
  std::uint64_t gaps{};
  RecordingContents contents;
  Thinned<TwinState> twin_states;
  Verdict verdict;
};

/// Writes DIR/comparison.json and tables beside it, as CSV: course, friction, friction_twin, spectrum, teeth, health, and
/// where the recording has them torsion, torsion_twin, twin_states. Solves the ring under the loads of the recording.
/// @throws InputError if a file cannot be written.
void writeComparison(const std::string& directory, const Comparison& comparison, const Parameters& parameters,
                     const ComparisonRecord& record);

const char* levelName(HealthLevel level);
}  // namespace hjt
