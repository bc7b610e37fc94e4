// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

#include "gear/ratio.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"

namespace hjt
{
/// Least, mean and greatest value of a signal; of no value all are 0.
class SignalSpan
{
public:
  void add(double value) noexcept
  {
    least_ = count_ > 0 ? std::min(least_, value) : value;
    greatest_ = count_ > 0 ? std::max(greatest_, value) : value;
    sum_ += value;
    ++count_;
  }

  double least() const noexcept { return least_; }
  double greatest() const noexcept { return greatest_; }
  double mean() const noexcept
  {
    return count_ > 0 ? std::clamp(sum_ / static_cast<double>(count_), least_, greatest_) : 0.0;
  }

private:
  double least_{};
  double greatest_{};
  double sum_{};
  std::uint64_t count_{};
};

/// Range of a signal since a topic's last message, over the steps in which somebody listened to a topic
/// that summarises them.
struct SinceMessage
{
  SinceMessage(Stamp last = 0) : stamp(last) {}  // NOLINT(google-explicit-constructor): a stamp says all of most topics

  void add(const Twin& twin) noexcept
  {
    const JointOutputs& outputs = twin.outputs();
    torsion.add(outputs.motor_angle / nominalRatio(twin.parameters().gear) - outputs.output_angle);
    motor_torque.add(outputs.motor_torque);
    joint_torque.add(outputs.joint_torque);
  }

  Stamp stamp;              ///< of the last message [ns]
  SignalSpan torsion;       ///< [rad]
  SignalSpan motor_torque;  ///< [N.m]
  SignalSpan joint_torque;  ///< [N.m]
};
}  // namespace hjt
