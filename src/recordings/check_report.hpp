// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "output/json.hpp"
#include "recordings/recording_check.hpp"

namespace hjt
{
/// Commands to run next, ready to paste: with nothing that was not tried. None of arrays.
std::vector<std::string> nextCommands(const RecordingCheck& check, const CheckedArm& arm);

Json documentOf(const RecordingCheck& check);
}  // namespace hjt
