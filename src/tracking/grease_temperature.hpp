// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "elements/drive_heat.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// Temperature of the grease of a measured joint, from the losses of its motion.
///
/// thermal.model = none: the temperature of the sample, or as configured. two_nodes: a measured temperature is that of
/// the housing, beside the motor, and the grease warms up above it; where none is measured both nodes warm up above
/// surroundings of input.temperature. Over a gap the joint is taken to stand. Nothing allocates.
class GreaseTemperature
{
public:
  explicit GreaseTemperature(const Parameters& parameters)
    : heat_(parameters.thermal)
    , housing_rise_(parameters.thermal.housing_rise)
    , copper_loss_(parameters.motor.copper_loss)
    , configured_(parameters.input.temperature)
    , on_(parameters.thermal.model == ThermalModel::TWO_NODES)
  {
  }

  /// Temperature of the grease at a sample, by the losses booked before it [degC].
  double at(const MotionSample& sample) noexcept
  {
    if (!on_)
    {
      return sample.temperatureOr(configured_);
    }
    const bool measured = std::isfinite(sample.temperature);
    if (!started_)
    {
      heat_.reset(measured ? sample.temperature - housing_rise_ : configured_);
      last_ = sample.time;
      started_ = true;
    }
    const double seconds = std::max(sample.time - last_, 0.0);
    last_ = sample.time;
    elapsed_ += seconds;
    if (!sample.after_gap)
    {
      losses_.friction += friction_power_ * seconds;
      losses_.copper += copper_power_ * seconds;
    }
    if (elapsed_ >= DriveHeat::PERIOD)
    {
      if (measured)
      {
        heat_.advanceGrease(elapsed_, losses_.friction, sample.temperature);
      }
      else
      {
        heat_.advance(elapsed_, losses_, configured_);
      }
      losses_ = {};
      elapsed_ = 0.0;
    }
    return std::clamp(heat_.grease(), MIN_TEMPERATURE, MAX_TEMPERATURE);
  }

  /// Losses from a sample to the next: joint's speed [rad/s], friction at the joint and motor torque [N.m].
  void book(double velocity, double friction_torque, double motor_torque) noexcept
  {
    friction_power_ = std::abs(friction_torque * velocity);
    copper_power_ = copper_loss_ * motor_torque * motor_torque;
  }

  /// Temperature of the housing with two nodes; else that of the grease [degC].
  double housing(double grease) const noexcept { return on_ ? heat_.housing() : grease; }

private:
  DriveHeat heat_;
  double housing_rise_;  // [K]
  double copper_loss_;   // [W/(N.m)^2]
  double configured_;    // [degC]
  bool on_;
  bool started_{};
  double last_{};             // time of the last sample [s]
  double elapsed_{};          // since the nodes were last advanced [s]
  DriveHeat::Losses losses_;  // meanwhile
  double friction_power_{};   // [W]
  double copper_power_{};     // [W]
};
}  // namespace hjt
