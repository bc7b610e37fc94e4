// SPDX-License-Identifier: BSD-3-Clause
#include "output/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

namespace hjt
{
namespace
{
using std::chrono::milliseconds;

constexpr milliseconds BAR_PERIOD{ 200 };
constexpr milliseconds FIRST_LINE{ 2000 };
constexpr milliseconds LINE_PERIOD{ 5000 };
// Time in which all steps of a fast loop share one reading of the clock.
constexpr milliseconds LOOK_PERIOD{ 1 };
constexpr unsigned MOST_CALLS_PER_LOOK = 64;
constexpr int BAR_WIDTH = 40;
}  // namespace

Progress::Progress(std::string what)
  : what_(std::move(what)), terminal_(isatty(STDERR_FILENO) != 0), next_(start_ + (terminal_ ? BAR_PERIOD : FIRST_LINE))
{
}

Progress::~Progress()
{
  if (bar_shown_)
  {
    std::fprintf(stderr, "\n");
  }
}

void Progress::update(double done)
{
  if (++calls_ < calls_per_look_ && done < 1.0)
  {
    return;
  }
  const auto now = Clock::now();
  calls_per_look_ = now - last_look_ < LOOK_PERIOD ? std::min(2 * calls_per_look_, MOST_CALLS_PER_LOOK) : 1;
  calls_ = 0;
  last_look_ = now;
  if (now >= next_ || (bar_shown_ && done >= 1.0))
  {
    show(std::clamp(done, 0.0, 1.0), std::chrono::duration<double>(now - start_).count());
    next_ = now + (terminal_ ? BAR_PERIOD : LINE_PERIOD);
  }
}

void Progress::show(double done, double elapsed)
{
  const double left = done > 0.0 ? elapsed * (1.0 - done) / done : 0.0;
  if (!terminal_)
  {
    std::fprintf(stderr, "%s: %.0f %%, %.0f s left\n", what_.c_str(), 100.0 * done, left);
    return;
  }
  const std::string bar(static_cast<std::size_t>(done * BAR_WIDTH), '#');
  std::fprintf(stderr, "\r%s [%-*s] %3.0f %%, %.0f s left   ", what_.c_str(), BAR_WIDTH, bar.c_str(), 100.0 * done,
               left);
  std::fflush(stderr);
  bar_shown_ = true;
}

std::function<void(double)> showProgress(const std::string& what)
{
  return [progress = std::make_shared<Progress>(what)](double done) { progress->update(done); };
}
}  // namespace hjt
