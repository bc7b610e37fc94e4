// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

namespace hjt
{
/// How far a quantity has varied lately: over the running window of fixed length and the one before it.
class RecentSpan
{
public:
  /// `window`: length of one window [ns].
  explicit RecentSpan(std::int64_t window) : window_(window) {}

  void reset() noexcept { *this = RecentSpan(window_); }

  void update(std::int64_t elapsed, double value) noexcept
  {
    age_ += elapsed;
    if (!started_)
    {
      started_ = true;
      age_ = 0;
      running_ = { value, value };
      before_ = running_;
    }
    else if (age_ >= window_)
    {
      age_ = 0;
      before_ = running_;
      running_ = { value, value };
    }
    running_ = { std::min(running_.lowest, value), std::max(running_.highest, value) };
  }

  double span() const noexcept
  {
    return std::max(running_.highest, before_.highest) - std::min(running_.lowest, before_.lowest);
  }

private:
  struct Extremes
  {
    double lowest{};
    double highest{};
  };

  std::int64_t window_;
  std::int64_t age_{};  // of the running window [ns]
  bool started_{};
  Extremes running_;
  Extremes before_;
};
}  // namespace hjt
