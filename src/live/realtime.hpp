// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <pthread.h>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Descriptions of the granted parameters in section realtime.
struct RealtimeState
{
  std::string scheduling;  ///< policy and priority of the loop's thread
  std::string memory;      ///< whether the memory is locked
  std::string processor;   ///< processor of the loop's thread
  /// Text of each refused request: its name, the reason, and the system setting that permits it.
  std::vector<std::string> refusals;
};

/// Sets priority and processor of the loop's thread, and locks all memory that the process has. It must be called when
/// all objects of the loop exist. A refused request changes nothing.
RealtimeState applyRealtime(const RealtimeParameters& parameters, pthread_t loop_thread);
}  // namespace hjt
