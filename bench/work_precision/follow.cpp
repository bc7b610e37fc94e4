// SPDX-License-Identifier: BSD-3-Clause
#include "bench/work_precision/follow.hpp"

#include <algorithm>
#include <cstdio>

namespace hjt
{
Run follow(const Problem& problem, Integrator& integrator, double limit)
{
  constexpr double SAME = 1.0 + 1e-12;  // times that differ by rounding
  Recorder recorder(problem);
  Run run;
  double time = 0.0;
  const Stopwatch watch;
  for (const Phase& phase : problem.phases)
  {
    integrator.enter(phase, time);
    while (time < phase.end && run.failure.empty())
    {
      const double due = std::min(recorder.due(), phase.end);
      const bool good = integrator.advance(due, phase.end, time);
      run.time = watch.elapsed();
      if (!good || run.time > limit)
      {
        run.failure = (good ? "gave up at " : "failed at ") + text("%.3g s", time);
      }
      while (good && !recorder.done() && recorder.due() <= time * SAME)
      {
        recorder.add(integrator.at(std::min(recorder.due(), time)));
      }
    }
  }
  run.reached = time;
  integrator.count(run);
  if (run.failure.empty())
  {
    run.series = recorder.series();
  }
  return run;
}

std::string text(const char* format, double value)
{
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}
}  // namespace hjt
