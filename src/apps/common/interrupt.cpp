// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/interrupt.hpp"

namespace hjt
{
namespace
{
volatile std::sig_atomic_t g_signal = 0;
}  // namespace

void catchInterrupts()
{
  struct sigaction action
  {
  };
  action.sa_handler = [](int signal) { g_signal = signal; };
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  if (std::signal(SIGHUP, SIG_IGN) != SIG_IGN)  // which it is below nohup
  {
    sigaction(SIGHUP, &action, nullptr);
  }
  std::signal(SIGXFSZ, SIG_IGN);  // beyond a limit of size, writing fails as on a full disk
}

int interruptSignal()
{
  return g_signal;
}

InterruptScope::InterruptScope()
{
  g_signal = 0;
  struct sigaction action
  {
  };
  action.sa_handler = [](int signal) { g_signal = signal; };
  sigaction(SIGINT, &action, &before_);
}

InterruptScope::~InterruptScope()
{
  sigaction(SIGINT, &before_, nullptr);
}
}  // namespace hjt
