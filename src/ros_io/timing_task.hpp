// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include <ros/console.h>
#include <ros/time.h>

#include "base/number_text.hpp"
#include "live/realtime.hpp"
#include "live/twin_loop.hpp"
#include "messages/time.hpp"
#include "ros_io/diagnostic_tasks.hpp"
#include "ros_io/recent_events.hpp"

namespace hjt
{
/// Whether a loop keeps up with the clock, as a task of /diagnostics. Also logs each jump of the clock, and when the
/// loop falls behind and is in time again.
class TimingTask
{
public:
  /// `deadline`: realtime.deadline [s].
  TimingTask(const RealtimeState& realtime, double deadline)
    : realtime_(realtime), deadline_(deadline), clock_moved_(ros::WallTime::now())
  {
  }

  /// Once a look. `dropped`: messages that could not be published.
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
          { drops_.areRecent(), { D::WARN, "Messages dropped: publishing cannot keep up" } },
          { is_behind_, { D::WARN, "Behind the clock and catching up; ~reset restarts at the current instant" } },
          { missed_deadlines_.areRecent(),
            { D::WARN, "Deadlines missed: instants simulated late by more than realtime.deadline" } },
          { (ros::WallTime::now() - clock_moved_).toSec() > CLOCK_STANDS_AFTER, { D::WARN, "The clock has stopped" } },
          { !realtime_.refusals.empty(), { D::WARN, "In time, but a request of realtime was refused: see the log" } } },
        { D::OK, "In time" });
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
  // Report the ROS clock as stopped after this long without a change [s, wall time].
  static constexpr double CLOCK_STANDS_AFTER = 1.0;
  // Warn when the twin is further behind than this [s].
  static constexpr double LAG_WARNING = 1.0;
  // In time again below this [s].
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
                                     << " s behind the clock: it computes longer than it simulates, "
                                        "or was not run; ~reset restarts it at the current instant");
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
