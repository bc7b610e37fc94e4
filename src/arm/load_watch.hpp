// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "arm/arm_load.hpp"
#include "arm/load_fit.hpp"
#include "tracking/motion_driven.hpp"

namespace hjt
{
/// Payload and mounting that an arm's currents show while its rows come: looked for after 30 s of motion, each time
/// that is doubled, and after eight minutes all over again. Not for a real-time loop: it allocates.
class LoadWatch
{
public:
  /// `joints`: parameters of each. @throws ParameterError as MotionDriven.
  LoadWatch(const ArmDescription& arm, const std::vector<Parameters>& joints);

  /// `touched`: something touches the arm, or looks like it.
  void add(const ArmSample& sample, bool touched = false);
  /// Whether the currents of a joint, by its number, are measured: else they do not count.
  void setMeasured(std::size_t joint, bool is_measured) { counts_[joint] = is_measured; }
  /// Starts again.
  void reset();

  /// What the currents show of the load, if it is time to look.
  std::optional<FoundLoad> look();
  /// A payload other than what counts now, that clearly explains the currents. Where it does not differ from the arm's
  /// own, which is named as the configured one, that is carried again.
  std::optional<IdentifiedPayload> payloadOf(const FoundLoad& found) const;

  /// A mounting other than what counts now, beside the arm's own; the arm's own again where it does not differ.
  std::optional<IdentifiedMounting> mountingOf(const FoundLoad& found) const;

  /// That counts from now on; starts again.
  void configure(const Payload& payload);
  void mount(const std::array<double, 3>& gravity);  ///< likewise, gravity in the frame of the base [m/s^2]
  /// The arm with the payload and the mounting that count.
  const ArmDescription& arm() const { return arm_; }
  /// The arm's own payload.
  const Payload& given() const { return given_; }

private:
  static constexpr double FIRST_LOOK = 30.0;  // of motion [s]
  static constexpr double PERIOD = 0.02;      // of the rows that count, at least [s]

  ArmDescription arm_;
  Payload given_;
  std::array<double, 3> given_gravity_;  // [m/s^2]
  std::vector<bool> counts_;
  std::vector<double> gains_;  // [N.m/A]
  std::vector<MotionDriven> twins_;
  std::optional<LoadFit> fit_;
  std::vector<MotionSample> samples_;
  std::vector<double> predicted_;  // [A]
  double last_time_{ -HUGE_VAL };  // that counted [s]
  double next_look_{ FIRST_LOOK };
  bool is_new_{ true };  // the next row comes after a gap
};
}  // namespace hjt
