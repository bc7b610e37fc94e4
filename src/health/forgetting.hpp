// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

namespace hjt
{
/// Exponential forgetting in time: what is `window` old counts 1/e of what is new.
class Forgetting
{
public:
  /// `window`: time constant [s].
  explicit Forgetting(double window) : window_(window) {}

  /// Share that is kept over `elapsed` [ns]. Steps are nearly always alike, so the last one is remembered.
  double kept(std::int64_t elapsed) noexcept
  {
    if (elapsed != elapsed_)
    {
      elapsed_ = elapsed;
      kept_ = std::exp(-1e-9 * static_cast<double>(elapsed) / window_);
    }
    return kept_;
  }

private:
  double window_;
  std::int64_t elapsed_{};
  double kept_{ 1.0 };
};
}  // namespace hjt
