// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "harmonic_joint_twin/health/baseline.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
// Files that `joint_twin compare` writes into the directory of an arm's or a joint's report.
constexpr const char* ARM_FILE = "arm.json";
constexpr const char* COMPARISON_FILE = "comparison.json";
constexpr const char* BASELINE_FILE = "baseline.yaml";
constexpr const char* FRICTION_FILE = "friction.csv";

/// Figures of the sound joint from earlier comparisons.
struct SoundJoint
{
  OwnReference own;
  std::vector<ReferenceBin> baseline;  ///< none: the recordings were too short for one
};

/// Name or file of the arm of a report, as it was given when the report was made.
/// @throws InputError if the directory holds no report of an arm.
std::string armOfReport(const std::string& directory);

/// Reads the reports of one or more recordings of the sound joint. The friction is the mean over the recordings at each
/// speed, and the differences between the recordings tell how well the joint repeats. A recording in which the friction
/// was not judged does not count for it. Without directories nothing is known.
/// @throws InputError if a directory holds no comparison, or one of another gear.
SoundJoint readSoundJoint(const std::vector<std::string>& directories, const Parameters& parameters);
}  // namespace hjt
