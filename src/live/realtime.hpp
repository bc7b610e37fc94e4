// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <pthread.h>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// The granted parameters below `realtime`, in words.
struct RealtimeState
{
  std::string scheduling;  ///< policy and priority of the loop's thread
  std::string memory;      ///< whether it is locked
  std::string processor;   ///< that the loop's thread is bound to
  /// For each refused request: its name, the reason, and the change of the system that permits it.
  std::vector<std::string> refusals;
};

/// Gives the loop's thread its priority and processor, and locks all memory the process has by now: to be called when
/// everything the loop uses exists. What is refused is left as it was.
RealtimeState applyRealtime(const RealtimeParameters& parameters, pthread_t loop_thread);
}  // namespace hjt
