// SPDX-License-Identifier: BSD-3-Clause
#include "live/realtime.hpp"

#include <cerrno>
#include <cstring>

#include <pwd.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

namespace hjt
{
namespace
{
std::string userName()
{
  const passwd* entry = getpwuid(geteuid());
  return entry != nullptr ? entry->pw_name : std::to_string(geteuid());
}

/// Text of the limit that the system sets this process for `resource`, in units of `unit`.
std::string limitText(decltype(RLIMIT_RTPRIO) resource, rlim_t unit)
{
  rlimit limit{};
  getrlimit(resource, &limit);
  return limit.rlim_cur == RLIM_INFINITY ? "unlimited" : std::to_string(limit.rlim_cur / unit);
}

/// Text that says how the user can permit a refused request.
std::string remedy(const std::string& limits_line, const std::string& capability)
{
  return ". To permit this request, add this line to /etc/security/limits.conf: '" + userName() + " - " + limits_line +
         "' and log in again. Or run the node with " + capability + ". The node continues without this request";
}

void applyPriority(int priority, pthread_t loop_thread, RealtimeState& state)
{
  state.scheduling = "SCHED_OTHER";
  if (priority == 0)
  {
    return;
  }
  sched_param scheduling{};
  scheduling.sched_priority = priority;
  const int error = pthread_setschedparam(loop_thread, SCHED_FIFO, &scheduling);
  const std::string wanted = "SCHED_FIFO " + std::to_string(priority);
  if (error == 0)
  {
    state.scheduling = wanted;
    return;
  }
  state.scheduling += ", " + wanted + " refused";
  state.refusals.push_back("realtime.priority = " + std::to_string(priority) +
                           " [-] was refused: " + std::strerror(error) + "; RLIMIT_RTPRIO is " +
                           limitText(RLIMIT_RTPRIO, 1) + remedy("rtprio " + std::to_string(priority), "CAP_SYS_NICE"));
}

void applyMemoryLock(bool lock_memory, RealtimeState& state)
{
  state.memory = "not locked";
  if (!lock_memory)
  {
    return;
  }
  // The present memory suffices, because the loop does not allocate. Locking future memory too can exceed a low limit.
  if (mlockall(MCL_CURRENT) == 0)
  {
    state.memory = "locked";
    return;
  }
  const std::string reason = std::strerror(errno);
  state.memory += ", refused";
  constexpr rlim_t KIBIBYTE = 1024;
  state.refusals.push_back("realtime.lock_memory = true [-] was refused: " + reason + "; RLIMIT_MEMLOCK is " +
                           limitText(RLIMIT_MEMLOCK, KIBIBYTE) + " [KiB]" +
                           remedy("memlock unlimited", "CAP_IPC_LOCK"));
}

void applyProcessor(int processor, pthread_t loop_thread, RealtimeState& state)
{
  state.processor = "any";
  if (processor < 0)
  {
    return;
  }
  cpu_set_t processors;
  CPU_ZERO(&processors);
  CPU_SET(processor, &processors);
  const int error = pthread_setaffinity_np(loop_thread, sizeof(processors), &processors);
  const std::string wanted = std::to_string(processor);
  if (error == 0)
  {
    state.processor = wanted;
    return;
  }
  state.processor += ", " + wanted + " refused";
  state.refusals.push_back("realtime.processor = " + wanted + " [-] was refused: " + std::strerror(error) +
                           "; this machine has " + std::to_string(sysconf(_SC_NPROCESSORS_ONLN)) +
                           " processors, counted from 0. The node continues without this request");
}
}  // namespace

RealtimeState applyRealtime(const RealtimeParameters& parameters, pthread_t loop_thread)
{
  RealtimeState state;
  applyPriority(parameters.priority, loop_thread, state);
  applyMemoryLock(parameters.lock_memory, state);
  applyProcessor(parameters.processor, loop_thread, state);
  return state;
}
}  // namespace hjt
