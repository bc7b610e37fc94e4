// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <pthread.h>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// State of the requests of section realtime, as texts.
struct RealtimeState
{
  std::string scheduling;  ///< policy and priority of the loop's thread
  std::string memory;      ///< whether the memory of the process is locked
  std::string processor;   ///< processor of the loop's thread
  /// Text of each refused request: parameter, reason, and the setting of the system that would permit the request.
  std::vector<std::string> refusals;
};

/// Sets priority and processor of the loop's thread, and locks all memory that the process has. Must be called when
/// all objects of the loop exist. A refused request changes nothing.
RealtimeState applyRealtime(const RealtimeParameters& parameters, pthread_t loop_thread);
}  // namespace hjt
