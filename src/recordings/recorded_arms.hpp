// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "recordings/recording_check.hpp"

namespace hjt
{
/// The joints that the recording names, and its temperature. @throws InputError if it cannot be read.
CheckedContents readCheckedContents(const MotionSource& source);

/// The arms whose joints the recording names, by the names' prefixes and suffixes, or the arm of the options; at least
/// one, without an arm if none fits. What they say of each other is left open: `ranked`, `taken` of more than one that
/// fits.
/// @throws InputError, ParameterError.
std::vector<CheckedArm> findArms(const RecordingOptions& options, const CheckedContents& contents);
}  // namespace hjt
