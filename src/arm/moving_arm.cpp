// SPDX-License-Identifier: BSD-3-Clause
#include "arm/moving_arm.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gear/ratio.hpp"

namespace hjt
{
namespace
{
std::vector<double> anglesOf(const ArmSetPoint& point)
{
  std::vector<double> angles;
  for (const JointMotion& joint : point.joints)
  {
    angles.push_back(joint.position);
  }
  return angles;
}

std::vector<JointGains> gainsOf(const ArmDescription& arm, const std::vector<Parameters>& drives)
{
  std::vector<JointGains> gains;
  for (std::size_t i = 0; i < drives.size(); ++i)
  {
    gains.push_back(arm.joints[i].gains.value_or(ArmController::defaultGains(drives[i])));
  }
  return gains;
}

/// The drives' parameters. Adds `settling` [s] to onsets of faults, so that onsets count from the start of the motion.
std::vector<Parameters> withFaultsInMotion(std::vector<Parameters> drives, double settling)
{
  constexpr double LATEST_ONSET = 1e9;  // largest onset that a drive accepts [s]
  for (Parameters& drive : drives)
  {
    for (Fault& fault : drive.faults)
    {
      fault.onset = fault.onset > 0.0 ? std::min(fault.onset + settling, LATEST_ONSET) : fault.onset;
    }
  }
  return drives;
}
}  // namespace

MovingArm::MovingArm(const ArmDescription& arm, const std::vector<Parameters>& drives, ArmMotion motion,
                     const SurfaceSource& surface_source, double settling)
  : settling_(settling)
  , lead_in_(fromRest(motion.points().front()))
  , twin_(arm, withFaultsInMotion(drives, settling + leadIn()), anglesOf(lead_in_.points().front()), surface_source)
  , controller_(arm, twin_, gainsOf(arm, drives), CONTROL_RATE)
  , motion_(std::move(motion))
  , motion_start_(motion_.begin())
  , commanded_(motion_)
  , set_point_(drives.size())
{
  for (const ArmJoint& joint : arm.joints)
  {
    fastest_.push_back(joint.speed_limit > 0.0 ? STOP_SPEED * joint.speed_limit : HUGE_VAL);
  }
  reset(0);
}

bool MovingArm::reset(Stamp stamp) noexcept
{
  if (!twin_.reset(stamp))
  {
    return false;
  }
  controller_.reset();
  is_commanded_ = false;
  is_held_ = false;
  stop_.reset();
  motion_begin_ = twin_.stamp() + toStampLength(settling_ + leadIn());
  for (std::size_t i = 0; i < twin_.joints(); ++i)
  {
    twin_.drive(i).commandBrake(twin_.stamp() + toStampLength(0.5 * settling_), false);
  }
  control();
  return true;
}

bool MovingArm::step(Stamp until) noexcept
{
  if (!twin_.step(until))
  {
    return false;
  }
  control();
  return true;
}

/// If a period of the controller begins at the present instant, commands the torques from this instant on.
void MovingArm::control() noexcept
{
  if (!controller_.isDue(twin_))
  {
    return;
  }
  if (!stop_)
  {
    wantedAt(twin_.stamp(), set_point_);
    watch();
  }
  if (!stop_)
  {
    controller_.control(twin_, set_point_);
    return;
  }
  for (std::size_t i = 0; i < twin_.joints(); ++i)
  {
    twin_.drive(i).commandMotorTorque(twin_.stamp(), 0.0);
  }
}

/// Makes a protective stop if a joint is beyond STOP_DEVIATION or STOP_SPEED.
void MovingArm::watch() noexcept
{
  for (std::size_t i = 0; i < twin_.joints() && !stop_; ++i)
  {
    const JointMotion& joint = twin_.motion()[i];
    // The negated comparisons are true for NaN, so NaN stops the arm.
    if (!(std::abs(joint.position - set_point_[i].position) <= STOP_DEVIATION))
    {
      stop_ = { twin_.stamp(), i, "off its set point" };
    }
    else if (!(std::abs(joint.velocity) <= fastest_[i]))
    {
      stop_ = { twin_.stamp(), i, "faster than its limit" };
    }
  }
  for (std::size_t i = 0; i < twin_.joints() && stop_; ++i)
  {
    const Stamp now = twin_.stamp();
    const Stamp release = motion_begin_ - toStampLength(0.5 * settling_ + leadIn());
    twin_.drive(i).commandBrake(now, true);
    if (release > now)
    {
      twin_.drive(i).commandBrake(release, true);  // engages the brake again after the release, which is queued already
    }
  }
}

bool MovingArm::unlock() noexcept
{
  const std::vector<JointMotion>& joints = twin_.motion();
  // The comparison is false for NaN, so NaN counts as motion.
  const bool is_still = std::all_of(joints.begin(), joints.end(),
                                    [](const JointMotion& joint) { return std::abs(joint.velocity) <= STILL; });
  if (!stop_ || !is_still)
  {
    return !stop_;
  }
  stop_.reset();
  controller_.reset();
  is_held_ = true;
  for (std::size_t i = 0; i < joints.size(); ++i)
  {
    set_point_[i] = { joints[i].position, 0.0, 0.0 };
    twin_.drive(i).commandBrake(twin_.stamp(), false);
  }
  control();
  return true;
}

void MovingArm::follow(ArmMotion& motion) noexcept
{
  wanted(set_point_);
  motion.beginFrom(set_point_);
  std::swap(commanded_, motion);
  is_commanded_ = true;
  is_held_ = false;
  command_begin_ = std::max(twin_.stamp(), motion_begin_);  // the motion waits until the brakes are released
}

void MovingArm::setPayload(const Payload& payload) noexcept
{
  twin_.setPayload(payload);
  controller_.setPayload(payload);
}

void MovingArm::wantedAt(Stamp stamp, std::vector<JointMotion>& motion) noexcept
{
  if (stop_ || is_held_)
  {
    for (std::size_t i = 0; i < motion.size(); ++i)
    {
      motion[i] = { set_point_[i].position, 0.0, 0.0 };
    }
    return;
  }
  if (is_commanded_)
  {
    commanded_.at(commanded_.begin() + toSeconds(stamp - command_begin_), motion);
    return;
  }
  const double time = motion_start_ + toSeconds(stamp - motion_begin_);
  (time < motion_start_ ? lead_in_ : motion_).at(time, motion);
}

JointReading MovingArm::reading(std::size_t joint) const noexcept
{
  const Twin& drive = twin_.drive(joint);
  const double ratio = nominalRatio(drive.parameters().gear);
  const TelemetryParameters& telemetry = drive.parameters().telemetry;
  const EncoderReadings read = drive.encoders();
  return { twin_.startAngle(joint) + read.output_angle, controller_.speed(twin_, joint),
           ratio * drive.motorTorqueReading() / telemetry.torque_per_current + telemetry.current_offset };
}
}  // namespace hjt
