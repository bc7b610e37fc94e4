// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_controller.hpp"

#include <algorithm>
#include <cmath>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"

namespace hjt
{
namespace
{
/// Of the motor, seen from the joint [kg.m^2].
double motorInertia(const Parameters& drive)
{
  const double ratio = nominalRatio(drive.gear);
  return ratio * ratio * (drive.motor.rotor_inertia + drive.motor.wave_generator_inertia);
}

/// By the motor's encoder [rad/s].
double jointSpeed(const EncoderReadings& read, const Twin& drive)
{
  return read.motor_velocity / nominalRatio(drive.parameters().gear);
}
}  // namespace

JointGains ArmController::defaultGains(const Parameters& drive)
{
  constexpr double SPEED_BANDWIDTH = 25.0;  // on the motor's inertia alone [Hz]
  JointGains gains;
  gains.position = 20.0;
  gains.speed = TWO_PI * SPEED_BANDWIDTH * motorInertia(drive);
  gains.integral_time = 0.07;
  return gains;
}

ArmController::ArmController(const ArmDescription& arm, const ArmTwin& twin, std::vector<JointGains> gains, double rate)
  : dynamics_(arm)
  , gains_(std::move(gains))
  , period_(std::llround(1e9 / rate))
  , rigid_(twin.joints())
  , feed_forward_(twin.joints())
  , integral_(twin.joints())
  , speed_(twin.joints())
{
  for (const ArmJoint& joint : arm.joints)
  {
    feedback_limit_.push_back(joint.feedback_limit > 0.0 ? joint.feedback_limit : HUGE_VAL);
  }
}

void ArmController::reset() noexcept
{
  std::fill(integral_.begin(), integral_.end(), 0.0);
  controlled_ = NEVER;
  limited_ = 0;
}

bool ArmController::isDue(const ArmTwin& twin) const noexcept
{
  return (twin.stamp() + twin.stepLength()) % period_ == 0;
}

double ArmController::speed(const ArmTwin& twin, std::size_t joint) const noexcept
{
  const Twin& drive = twin.drive(joint);
  return twin.stamp() < controlled_ + period_ ? speed_[joint] : jointSpeed(drive.encoders(), drive);
}

void ArmController::control(ArmTwin& twin, const std::vector<JointMotion>& set_point) noexcept
{
  dynamics_.torques(set_point, rigid_);
  controlled_ = twin.stamp() + twin.stepLength();
  for (std::size_t i = 0; i < twin.joints(); ++i)
  {
    Twin& drive = twin.drive(i);
    const JointGains& gain = gains_[i];
    const JointMotion& wanted = set_point[i];
    const double ratio = nominalRatio(drive.parameters().gear);
    const EncoderReadings read = drive.encoders();
    const double direction = wanted.velocity == 0.0 ? 0.0 : std::copysign(1.0, wanted.velocity);
    feed_forward_[i] = rigid_[i] + motorInertia(drive.parameters()) * wanted.acceleration + gain.coulomb * direction +
                       gain.viscous * wanted.velocity;
    const double speed = wanted.velocity + gain.position * (wanted.position - twin.startAngle(i) - read.output_angle);
    speed_[i] = jointSpeed(read, drive);
    const double error = speed - speed_[i];
    const double feedback = gain.speed * error + integral_[i];
    const double torque = feed_forward_[i] + std::clamp(feedback, -feedback_limit_[i], feedback_limit_[i]);
    const double limit = ratio * drive.parameters().motor.torque_limit;
    const bool is_limited = std::abs(feedback) >= feedback_limit_[i];
    const bool is_braked = drive.outputs().brake_engaged;
    limited_ += is_limited && !is_braked ? 1 : 0;
    if (!is_limited && std::abs(torque) < limit && !is_braked)
    {
      integral_[i] += toSeconds(period_) * gain.speed / gain.integral_time * error;
    }
    drive.commandMotorTorque(twin.stamp(), std::clamp(torque, -limit, limit) / ratio);
  }
}
}  // namespace hjt
