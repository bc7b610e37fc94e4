// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "arm/arm_description.hpp"
#include "recordings/recorded_motion.hpp"

namespace hjt
{
/// Torque per current that the controller of an arm counts with: the ratio of its columns `target_moment_N` and
/// `target_current_N` while the whole arm is at rest, where its current holds no friction. One for each of `joints`
/// joints [N.m/A]. NaN: not recorded, or the joint bears no load at rest. Reads the first minutes of a table; of
/// messages, which hold no target currents, all are NaN. @throws InputError on an unreadable file.
std::vector<double> readStatedGains(const MotionSource& source, std::size_t joints);

/// The payload that a controller's table states, columns payload [kg] and payload_cog_0 ... 2 [m]; none: it has none,
/// or another in some rows. @throws InputError.
std::optional<Payload> readStatedPayload(const MotionSource& source);
}  // namespace hjt
