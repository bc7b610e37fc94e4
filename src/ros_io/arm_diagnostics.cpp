// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/arm_diagnostics.hpp"

#include <utility>

#include "base/joined.hpp"

namespace hjt
{
ArmDiagnostics::ArmDiagnostics(ros::NodeHandle& node, const ArmDescription& arm, const Parameters& parameters,
                               const RealtimeState& realtime, Read read)
  : arm_(arm)
  , read_(std::move(read))
  , failures_(arm.joints.size())
  , overloads_(arm.joints.size())
  , timing_(realtime, parameters.realtime.deadline)
  , tasks_(node.getNamespace().substr(1), parameters.joint.hardware_id)
{
  tasks_.add("Arm", this, &ArmDiagnostics::judge, &ArmDiagnostics::report);
  tasks_.add("Timing", &timing_, &TimingTask::judge, &TimingTask::report);
  timer_ = node.createWallTimer(ros::WallDuration(DiagnosticTasks::LOOK_PERIOD), [this](const auto&) { look(); });
}

void ArmDiagnostics::look()
{
  snapshot_ = read_();
  const ros::WallTime now = ros::WallTime::now();
  for (std::size_t i = 0; i < snapshot_.drives.size(); ++i)
  {
    failures_[i].update(snapshot_.drives[i].solver_failures, now);
    overloads_[i].update(snapshot_.drives[i].overloads, now);
  }
  timing_.update(snapshot_.loop, snapshot_.dropped);
  tasks_.look();
}

/// Of the joints with recent events; empty: none.
std::string ArmDiagnostics::namesOf(const std::vector<RecentEvents>& events) const
{
  std::vector<std::string> names;
  for (std::size_t i = 0; i < events.size(); ++i)
  {
    if (events[i].areRecent())
    {
      names.push_back(arm_.joints[i].short_name);
    }
  }
  return joined(names);
}

DiagnosticVerdict ArmDiagnostics::judge() const
{
  using D = diagnostic_msgs::DiagnosticStatus;
  const std::string failed = namesOf(failures_);
  const std::string overloaded = namesOf(overloads_);
  return firstOf(
      { { !snapshot_.stop_reason.empty(), { D::ERROR, "Protective stop: " + snapshot_.stop_reason } },
        { !failed.empty(), { D::ERROR, "The solver did not converge: " + failed } },
        { !overloaded.empty(),
          { D::WARN, "Torque beyond output.torque_limit, where a step costs more than its time: " + overloaded } } },
      { D::OK, "Moves" });
}

void ArmDiagnostics::report(diagnostic_updater::DiagnosticStatusWrapper& status) const
{
  for (std::size_t i = 0; i < snapshot_.drives.size(); ++i)
  {
    const TwinCounters& drive = snapshot_.drives[i];
    const std::string& name = arm_.joints[i].short_name;
    status.add(name + ": steps beyond the joint's torque limit", drive.overloads);
    status.add(name + ": steps cut", drive.step_cuts);
    status.add(name + ": steps failed", drive.solver_failures);
  }
}
}  // namespace hjt
