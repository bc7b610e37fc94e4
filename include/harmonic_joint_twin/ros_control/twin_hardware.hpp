// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/joint_state_interface.h>
#include <hardware_interface/robot_hw.h>
#include <ros/duration.h>
#include <ros/time.h>

#include "harmonic_joint_twin/arm/arm_drives.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"

namespace hjt
{
/// One twin, or the twins of an arm, as hardware of ros_control: states and effort commands of the joints.
///
///   position  joint angle from the encoder at the output [rad]
///   velocity  joint speed: speed from the encoder at the motor / ratio [rad/s]
///   effort    torque of the motor at its shaft: as a command, and as the drive estimates it from the current [N.m]
///
/// The control loop gives the time. `read` advances the twin to its argument `time`. A command of `write` acts from the
/// argument `time` of this `write` on. The first `read`, and a `read` whose time goes back, start the twin at rest. The
/// first `write` after a start releases engaged brakes. After construction only the base class throws or allocates.
class TwinHardware : public hardware_interface::RobotHW
{
public:
  /// `twin` must outlive this object.
  TwinHardware(const std::string& joint, Twin& twin)
    : TwinHardware(
          { { joint, twin, 0.0 } }, [&twin](Stamp stamp) { return twin.reset(stamp); },
          [&twin](Stamp until) { return twin.step(until); })
  {
  }

  explicit TwinHardware(ArmDrives& arm)
    : TwinHardware(
          jointsOf(arm), [&arm](Stamp stamp) { return arm.reset(stamp); },
          [&arm](Stamp until) { return arm.step(until); })
  {
  }

  TwinHardware(const TwinHardware&) = delete;  // because the handles of ros_control point into this object
  TwinHardware& operator=(const TwinHardware&) = delete;

  void read(const ros::Time& time, const ros::Duration& /*period*/) override
  {
    const Stamp now = stampOf(time);
    if (!runs_ || now < joints_.front().twin.stamp())
    {
      runs_ = reset_(now);
      is_braked_ = true;
    }
    while (runs_ && step_(now))
    {
    }
    for (Joint& joint : joints_)
    {
      const GearParameters& gear = joint.twin.parameters().gear;
      const EncoderReadings encoders = joint.twin.encoders();
      joint.position = joint.start_angle + encoders.output_angle;
      joint.velocity = encoders.motor_velocity * (gear.teeth_circular_spline - gear.teeth_flexspline) /
                       static_cast<double>(gear.teeth_circular_spline);
      joint.effort = joint.twin.motorTorqueReading();
    }
  }

  void write(const ros::Time& time, const ros::Duration& /*period*/) override
  {
    for (Joint& joint : joints_)
    {
      joint.twin.commandMotorTorque(stampOf(time), joint.command);
      if (is_braked_)
      {
        joint.twin.commandBrake(stampOf(time), false);
      }
    }
    is_braked_ = false;
  }

private:
  struct Joint
  {
    std::string name;
    Twin& twin;
    double start_angle;  // joint angle at the start of the twin [rad]
    double position{};
    double velocity{};
    double effort{};
    double command{};
  };

  TwinHardware(std::vector<Joint> joints, std::function<bool(Stamp)> reset, std::function<bool(Stamp)> step)
    : joints_(std::move(joints)), reset_(std::move(reset)), step_(std::move(step))
  {
    for (Joint& joint : joints_)
    {
      const hardware_interface::JointStateHandle state(joint.name, &joint.position, &joint.velocity, &joint.effort);
      states_.registerHandle(state);
      efforts_.registerHandle(hardware_interface::JointHandle(state, &joint.command));
    }
    registerInterface(&states_);
    registerInterface(&efforts_);
  }

  static std::vector<Joint> jointsOf(ArmDrives& arm)
  {
    std::vector<Joint> joints;
    for (std::size_t i = 0; i < arm.joints(); ++i)
    {
      joints.push_back({ arm.names()[i], arm.drive(i), arm.startAngle(i) });
    }
    return joints;
  }

  static Stamp stampOf(const ros::Time& time) { return static_cast<Stamp>(time.toNSec()); }

  std::vector<Joint> joints_;
  std::function<bool(Stamp)> reset_;
  std::function<bool(Stamp)> step_;
  hardware_interface::JointStateInterface states_;
  hardware_interface::EffortJointInterface efforts_;
  bool runs_{};
  bool is_braked_{ true };
};
}  // namespace hjt
