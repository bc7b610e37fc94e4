// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/diagnostics.hpp"

#include <cctype>
#include <cmath>

#include <ros/console.h>

#include "base/number_text.hpp"

namespace hjt
{
namespace
{
using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

/// Time by which a command's stamp may be ahead of the clock without a warning [s].
constexpr double AHEAD_WARNING = 1.0;

const char* stateText(LoopState state)
{
  constexpr std::array TEXTS{ "at rest, waiting for the clock", "at rest, waiting for the first input", "running" };
  return TEXTS[static_cast<std::size_t>(state)];
}
}  // namespace

std::string verdictText(const Assessment& assessment)
{
  if (assessment.level != HealthLevel::OK && assessment.cause == Cause::NONE)
  {
    return "The indicators deviate from the reference in a way that no known fault explains";
  }
  if (assessment.level != HealthLevel::OK)
  {
    TextStream text;
    text << "Most likely " << causeName(assessment.cause) << " (" << std::lround(100.0 * assessment.confidence)
         << " %)";
    return text.str();
  }
  std::string text = whyNotJudged(assessment);
  if (text.empty())
  {
    return "The indicators agree with the reference";
  }
  text[0] = static_cast<char>(std::toupper(text[0]));
  return text;
}

void addAssessment(const Assessment& assessment, DiagnosticStatusWrapper& status)
{
  std::array<char, EVIDENCE_LENGTH> alternatives{};
  std::array<char, EVIDENCE_LENGTH> evidence{};
  writeAlternatives(assessment, alternatives.data(), alternatives.size());
  writeEvidence(assessment, evidence.data(), evidence.size());
  status.add("Cause", causeName(assessment.cause));
  status.add("Alternatives", alternatives.data());
  status.add("Confidence [-]", assessment.confidence);
  status.add("Severity [-]", assessment.severity);
  status.add("Severity, standard deviation [-]", assessment.severity_deviation);
  status.add("Evidence", evidence.data());
  status.add("Largest score over threshold [-]", assessment.largest_score);
  status.add("Windows", assessment.windows);
  status.add("Windows at this operating point", assessment.windows_here);
  status.add("Windows needed at an operating point", assessment.windows_needed);
  status.add("End of the last window [s]", toSeconds(assessment.stamp));
}

Diagnostics::Diagnostics(ros::NodeHandle& node, const Parameters& parameters, const TwinLoop& loop,
                         const RealtimeState& realtime, const Inbox& inbox, const InputSubscribers& subscribers,
                         const OutputPublishers& publishers)
  : loop_(loop)
  , inbox_(inbox)
  , subscribers_(subscribers)
  , publishers_(publishers)
  , command_timeout_(parameters.input.command_timeout)
  , timing_(realtime, parameters.realtime.deadline)
  , tasks_(node.getNamespace().substr(1), parameters.joint.hardware_id)
{
  tasks_.add("Drive", this, &Diagnostics::judgeDrive, &Diagnostics::reportDrive);
  tasks_.add("Input", this, &Diagnostics::judgeInput, &Diagnostics::reportInput);
  tasks_.add("Timing", this, &Diagnostics::judgeTiming, &Diagnostics::reportTiming);
  tasks_.add("Health", this, &Diagnostics::judgeHealth, &Diagnostics::reportHealth);
  timer_ = node.createWallTimer(ros::WallDuration(DiagnosticTasks::LOOK_PERIOD),
                                [this](const ros::WallTimerEvent&)
                                {
                                  readSnapshot();
                                  tasks_.look();
                                });
}

void Diagnostics::readSnapshot()
{
  snapshot_ = { loop_.status(), subscribers_.counters(), inbox_.notFinite(), inbox_.overflow(),
                publishers_.counters() };
  const LoopStatus& loop = snapshot_.loop;
  const TwinCounters& twin = loop.counters;
  const ros::WallTime now = ros::WallTime::now();
  solver_failures_.update(twin.solver_failures, now);
  step_cuts_.update(twin.step_cuts, now);
  jumps_.update(twin.jumps, now);
  coarse_steps_.update(twin.coarse_steps, now);
  speed_limits_.update(twin.speed_limited, now);
  overloads_.update(twin.overloads, now);
  clamps_.update(twin.torque_clamped + twin.load_clamped, now);
  late_inputs_.update(twin.input.late + twin.faults.late, now);
  timeouts_.update(twin.command_timeouts, now);
  lost_inputs_.update(twin.input.overflow + twin.faults.no_room + snapshot_.overflow, now);
  refusals_.update(snapshot_.not_finite + snapshot_.messages.unknown_joint + snapshot_.messages.missing_effort +
                       snapshot_.messages.refused_fault + snapshot_.messages.too_large + twin.faults.refused +
                       loop.far_stamps,
                   now);
  std::uint64_t dropped = 0;
  for (const ChannelCounters& output : snapshot_.outputs)
  {
    dropped += output.dropped;
  }
  timing_.update(loop, dropped);
}

DiagnosticVerdict Diagnostics::judgeDrive() const
{
  using D = DiagnosticStatus;
  return firstOf({ { !snapshot_.loop.outputs.converged || solver_failures_.areRecent(),
                     { D::ERROR, "The solver did not converge; the twin keeps its last converged state" } },
                   { step_cuts_.areRecent(), { D::WARN, "Some steps converged only after they were divided" } },
                   { jumps_.areRecent(), { D::WARN, "Teeth jumped to another space of the circular spline" } },
                   { coarse_steps_.areRecent(),
                     { D::WARN, "The time step is too long for the joint's fastest natural mode; raise solver.rate" } },
                   { overloads_.areRecent(), { D::WARN, "The torque at the joint exceeds output.torque_limit" } },
                   { speed_limits_.areRecent(), { D::WARN, "The motor is at its speed limit" } } },
                 { D::OK, stateText(snapshot_.loop.state) });
}

DiagnosticVerdict Diagnostics::judgeInput() const
{
  using D = DiagnosticStatus;
  const double age = toSeconds(snapshot_.loop.clock - snapshot_.loop.last_command);
  return firstOf(
      { { refusals_.areRecent(),
          { D::WARN,
            "Inputs were refused: not finite, not for this joint, an invalid fault, a message that is too large, or a "
            "stamp far from the clock" } },
        { lost_inputs_.areRecent(), { D::WARN, "Inputs were lost because the queue was full" } },
        { clamps_.areRecent(), { D::WARN, "A torque exceeded its limit and was clamped" } },
        { late_inputs_.areRecent(), { D::WARN, "Inputs arrived too late for their stamp; raise input.delay" } },
        { !snapshot_.loop.command_seen, { D::WARN, "No motor torque has been commanded yet" } },
        { age > command_timeout_ || timeouts_.areRecent(),
          { D::WARN, "No motor torque was commanded for longer than input.command_timeout; the torque is zero" } },
        { age < -AHEAD_WARNING, { D::WARN, "The stamps of the commands are ahead of the clock" } } },
      { D::OK, "Commands arrive" });
}

DiagnosticVerdict Diagnostics::judgeHealth() const
{
  const LoopStatus& loop = snapshot_.loop;
  const bool input = loop.command_seen && toSeconds(loop.clock - loop.last_command) <= command_timeout_;
  if (!input)
  {
    return { DiagnosticStatus::STALE, "The input has stopped. Last assessment: " + verdictText(loop.assessment) };
  }
  return { static_cast<std::uint8_t>(loop.assessment.level), verdictText(loop.assessment) };
}

void Diagnostics::reportDrive(DiagnosticStatusWrapper& status) const
{
  const JointOutputs& outputs = snapshot_.loop.outputs;
  const TwinCounters& counters = snapshot_.loop.counters;
  status.add("State", stateText(snapshot_.loop.state));
  status.add("Motor angle [rad]", outputs.motor_angle);
  status.add("Motor velocity [rad/s]", outputs.motor_velocity);
  status.add("Output angle [rad]", outputs.output_angle);
  status.add("Output velocity [rad/s]", outputs.output_velocity);
  status.add("Motor torque [N.m]", outputs.motor_torque);
  status.add("Joint torque [N.m]", outputs.joint_torque);
  status.add("Load torque [N.m]", outputs.load_torque);
  status.add("Brake engaged", outputs.brake_engaged);
  status.add("Energy residual [J]", outputs.energy_residual);
  status.add("Solver residual [N]", outputs.residual);
  status.add("Solver iterations", outputs.iterations);
  status.add("Steps", counters.steps);
  status.add("Substeps per step", outputs.substeps);
  status.add("Steps cut", counters.step_cuts);
  status.add("Steps in which teeth jumped", counters.jumps);
  status.add("Steps too long", counters.coarse_steps);
  status.add("Steps failed", counters.solver_failures);
  status.add("Steps at the speed limit", counters.speed_limited);
  status.add("Steps beyond the joint's torque limit", counters.overloads);
  const std::string faults = publishers_.activeFaults();
  status.add("Faults of the gear", faults.empty() ? "none" : faults);
}

void Diagnostics::reportInput(DiagnosticStatusWrapper& status) const
{
  const LoopStatus& loop = snapshot_.loop;
  const TwinCounters& counters = loop.counters;
  if (loop.command_seen)
  {
    status.add("Age of the last command [s]", toSeconds(loop.clock - loop.last_command));
  }
  status.add("Accepted", counters.input.accepted);
  status.add("Not finite, refused", snapshot_.not_finite + counters.input.not_finite);
  status.add("Unknown joint, refused", snapshot_.messages.unknown_joint);
  status.add("Missing effort, refused", snapshot_.messages.missing_effort);
  status.add("Faults, refused", snapshot_.messages.refused_fault + counters.faults.refused);
  status.add("Too large, refused", snapshot_.messages.too_large);
  status.add("Stamp far from the clock, refused", loop.far_stamps);
  status.add("Faults beyond the largest number, refused", counters.faults.no_room);
  status.add("Inputs too late for their stamps", counters.input.late + counters.faults.late);
  status.add("Dropped, queue full", counters.input.overflow + snapshot_.overflow);
  status.add("Steps with motor torque clamped", counters.torque_clamped);
  status.add("Steps with load torque clamped", counters.load_clamped);
  status.add("Command timeouts", counters.command_timeouts);
}

void Diagnostics::reportTiming(DiagnosticStatusWrapper& status) const
{
  timing_.report(status);
  for (const ChannelCounters& output : snapshot_.outputs)
  {
    status.add(std::string(output.name) + " computed", output.computed);
    status.add(std::string(output.name) + " dropped", output.dropped);
  }
}

void Diagnostics::reportHealth(DiagnosticStatusWrapper& status) const
{
  addAssessment(snapshot_.loop.assessment, status);
}
}  // namespace hjt
