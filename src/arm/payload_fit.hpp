// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "arm/arm_description.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// The payload that an arm's currents show, beside the configured one.
struct IdentifiedPayload
{
  Payload configured;
  double mass{};                              ///< [kg]
  double mass_half_width{};                   ///< of its 95 % interval [kg]
  std::array<double, 3> moment{};             ///< mass times centre, in the frame of the tip [kg.m]
  std::array<double, 3> moment_half_width{};  ///< of their 95 % intervals [kg.m]
  double least_claim{};                       ///< what sound arms of this mass show without a payload, at most [kg]
  double residual_share{ 1.0 };               ///< of the torques not predicted, that is left with it, rms [-]

  /// The configured mass is outside the interval, and farther off than arms without a payload show.
  bool differs() const;
  /// It differs, and is a mass at all.
  bool isCarried() const { return differs() && mass > mass_half_width; }
  /// What it is, its centre where it has a mass.
  Payload payload() const;
  /// "The currents look like a payload of ... in place of the configured ...", a clause.
  std::string text() const;
};

/// Mass and centre of an arm's payload from the currents of all joints while they move, by least squares.
///
///   residual_i = (Y_i . (m, m c) + e_i (load_i + Y_i . (m, m c))) / gain_i + s a_i + b_i v + o_i
/// with Y_i the torque of a unit payload at joint i (rigid-body dynamics), and for each joint, as nuisances, an error
/// of the gain, of the Coulomb and the viscous friction and an offset, each normally distributed about zero. Each row
/// of the fit is the mean over 0.1 s of one joint that moves one way; it counts by the deviation and the correlation of
/// that joint's rows, outliers less. The interval holds three parts: that of the fit, or by leaving out one tenth of
/// the time after the other where that is wider, and 2 % of the links' own masses.
class PayloadFit
{
public:
  static constexpr double MOST_TIME = 600.0;  ///< of motion; what comes later does not count [s]

  /// @param gains of each joint, from the base on [N.m/A]
  PayloadFit(const ArmDescription& arm, std::vector<double> gains);
  ~PayloadFit();
  PayloadFit(const PayloadFit&) = delete;
  PayloadFit& operator=(const PayloadFit&) = delete;

  /// Samples of one time, and the current that each joint's twin predicts [A].
  void add(const std::vector<MotionSample>& samples, const std::vector<double>& predicted);

  IdentifiedPayload solve();
  double moved() const;  ///< time in which a joint moved [s]

private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// The same of whole recordings.
/// @param samples of each joint, from the base on, of the same times. @param predicted current of each [A]
/// @param gains [N.m/A]
IdentifiedPayload identifyPayload(const ArmDescription& arm, const std::vector<std::vector<MotionSample>>& samples,
                                  const std::vector<std::vector<double>>& predicted, const std::vector<double>& gains);
}  // namespace hjt
