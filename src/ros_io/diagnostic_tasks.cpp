// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/diagnostic_tasks.hpp"

#include <utility>

namespace hjt
{
void DiagnosticTasks::add(const std::string& name, std::function<DiagnosticVerdict()> judge,
                          const std::function<void(diagnostic_updater::DiagnosticStatusWrapper&)>& report)
{
  Task& task = tasks_.emplace_back(Task{ std::move(judge), {} });
  updater_.add(name,
               [&task, report](diagnostic_updater::DiagnosticStatusWrapper& status)
               {
                 status.summary(task.verdict.level, task.verdict.text);
                 report(status);
               });
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
  if (changed || (now - last_report_).toSec() >= updater_.getPeriod())
  {
    last_report_ = now;
    updater_.force_update();
  }
}
}  // namespace hjt
