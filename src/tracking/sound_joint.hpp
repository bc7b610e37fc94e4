// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "harmonic_joint_twin/health/baseline.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
// Files that `joint_twin compare` writes into the directory of the report on an arm or a joint.
constexpr const char* ARM_FILE = "arm.json";
constexpr const char* COMPARISON_FILE = "comparison.json";
constexpr const char* BASELINE_FILE = "baseline.yaml";
constexpr const char* FRICTION_FILE = "friction.csv";

/// Reference of a joint: results of earlier comparisons, when the joint was sound.
struct SoundJoint
{
  OwnReference own;
  std::vector<ReferenceBin> baseline;  ///< reference of the signals; empty: the recordings were too short
};

/// Name or file of a report's arm, as the user gave it. @throws InputError if the directory holds no report of an arm.
std::string armOfReport(const std::string& directory);

/// Reads the reports on one or more recordings of a sound joint. The friction at each speed is the mean over the
/// recordings. The differences between the recordings show the scatter of the joint's friction. A recording without a
/// verdict on the friction does not count for the friction. Without directories the reference is empty. @throws
/// InputError if a directory holds no comparison, or one of another gear.
SoundJoint readSoundJoint(const std::vector<std::string>& directories, const Parameters& parameters);
}  // namespace hjt
