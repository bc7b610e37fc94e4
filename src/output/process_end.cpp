// SPDX-License-Identifier: BSD-3-Clause
#include "output/process_end.hpp"

#include <iostream>
#include <utility>

#include "output/report.hpp"
#include "twin/step_counters.hpp"

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
  if (signal != SIGHUP || caught.before.sa_handler != SIG_IGN)  // nohup ignores SIGHUP
  {
    sigaction(signal, &action, nullptr);
    caught.signal = signal;
  }
}

void warn(std::uint64_t count, const std::string& what)
{
  if (count > 0)
  {
    std::cerr << "joint_twin: " << count << ' ' << what << '\n';
  }
}

void warnOf(const TwinCounters& counters)
{
  warn(counters.input.not_finite, "inputs were refused because they were not finite");
  warn(counters.input.overflow, "inputs were dropped because the queue was full");
  warn(counters.torque_clamped, "steps had a motor torque command beyond motor.torque_limit; the command was clamped");
  warn(counters.load_clamped, "steps had a load torque beyond output.load_torque_limit; the load was clamped");
  warn(counters.overloads, "steps had a torque at the joint beyond output.torque_limit");
  warn(counters.speed_limited, "steps were at motor.speed_limit, where the drive reduces its torque");
  warn(counters.command_timeouts, "times the motor torque command timed out (input.command_timeout) and became zero");
  warn(counters.step_cuts, "steps converged only after they were divided");
  warn(counters.jumps, "steps had a tooth that jumped to another space of the circular spline");
  warn(counters.coarse_steps, "steps were too long for the joint's fastest natural mode; raise solver.rate");
  warn(counters.solver_failures, "steps did not converge; the twin kept its last converged state");
}

int RunSummary::report(const Twin& twin, bool json) const
{
  const JointOutputs& outputs = twin.outputs();
  const TwinCounters& counters = twin.counters();
  const double simulated = toSeconds(twin.stamp() - begin);
  const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  warnOf(counters);
  std::vector<ReportLine> lines{ { "output", "", output },
                                 { "simulated_time", "simulated", simulated, "s" },
                                 { "run_time", "in", took, "s" },
                                 { "motor_angle", "motor angle", outputs.motor_angle, "rad" },
                                 { "motor_velocity", "motor velocity", outputs.motor_velocity, "rad/s" },
                                 { "output_angle", "output angle", outputs.output_angle, "rad" },
                                 { "output_velocity", "output velocity", outputs.output_velocity, "rad/s" },
                                 { "energy_residual", "energy residual", outputs.energy_residual, "J" },
                                 { "inputs_accepted", "", counters.input.accepted },
                                 { "inputs_not_finite", "", counters.input.not_finite } };
  for (const auto& [name, count] : STEP_COUNTERS)
  {
    lines.push_back({ name, "", counters.*count });
  }
  printReport(json, lines);
  const int code = reportWritten(output, json);
  return code == EXIT_DONE && counters.solver_failures > 0 ? EXIT_FAILED : code;
}

int reportWritten(const std::string& output, bool json)
{
  if (!json)
  {
    std::cout << "written: " << output << '\n';
  }
  if (interruptSignal() == 0)
  {
    return EXIT_DONE;
  }
  std::cerr << "joint_twin: interrupted; " << output << " is readable and contains everything up to the interrupt\n";
  return EXIT_BY_SIGNAL + interruptSignal();
}
}  // namespace hjt
