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
  /// Rows that do not count: those that follow come after a gap.
  void leaveOut() noexcept { is_new_ = true; }
  /// Whether the currents of a joint, by its number, are measured: else they do not count.
  void setMeasured(std::size_t joint, bool is_measured) { counts_[joint] = is_measured; }
  /// Starts again.
  void reset();

  /// One other than what counts now, that clearly explains the currents; none: it is not time to look, or there is
  /// none. Where it does not differ from the arm's own, which is named as the configured one, that is carried again.
  std::optional<IdentifiedPayload> look();

  /// That counts from now on; starts again.
  void configure(const Payload& payload);
  /// The arm with the payload that counts.
  const ArmDescription& arm() const { return arm_; }
  /// The arm's own payload.
  const Payload& given() const { return given_; }

private:
  static constexpr double FIRST_LOOK = 30.0;  // of motion [s]
  static constexpr double PERIOD = 0.02;      // of the rows that count, at least [s]

  ArmDescription arm_;
  Payload given_;
  std::vector<bool> counts_;
  std::vector<double> gains_;  // [N.m/A]
  std::vector<MotionDriven> twins_;
  std::optional<PayloadFit> fit_;
  std::vector<MotionSample> samples_;
  std::vector<double> predicted_;  // [A]
  double last_time_{ -HUGE_VAL };  // that counted [s]
  double next_look_{ FIRST_LOOK };
  bool is_new_{ true };  // the next row comes after a gap
};
}  // namespace hjt
