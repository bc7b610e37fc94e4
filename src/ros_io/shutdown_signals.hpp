// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>

#include <ros/init.h>

namespace hjt
{
/// SIGTERM and SIGHUP end a node as SIGINT does, which is all that roscpp catches. A SIGHUP that is ignored, as below
/// nohup, stays ignored. SIGXFSZ is ignored: beyond a limit of size, writing fails as on a full disk. Call after
/// ros::init.
inline void shutDownOnSignals()
{
  const auto request = [](int) { ros::requestShutdown(); };
  std::signal(SIGTERM, request);
  std::signal(SIGXFSZ, SIG_IGN);
  if (std::signal(SIGHUP, request) == SIG_IGN)
  {
    std::signal(SIGHUP, SIG_IGN);
  }
}
}  // namespace hjt
