// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace hjt
{
/// How stamped rows arrive. Times in seconds from one zero.
struct StreamTimingReport
{
  std::uint64_t rows{};      ///< that brought something new
  std::uint64_t repeated{};  ///< with the stamp of the row before
  std::uint64_t backward{};  ///< with an earlier one
  std::uint64_t missing{};   ///< that the period would have had between two others
  double period{};           ///< between stamps, median of the last rows [s]
  double longest_gap{};      ///< between stamps [s]
  double offset{};  ///< smallest reception less stamp of the last rows: offset of the clocks and shortest transport [s]
  double jitter{};  ///< how far beyond it 95 of 100 rows stay [s]
};

/// Watches the stamps of a stream and when its rows arrive. Fixed memory; nothing allocates.
class StreamTiming
{
public:
  /// Stamps that go back by more are a new stream: a new recording, or a clock that was set [s].
  static constexpr double RESTART = 1.0;

  void reset() noexcept { *this = StreamTiming(); }

  void add(double time, double received) noexcept
  {
    if (time < last_ - RESTART)
    {
      reset();
    }
    if (time <= last_)
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

  StreamTimingReport report() const noexcept
  {
    StreamTimingReport report = report_;
    report.period = quantile(intervals_, kept(), 0.5);
    report.offset = quantile(delays_, kept(), 0.0);
    report.jitter = quantile(delays_, kept(), 0.95) - report.offset;
    return report;
  }

private:
  static constexpr std::size_t KEPT = 256;  // rows that medians are made of
  static constexpr std::size_t RENEW = 32;  // rows between two updates of the period

  template <std::size_t N>
  static double quantile(std::array<double, N> values, std::size_t count, double part) noexcept
  {
    if (count == 0)
    {
      return 0.0;
    }
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(count - 1));
    std::nth_element(values.begin(), place, values.begin() + static_cast<std::ptrdiff_t>(count));
    return *place;
  }

  std::size_t kept() const noexcept { return report_.rows < KEPT ? static_cast<std::size_t>(report_.rows) : KEPT; }

  StreamTimingReport report_;
  std::array<double, KEPT> intervals_{};
  std::array<double, KEPT> delays_{};
  double last_{ -std::numeric_limits<double>::infinity() };
};
}  // namespace hjt
