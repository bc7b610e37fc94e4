// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <ros/time.h>

namespace hjt
{
/// Whether a counter has grown lately by the wall clock. Keeps a single event in sight of whoever reads once a second.
class RecentEvents
{
public:
  static constexpr double MEMORY = 3.0;  ///< an event counts as recent for so long [s]

  void update(std::uint64_t count, const ros::WallTime& now)
  {
    if (count > count_)
    {
      last_event_ = now;
    }
    // A reset of what is counted is no event.
    count_ = count;
    recent_ = !last_event_.isZero() && (now - last_event_).toSec() < MEMORY;
  }

  bool areRecent() const { return recent_; }

private:
  std::uint64_t count_{};
  ros::WallTime last_event_;
  bool recent_{};
};
}  // namespace hjt
