// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/library_command.hpp"

#include <iostream>
#include <memory>

namespace hjt
{
Watch readingWatch()
{
  return { showProgress, Watch().stopped,
           [](const std::string& text) { std::cerr << "joint_twin: " << text << '\n'; } };
}

Watch consoleWatch()
{
  Watch watch = readingWatch();
  watch.stopped = [interrupts = std::make_shared<InterruptScope>()] { return interruptSignal() != 0; };
  return watch;
}
}  // namespace hjt
