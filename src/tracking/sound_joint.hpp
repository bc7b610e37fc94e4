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

/// As given when the report of an arm was made: a name, or a file.
/// @throws InputError if the directory holds no report of an arm.
std::string armOfReport(const std::string& directory);

/// Of one or more recordings of the sound joint, by the directories of their reports: their friction is the mean at the
/// speeds of all, and by how much they differ tells how the joint repeats. A recording in which its friction was not
/// judged is no reference of it. None: nothing is known.
/// @throws InputError if a directory holds no comparison, or one of another gear.
SoundJoint readSoundJoint(const std::vector<std::string>& directories, const Parameters& parameters);
}  // namespace hjt
