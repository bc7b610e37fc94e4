// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "arm/arm_ranking.hpp"
#include "recordings/arm_recording.hpp"

namespace hjt
{
/// Of the arms of these names, the best first: how each explains the first two minutes, the gains that the recording
/// states too. @throws InputError, ParameterError.
std::vector<ArmFit> rankArms(const RecordingOptions& options, const std::vector<std::string>& names);

/// A shipped arm with these joints that explains the recording so much better that it contradicts its own, shipped
/// too; empty: none. A user's own file is taken at its word.
std::string betterArm(const ArmRecording& recording);
}  // namespace hjt
