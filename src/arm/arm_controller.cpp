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
/// Speed of the joint by the motor's encoder [rad/s].
double jointSpeed(const EncoderReadings& read, const Twin& drive)
{
  return read.motor_velocity / nominalRatio(drive.parameters().gear);
}
}  // namespace

double ArmController::motorInertia(const Parameters& drive)
{
  const double ratio = nominalRatio(drive.gear);
  return ratio * ratio * (drive.motor.rotor_inertia + drive.motor.wave_generator_inertia);
}

JointGains ArmController::defaultGains(const Parameters& drive)
{
  constexpr double SPEED_BANDWIDTH = 25.0;  // bandwidth of the speed control if the motor has no load [Hz]
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
  , before_(twin.joints())
{
  double longest = 0.0;
  for (const ArmJoint& joint : arm.joints)
  {
    feedback_limit_.push_back(joint.feedback_limit > 0.0 ? joint.feedback_limit : HUGE_VAL);
    delay_.push_back(joint.delay * rate);
    const SensorParameters& sensors = twin.drive(delay_.size() - 1).parameters().sensors;
    speed_delay_.push_back((joint.delay + 0.5 * sensors.velocity_window) * rate);
    longest = std::max(longest, speed_delay_.back());
    const double ratio = nominalRatio(twin.drive(unseen_.size()).parameters().gear);
    unseen_.push_back(TWO_PI *
                      std::max(1.0 / sensors.output_counts_per_turn, 1.0 / (ratio * sensors.motor_counts_per_turn)));
  }
  line_.assign(twin.joints(), std::vector<Wanted>(static_cast<std::size_t>(longest) + 2));
}

void ArmController::reset() noexcept
{
  std::fill(integral_.begin(), integral_.end(), 0.0);
  std::fill(speed_.begin(), speed_.end(), 0.0);
  controlled_ = NEVER;
  limited_ = 0;
}

bool ArmController::isDue(const ArmTwin& twin) const noexcept
{
  return twin.stamp() % period_ == 0;
}

double ArmController::speed(const ArmTwin& twin, std::size_t joint) const noexcept
{
  const Twin& drive = twin.drive(joint);
  if (twin.stamp() >= controlled_ + period_)
  {
    return jointSpeed(drive.encoders(), drive);
  }
  return twin.stamp() == controlled_ ? before_[joint] : speed_[joint];
}

/// Adds the set point to the ring buffers line_. The first set point after a reset fills the whole ring buffers.
void ArmController::take(const ArmTwin& twin, const std::vector<JointMotion>& set_point) noexcept
{
  dynamics_.torques(set_point, rigid_);
  const bool is_first = controlled_ == NEVER;
  newest_ = newest_ + 1 == line_.front().size() ? 0 : newest_ + 1;
  for (std::size_t i = 0; i < set_point.size(); ++i)
  {
    const JointGains& gain = gains_[i];
    const JointMotion& wanted = set_point[i];
    const double direction = wanted.velocity == 0.0 ? 0.0 : std::copysign(1.0, wanted.velocity);
    feed_forward_[i] = rigid_[i] + motorInertia(twin.drive(i).parameters()) * wanted.acceleration +
                       gain.coulomb * direction + gain.viscous * wanted.velocity;
    const Wanted now{ wanted.position, wanted.velocity, feed_forward_[i] };
    if (is_first)
    {
      std::fill(line_[i].begin(), line_[i].end(), now);
    }
    line_[i][newest_] = now;
  }
}

/// Set point of a joint that is `periods` control periods older than the newest one, by linear interpolation.
ArmController::Wanted ArmController::delayed(std::size_t joint, double periods) const noexcept
{
  const std::vector<Wanted>& line = line_[joint];
  const auto whole = static_cast<std::size_t>(periods);
  const double share = periods - static_cast<double>(whole);
  const auto before = [&](std::size_t back) -> const Wanted&
  { return line[newest_ >= back ? newest_ - back : newest_ + line.size() - back]; };
  const Wanted& late = before(whole);
  const Wanted& later = before(whole + 1);
  const auto between = [&](double Wanted::*value) { return late.*value + share * (later.*value - late.*value); };
  return { between(&Wanted::position), between(&Wanted::velocity), between(&Wanted::torque) };
}

void ArmController::control(ArmTwin& twin, const std::vector<JointMotion>& set_point) noexcept
{
  take(twin, set_point);
  before_.swap(speed_);
  controlled_ = twin.stamp();
  for (std::size_t i = 0; i < twin.joints(); ++i)
  {
    Twin& drive = twin.drive(i);
    const JointGains& gain = gains_[i];
    const Wanted wanted = delayed(i, delay_[i]);
    const double ratio = nominalRatio(drive.parameters().gear);
    const EncoderReadings read = drive.encoders();
    speed_[i] = jointSpeed(read, drive);
    const double speed_error = delayed(i, speed_delay_[i]).velocity - speed_[i];
    const double angle_error = wanted.position - twin.startAngle(i) - read.output_angle;
    const double feedback = gain.speed * (speed_error + gain.position * angle_error) + integral_[i];
    const double torque = wanted.torque + std::clamp(feedback, -feedback_limit_[i], feedback_limit_[i]);
    const double limit = ratio * drive.parameters().motor.torque_limit;
    const bool is_limited = std::abs(feedback) >= feedback_limit_[i];
    const bool is_braked = drive.outputs().brake_engaged;
    limited_ += is_limited && !is_braked ? 1 : 0;
    if (!is_limited && std::abs(torque) < limit && !is_braked)
    {
      const double seen = std::copysign(std::max(std::abs(angle_error) - unseen_[i], 0.0), angle_error);
      integral_[i] += toSeconds(period_) * gain.speed / gain.integral_time * (speed_error + gain.position * seen);
    }
    drive.commandMotorTorque(twin.stamp(), std::clamp(torque, -limit, limit) / ratio);
  }
}
}  // namespace hjt
