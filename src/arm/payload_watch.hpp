// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "arm/arm_load.hpp"
#include "arm/payload_fit.hpp"
#include "tracking/motion_driven.hpp"

namespace hjt
{
/// The payload that an arm's currents show while its rows come: looked for after 30 s of motion, each time that is
/// doubled, and after eight minutes all over again. Not in a loop: it allocates.
class PayloadWatch
{
public:
  /// `joints`: parameters of each. @throws ParameterError as MotionDriven.
  PayloadWatch(const ArmDescription& arm, const std::vector<Parameters>& joints);

  /// Rows of a sample count unless something touches the arm.
  void add(const ArmSample& sample);
  /// Starts again.
  void reset();

  /// One that is not configured, and clearly explains the currents; none: it is not time to look, or there is none.
  std::optional<IdentifiedPayload> look();

  /// That counts from now on; starts again.
  void configure(const Payload& payload);
  const ArmDescription& arm() const { return arm_; }

private:
  static constexpr double FIRST_LOOK = 30.0;  // of motion [s]
  static constexpr double PERIOD = 0.02;      // of the rows that count, at least [s]

  ArmDescription arm_;
  std::vector<double> gains_;  // [N.m/A]
  std::vector<MotionDriven> twins_;
  std::optional<PayloadFit> fit_;
  std::vector<MotionSample> samples_;
  std::vector<double> predicted_;  // [A]
  double last_time_{ -HUGE_VAL };  // that counted [s]
  double next_look_{ FIRST_LOOK };
};
}  // namespace hjt
