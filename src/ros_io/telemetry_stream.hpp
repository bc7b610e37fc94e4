// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "ros_io/telemetry_clock.hpp"
#include "tracking/row_filter.hpp"
#include "tracking/stream_timing.hpp"

namespace hjt
{
/// The messages of one topic, which all joints of a robot share. Guarded by the node's mutex but for `too_large`.
struct TelemetryStream
{
  std::string topic;
  TelemetryClock clock;
  StreamTiming timing;
  Stamp last_received{};               ///< [ns]
  std::uint64_t far_stamps{};          ///< messages refused for their stamp
  std::uint64_t clock_changes{};       ///< restarts because all stamps had moved far
  std::uint64_t other_temperatures{};  ///< received whose frame_id is none of the joints
  std::string found_names;             ///< in the last message that lacks a joint
  std::string lack;                    ///< missing parts of the messages since the last row, a clause; empty: none
  std::string mounting;                ///< that the currents show and is not configured, a clause; empty: none
  std::string drag;                    ///< of the tool, likewise
  std::string payload;                 ///< that the currents show and is not configured, a clause; empty: none
  LeftOutRows left_out;                ///< by the filter
  std::uint64_t folds{};               ///< jumps by a turn that were taken out of the angles
  std::uint64_t without_effort{};      ///< messages refused for efforts all zero
  std::atomic<std::uint64_t> too_large{ 0 };
};
}  // namespace hjt
