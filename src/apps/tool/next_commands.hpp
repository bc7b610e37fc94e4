// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "apps/common/motion_options.hpp"
#include "recordings/recording_check.hpp"

namespace hjt
{
/// Commands to run next, ready to paste: with nothing that was not tried.
std::vector<std::string> nextCommands(const ArmOptions& options, const CheckedArm& arm);
}  // namespace hjt
