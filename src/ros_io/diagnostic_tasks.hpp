// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/time.h>

#include "messages/time.hpp"

namespace hjt
{
/// Level and text of one diagnostic task.
struct DiagnosticVerdict
{
  std::uint8_t level{};
  std::string text;
};

/// The verdict of the first condition that holds, else `otherwise`.
inline DiagnosticVerdict firstOf(const std::vector<std::pair<bool, DiagnosticVerdict>>& conditions,
                                 DiagnosticVerdict otherwise)
{
  for (const auto& [holds, verdict] : conditions)
  {
    if (holds)
    {
      return verdict;
    }
  }
  return otherwise;
}

/// Tasks of /diagnostics, each with a verdict and values: reported every `~diagnostic_period`, 1 s if that is not set,
/// by the wall clock, since a simulated one may stand, and at once when a level changes. diagnostic_updater::Updater
/// cannot serve: it adds to the time of the clock, and throws where that is near the last one.
class DiagnosticTasks
{
public:
  static constexpr double LOOK_PERIOD = 0.2;  ///< between two calls of `look` [s]

  /// `name`: of the twin, before that of each task.
  DiagnosticTasks(const std::string& name, const std::string& hardware_id)
    : name_(name)
    , hardware_id_(hardware_id)
    , period_(ros::NodeHandle("~").param("diagnostic_period", 1.0))
    , publisher_(ros::NodeHandle().advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", QUEUE_SIZE))
  {
  }

  /// A task judged and reported by two members of its owner, which lives as long as this.
  template <class Owner>
  void add(const std::string& name, const Owner* owner, DiagnosticVerdict (Owner::*judge)() const,
           void (Owner::*report)(diagnostic_updater::DiagnosticStatusWrapper&) const)
  {
    tasks_.push_back({ name_ + ": " + name,
                       [=] { return (owner->*judge)(); },
                       [=](auto& status) { (owner->*report)(status); },
                       {} });
  }

  /// Judges every task, and reports if it is time.
  void look()
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

private:
  struct Task
  {
    std::string name;
    std::function<DiagnosticVerdict()> judge;
    std::function<void(diagnostic_updater::DiagnosticStatusWrapper&)> report;
    DiagnosticVerdict verdict;
  };

  void report() const
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

  static constexpr unsigned QUEUE_SIZE = 20;  // the joints of an arm report at once

  const std::string name_;
  const std::string hardware_id_;
  double period_;  // [s]
  std::vector<Task> tasks_;
  ros::WallTime last_report_;
  ros::Publisher publisher_;
};
}  // namespace hjt
