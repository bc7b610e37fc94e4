// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>

#include "python/bindings.hpp"

namespace hjt
{
namespace
{
double now()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
constexpr double INTERRUPT_PERIOD = 0.05;  // [s]
}  // namespace

InterruptCheck::InterruptCheck() : next_(now() + INTERRUPT_PERIOD) {}

bool InterruptCheck::operator()()
{
  const double time = now();
  if (time < next_)
  {
    return false;
  }
  next_ = time + INTERRUPT_PERIOD;
  const py::gil_scoped_acquire acquire;
  if (PyErr_CheckSignals() != 0)
  {
    throw Interrupted{};
  }
  return true;
}
}  // namespace hjt
