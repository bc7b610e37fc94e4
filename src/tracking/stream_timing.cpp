// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/stream_timing.hpp"

#include <algorithm>
#include <cmath>

namespace hjt
{
namespace
{
template <std::size_t N>
double quantile(std::array<double, N> values, std::size_t count, double part) noexcept
{
  if (count == 0)
  {
    return 0.0;
  }
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(count - 1));
  std::nth_element(values.begin(), place, values.begin() + static_cast<std::ptrdiff_t>(count));
  return *place;
}
}  // namespace

void StreamTiming::add(double time, double received) noexcept
{
  if (report_.rows > 0 && time <= last_)
  {
    ++(time == last_ ? report_.repeated : report_.backward);
    return;
  }
  const double interval = report_.rows > 0 ? time - last_ : 0.0;
  const std::size_t slot = report_.rows % KEPT;
  // The first row has none: the second one's stands for it.
  intervals_[slot] = interval;
  intervals_[0] = report_.rows == 1 ? interval : intervals_[0];
  delays_[slot] = received - time;
  last_ = time;
  ++report_.rows;
  if (report_.rows % RENEW == 0)
  {
    report_.period = quantile(intervals_, kept(), 0.5);
  }
  report_.longest_gap = std::max(report_.longest_gap, interval);
  if (report_.period > 0.0 && interval > 1.5 * report_.period)
  {
    report_.missing += static_cast<std::uint64_t>(std::lround(interval / report_.period)) - 1;
  }
}

StreamTimingReport StreamTiming::report() const noexcept
{
  StreamTimingReport report = report_;
  report.period = quantile(intervals_, kept(), 0.5);
  report.offset = quantile(delays_, kept(), 0.0);
  report.jitter = quantile(delays_, kept(), 0.95) - report.offset;
  return report;
}
}  // namespace hjt
