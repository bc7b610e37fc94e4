// SPDX-License-Identifier: BSD-3-Clause
#include "output/interrupt.hpp"

#include <utility>

namespace hjt
{
namespace
{
volatile std::sig_atomic_t g_signal = 0;
bool g_has_scope = false;
}  // namespace

int interruptSignal()
{
  return g_signal;
}

InterruptScope::InterruptScope() : is_outer_(!std::exchange(g_has_scope, true))
{
  if (is_outer_)
  {
    catchSignal(caught_[0], SIGINT);
    catchSignal(caught_[1], SIGTERM);
    catchSignal(caught_[2], SIGHUP);
  }
}

InterruptScope::~InterruptScope()
{
  for (const Caught& caught : caught_)
  {
    if (caught.signal != 0)
    {
      sigaction(caught.signal, &caught.before, nullptr);
    }
  }
  g_has_scope = g_has_scope && !is_outer_;
}

void InterruptScope::catchSignal(Caught& caught, int signal)
{
  struct sigaction action
  {
  };
  action.sa_handler = [](int number) { g_signal = number; };
  action.sa_flags = SA_RESETHAND;
  sigaction(signal, nullptr, &caught.before);
  if (signal != SIGHUP || caught.before.sa_handler != SIG_IGN)  // which it is below nohup
  {
    sigaction(signal, &action, nullptr);
    caught.signal = signal;
  }
}
}  // namespace hjt
