// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/diagnostic_tasks.hpp"

#include <utility>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/node_handle.h>
#include <ros/this_node.h>

#include "ros_io/time.hpp"

namespace hjt
{
DiagnosticTasks::DiagnosticTasks(const std::string& hardware_id)
  : hardware_id_(hardware_id)
  , period_(ros::NodeHandle("~").param("diagnostic_period", 1.0))
  , publisher_(ros::NodeHandle().advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 1))
{
}

void DiagnosticTasks::add(const std::string& name, std::function<DiagnosticVerdict()> judge,
                          std::function<void(diagnostic_updater::DiagnosticStatusWrapper&)> report)
{
  tasks_.push_back({ ros::this_node::getName().substr(1) + ": " + name, std::move(judge), std::move(report), {} });
}

void DiagnosticTasks::look()
{
  bool changed = false;
  for (Task& task : tasks_)
  {
    DiagnosticVerdict verdict = task.judge();
    changed = changed || verdict.level != task.verdict.level;
    task.verdict = std::move(verdict);
  }
  const ros::WallTime now = ros::WallTime::now();
  if (changed || (now - last_report_).toSec() >= period_)
  {
    last_report_ = now;
    report();
  }
}

void DiagnosticTasks::report() const
{
  diagnostic_msgs::DiagnosticArray message;
  message.header.stamp = toRosTime(fromRosTime(ros::Time::now()));
  for (const Task& task : tasks_)
  {
    diagnostic_updater::DiagnosticStatusWrapper status;
    status.name = task.name;
    status.hardware_id = hardware_id_;
    status.summary(task.verdict.level, task.verdict.text);
    task.report(status);
    message.status.push_back(status);
  }
  publisher_.publish(message);
}
}  // namespace hjt
