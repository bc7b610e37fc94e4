// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/ros_control/twin_hardware.hpp"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "harmonic_joint_twin/base/errors.hpp"
#include "test/core/test_parameters.hpp"

namespace hjt
{
namespace
{
const ros::Time BEGIN(1'700'000'000, 0);
const ros::Duration PERIOD(0.002);
constexpr double FREQUENCY = 3.0;  // of a joint with its motor alone [Hz]
constexpr double DAMPING = 0.7;

/// As a controller of ros_control: knows handles alone.
class PdController
{
public:
  /// `inertia`: of the motor [kg.m^2]. Gains from angles of the joint to torques of the motor.
  PdController(hardware_interface::JointHandle joint, double inertia, double ratio, double wanted)
    : joint_(std::move(joint))
    , stiffness_(inertia * ratio * std::pow(2.0 * M_PI * FREQUENCY, 2))
    , damping_(2.0 * DAMPING * inertia * ratio * 2.0 * M_PI * FREQUENCY)
    , wanted_(wanted)
  {
  }

  void update() { joint_.setCommand(stiffness_ * error() - damping_ * joint_.getVelocity()); }
  double error() const { return wanted_ - joint_.getPosition(); }
  double stiffness() const { return stiffness_; }
  const hardware_interface::JointHandle& joint() const { return joint_; }

private:
  hardware_interface::JointHandle joint_;
  double stiffness_;  // [N.m/rad]
  double damping_;    // [N.m.s/rad]
  double wanted_;     // [rad]
};

double motorInertia(const Parameters& drive)
{
  return drive.motor.rotor_inertia + drive.motor.wave_generator_inertia;
}

double ratioOf(const Parameters& drive)
{
  return static_cast<double>(drive.gear.teeth_circular_spline) /
         (drive.gear.teeth_circular_spline - drive.gear.teeth_flexspline);
}

/// The loop of a program with a controller_manager.
void run(hardware_interface::RobotHW& hardware, double duration, const std::function<void(const ros::Time&)>& update)
{
  for (ros::Time time = BEGIN; time <= BEGIN + ros::Duration(duration); time += PERIOD)
  {
    hardware.read(time, PERIOD);
    update(time);
    hardware.write(time, PERIOD);
  }
}

hardware_interface::JointHandle effortHandle(hardware_interface::RobotHW& hardware, const std::string& joint)
{
  return hardware.get<hardware_interface::EffortJointInterface>()->getHandle(joint);
}

/// What the controller commands is the motor's torque of the twin, from its time on: a twin that gets the same torques
/// with the same stamps has the same bits.
TEST(TwinHardware, AnEffortControllerTurnsAJoint)
{
  constexpr double WANTED = 0.3;         // [rad]
  constexpr double MOST_FRICTION = 0.3;  // of the drive at rest, at the motor; a UR5's is 0.1 [N.m]
  const Parameters parameters = shippedParameters({ "output.load_inertia=1.0", "brake.engaged_at_start=true" });
  Twin twin(parameters);
  TwinHardware hardware("elbow_joint", twin);
  PdController controller(effortHandle(hardware, "elbow_joint"), motorInertia(parameters), ratioOf(parameters), WANTED);
  Twin other(parameters);
  std::vector<double> efforts;
  run(hardware, 1.5,
      [&](const ros::Time& time)
      {
        const auto stamp = static_cast<Stamp>(time.toNSec());
        if (time == BEGIN)
        {
          EXPECT_EQ(controller.joint().getPosition(), 0.0);
          EXPECT_TRUE(twin.outputs().brake_engaged);
          other.reset(stamp);
        }
        while (other.step(stamp))
        {
        }
        ASSERT_EQ(controller.joint().getPosition(), other.encoders().output_angle);
        controller.update();
        efforts.push_back(controller.joint().getCommand());
        other.commandMotorTorque(stamp, efforts.back());
        if (time == BEGIN)
        {
          other.commandBrake(stamp, false);
        }
      });
  EXPECT_EQ(toSeconds(twin.stamp() - static_cast<Stamp>(BEGIN.toNSec())), 1.5);
  // What it is off, friction holds.
  EXPECT_LT(std::abs(controller.error()) * controller.stiffness(), MOST_FRICTION);
  EXPECT_LT(std::abs(controller.error()), 0.1 * WANTED);
  EXPECT_LT(std::abs(controller.joint().getVelocity()), 0.01);
  // As the drive estimates it from its current, after one period.
  EXPECT_NEAR(controller.joint().getEffort(), efforts[efforts.size() - 2], 0.02);
  const hardware_interface::JointStateHandle state =
      hardware.get<hardware_interface::JointStateInterface>()->getHandle("elbow_joint");
  EXPECT_EQ(state.getPosition(), controller.joint().getPosition());
}

TEST(TwinHardware, ATimeThatGoesBackRestartsAtRest)
{
  Twin twin(shippedParameters());
  TwinHardware hardware("elbow_joint", twin);
  hardware_interface::JointHandle joint = effortHandle(hardware, "elbow_joint");
  run(hardware, 0.1, [&](const ros::Time& /*time*/) { joint.setCommand(0.5); });
  EXPECT_GT(joint.getPosition(), 1e-3);
  hardware.read(BEGIN, PERIOD);
  EXPECT_EQ(joint.getPosition(), 0.0);
  EXPECT_EQ(twin.stamp(), static_cast<Stamp>(BEGIN.toNSec()));
}

/// All joints together, out of their brakes.
TEST(TwinHardware, EffortControllersMoveAnArm)
{
  constexpr double WAY = 0.2;  // [rad]
  ArmOptions options;
  options.config_dir = HJT_TEST_CONFIG_DIR;
  options.start = { 0.0, -1.5708, 0.0, -1.5708, 0.0, 0.0 };
  ArmDrives arm(options);
  TwinHardware hardware(arm);
  std::vector<PdController> controllers;
  for (std::size_t i = 0; i < arm.joints(); ++i)
  {
    const Parameters& drive = arm.drive(i).parameters();
    controllers.emplace_back(effortHandle(hardware, arm.names()[i]), motorInertia(drive), ratioOf(drive),
                             options.start[i] + WAY);
  }
  run(hardware, 1.5,
      [&](const ros::Time& time)
      {
        for (std::size_t i = 0; i < controllers.size(); ++i)
        {
          if (time == BEGIN)
          {
            EXPECT_NEAR(controllers[i].joint().getPosition(), options.start[i], 1e-3) << arm.names()[i];
          }
          controllers[i].update();
        }
      });
  for (const PdController& controller : controllers)
  {
    EXPECT_LT(std::abs(controller.error()), 0.25 * WAY) << controller.joint().getName();
    EXPECT_LT(std::abs(controller.joint().getVelocity()), 0.05) << controller.joint().getName();
  }
}

TEST(TwinHardware, AnArmWithOtherAnglesThanJointsIsRefused)
{
  ArmOptions options;
  options.config_dir = HJT_TEST_CONFIG_DIR;
  options.start = { 0.0, 1.0 };
  try
  {
    const ArmDrives arm(options);
    FAIL();
  }
  catch (const ParameterError& error)
  {
    EXPECT_THAT(error.what(), testing::HasSubstr("2 start angles are given for 6 joints"));
  }
}
}  // namespace
}  // namespace hjt
