// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <ros/console.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/time.h>

#include "base/number_text.hpp"
#include "live/realtime.hpp"
#include "live/twin_loop.hpp"
#include "messages/time.hpp"

namespace hjt
{
struct DiagnosticVerdict
{
  std::uint8_t level{};
  std::string text;
};

/// Verdict of the first true condition; `otherwise` if no condition is true.
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

/// Tasks of /diagnostics, each with a verdict and values. All tasks are reported every `~diagnostic_period` (default
/// 1 s) and when a level changes. The period is in wall clock time, because a simulated clock may stop.
/// diagnostic_updater::Updater is unsuitable: it uses the ROS clock and throws near the largest time of ROS.
class DiagnosticTasks
{
public:
  static constexpr double LOOK_PERIOD = 0.2;  ///< time between two calls of `look` [s]

  /// `name`: name of the twin, which precedes the name of each task.
  DiagnosticTasks(const std::string& name, const std::string& hardware_id)
    : name_(name)
    , hardware_id_(hardware_id)
    , period_(ros::NodeHandle("~").param("diagnostic_period", 1.0))
    , publisher_(ros::NodeHandle().advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", QUEUE_SIZE))
  {
  }

  /// Adds a task, which members of `owner` judge and report. The owner must outlive this object.
  template <class Owner>
  void add(const std::string& name, const Owner* owner, DiagnosticVerdict (Owner::*judge)() const,
           void (Owner::*report)(diagnostic_updater::DiagnosticStatusWrapper&) const)
  {
    tasks_.push_back({ name_ + ": " + name,
                       [=] { return (owner->*judge)(); },
                       [=](auto& status) { (owner->*report)(status); },
                       {} });
  }

  /// Judges every task, and publishes a report if one is due.
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

  static constexpr unsigned QUEUE_SIZE = 20;  // number of messages; all joints of an arm report at once

  const std::string name_;
  const std::string hardware_id_;
  double period_;  // time between two reports [s]
  std::vector<Task> tasks_;
  ros::WallTime last_report_;
  ros::Publisher publisher_;
};

/// Whether a counter has increased in the last MEMORY seconds of wall clock time. A reader at 1 Hz sees each event.
class RecentEvents
{
public:
  static constexpr double MEMORY = 3.0;  ///< duration for which an event counts as recent [s]

  void update(std::uint64_t count, const ros::WallTime& now)
  {
    if (count > count_)
    {
      last_event_ = now;
    }
    // A reset of the counter is not an event.
    count_ = count;
    recent_ = !last_event_.isZero() && (now - last_event_).toSec() < MEMORY;
  }

  bool areRecent() const { return recent_; }

private:
  std::uint64_t count_{};
  ros::WallTime last_event_;
  bool recent_{};
};

/// Task of /diagnostics: whether the loop of a twin is in time with the clock. The task also logs that the clock jumps,
/// that the loop falls behind, and that the loop is in time again.
class TimingTask
{
public:
  /// `deadline`: realtime.deadline [s].
  TimingTask(const RealtimeState& realtime, double deadline)
    : realtime_(realtime), deadline_(deadline), clock_moved_(ros::WallTime::now())
  {
  }

  /// Updates the task. `dropped`: number of messages that could not be published.
  void update(const LoopStatus& loop, std::uint64_t dropped)
  {
    loop_ = loop;
    const ros::WallTime now = ros::WallTime::now();
    drops_.update(dropped, now);
    clock_jumps_.update(loop.clock_jumps, now);
    missed_deadlines_.update(loop.timing.missed_deadlines, now);
    if (loop.clock != last_clock_)
    {
      last_clock_ = loop.clock;
      clock_moved_ = now;
    }
    log();
  }

  DiagnosticVerdict judge() const
  {
    using D = diagnostic_msgs::DiagnosticStatus;
    return firstOf(
        { { loop_.clock == 0, { D::WARN, "No time on /clock yet" } },
          { clock_jumps_.areRecent(), { D::WARN, jumpText(loop_) + ": restarted" } },
          { drops_.areRecent(), { D::WARN, "Messages are dropped because publishing is too slow" } },
          { is_behind_,
            { D::WARN, "The twin is behind the clock and catches up; ~reset restarts it at the current instant" } },
          { missed_deadlines_.areRecent(),
            { D::WARN, "Deadlines were missed: steps ended later than realtime.deadline allows" } },
          { (ros::WallTime::now() - clock_moved_).toSec() > CLOCK_STANDS_AFTER, { D::WARN, "The clock has stopped" } },
          { !realtime_.refusals.empty(),
            { D::WARN, "The twin is in time, but the system refused a request of section realtime; see the log" } } },
        { D::OK, "The twin is in time" });
  }

  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const
  {
    status.add("Clock", ros::Time::isSimTime() ? "/clock" : "system");
    status.add("Clock [s]", fixedText(toSeconds(loop_.clock), 4));
    status.add("Simulated instant [s]", fixedText(toSeconds(loop_.twin_stamp), 4));
    status.add("Lag [s]", toSeconds(loop_.lag));
    status.add("Largest lag [s]", toSeconds(loop_.largest_lag));
    status.add("Deadline [s]", deadline_);
    status.add("Deadlines missed", loop_.timing.missed_deadlines);
    status.add("Lateness, median [s]", toSeconds(loop_.timing.lateness.quantile(0.5)));
    status.add("Lateness, 99.9 % [s]", toSeconds(loop_.timing.lateness.quantile(0.999)));
    status.add("Lateness, largest [s]", toSeconds(loop_.timing.lateness.largest()));
    status.add("Wake-up jitter, 99.9 % [s]", toSeconds(loop_.timing.wake_up.quantile(0.999)));
    status.add("Wake-up jitter, largest [s]", toSeconds(loop_.timing.wake_up.largest()));
    status.add("Longest cycle [s]", toSeconds(loop_.timing.longest_cycle));
    status.add("Real-time factor", loop_.timing.realTimeFactor());
    status.add("Load of the loop", loop_.timing.load());
    status.add("Scheduling", realtime_.scheduling);
    status.add("Memory", realtime_.memory);
    status.add("Processor", realtime_.processor);
    status.add("Cycles", loop_.cycles);
    status.add("Cycles overrun", loop_.overruns);
    status.add("Clock jumps", loop_.clock_jumps);
    status.add("Resets on request", loop_.resets);
  }

private:
  // Time without a change of the ROS clock after which the clock counts as stopped [s, wall clock].
  static constexpr double CLOCK_STANDS_AFTER = 1.0;
  // Lag of the twin behind the clock above which the node warns [s].
  static constexpr double LAG_WARNING = 1.0;
  // Lag of the twin behind the clock below which the twin counts as in time again [s].
  static constexpr double CAUGHT_UP = 0.1;

  static std::string jumpText(const LoopStatus& loop)
  {
    const double seconds = toSeconds(loop.last_jump);
    return "The clock jumped " + std::string(seconds > 0.0 ? "ahead" : "back") + " by " +
           roundedText(std::abs(seconds), 3) + " s";
  }

  void log()
  {
    if (logged_clock_jumps_ != loop_.clock_jumps)
    {
      logged_clock_jumps_ = loop_.clock_jumps;
      ROS_WARN_STREAM(jumpText(loop_) << ": the twin restarts");
    }
    const double lag = toSeconds(loop_.lag);
    if (!is_behind_ && lag > LAG_WARNING)
    {
      ROS_WARN_STREAM("The twin is " << roundedText(lag, 3)
                                     << " s behind the clock. Its steps take longer than they simulate, "
                                        "or the process was suspended. ~reset restarts it at the current instant");
    }
    if (is_behind_ && lag < CAUGHT_UP)
    {
      ROS_INFO("The twin is in time again");
    }
    is_behind_ = lag > (is_behind_ ? CAUGHT_UP : LAG_WARNING);
  }

  const RealtimeState& realtime_;
  const double deadline_;
  LoopStatus loop_;
  RecentEvents drops_;
  RecentEvents clock_jumps_;
  RecentEvents missed_deadlines_;
  std::uint64_t logged_clock_jumps_{};
  bool is_behind_{};
  Stamp last_clock_{};
  ros::WallTime clock_moved_;
};
}  // namespace hjt
