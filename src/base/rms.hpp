// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

namespace hjt
{
/// Root mean square of what is added.
class Rms
{
public:
  void add(double value)
  {
    squares_ += value * value;
    ++count_;
  }
  double value() const { return count_ > 0 ? std::sqrt(squares_ / static_cast<double>(count_)) : 0.0; }

private:
  double squares_{};
  std::uint64_t count_{};
};
}  // namespace hjt
