// SPDX-License-Identifier: BSD-3-Clause
#include "fmu/arm_variables.hpp"

#include <utility>

#include "arm/arm_recorder.hpp"

namespace hjt::fmu
{
namespace
{
constexpr Range ANGLES{ -100.0, 100.0 };  // [rad]

std::vector<double> gainsOf(const ArmDescription& arm, double JointGains::*gain)
{
  std::vector<double> gains;
  for (const ArmJoint& joint : arm.joints)
  {
    gains.push_back((*joint.gains).*gain);
  }
  return gains;
}

void addArmInputs(const ArmDescription& arm, std::vector<FmuVariable>& all)
{
  const auto add =
      [&](const char* name, const char* unit, const char* meaning, std::vector<double> start, const Range& range)
  {
    const bool is_array = start.size() > 1;
    all.push_back({ name, unit, meaning, Causality::INPUT, Type::FLOAT64, { std::move(start) }, range, is_array });
  };
  constexpr double WRENCH = 1000.0;  // as the node's ~wrench [N], [N.m]
  const std::vector<double> zeros(arm.joints.size(), 0.0);
  add("target_q", "rad", "set points of the joints for the end of the step", zeros, ANGLES);
  add("target_qd", "rad/s", "speeds there", zeros, { -100.0, 100.0 });
  add("target_qdd", "rad/s^2", "accelerations there", zeros, { -1e6, 1e6 });
  add("wrench_force", "N", "on the tip from outside, in the frame of the base", { 0.0, 0.0, 0.0 }, { -WRENCH, WRENCH });
  add("wrench_moment", "N.m", "on the tip from outside, in the frame of the base", { 0.0, 0.0, 0.0 },
      { -WRENCH, WRENCH });
  add("payload_mass", "kg", "at the tip; the controller knows of it", { arm.payload.mass }, hjt::PAYLOAD_MASS);
  add("payload_centre", "m", "of its mass, in the frame of the tip",
      { arm.payload.centre.begin(), arm.payload.centre.end() }, { -100.0, 100.0 });
}

void addArmOutputs(std::size_t joints, std::vector<FmuVariable>& all)
{
  const auto add = [&](const char* name, const char* unit, const char* meaning, std::size_t size, Type type) {
    all.push_back({ name, unit, meaning, Causality::OUTPUT, type, { std::vector<double>(size, 0.0) }, {}, size > 1 });
  };
  for (std::size_t k = TARGET_CURRENT; k < ARM_QUANTITIES.size(); ++k)
  {
    const ArmQuantity& quantity = ARM_QUANTITIES[k];
    add(quantity.name, quantity.unit, quantity.meaning, quantity.width(joints), Type::FLOAT64);
  }
  add("tool_orientation", "-", "of the tip in the frame of the base, true: unit quaternion x, y, z, w", 4,
      Type::FLOAT64);
  add("tool_error", "m", "distance of the tool from its place by the set point", 1, Type::FLOAT64);
  add("protective_stop", "-", "0: none; else number of the joint for which the controller stopped the arm, base 1", 1,
      Type::INT32);
}

void addArmParameters(const ArmDescription& arm, std::vector<FmuVariable>& all)
{
  const auto add =
      [&](const char* name, const char* unit, const char* meaning, std::vector<double> start, const Range& range)
  {
    const bool is_array = start.size() > 1;
    all.push_back({ name, unit, meaning, Causality::PARAMETER, Type::FLOAT64, { std::move(start) }, range, is_array });
  };
  add("start_q", "rad", "where the arm stands at the start", std::vector<double>(arm.joints.size(), 0.0), ANGLES);
  all.push_back({ "controller.on",
                  "-",
                  "follows the set points; false: motor_torque of the joints goes to the motors",
                  Causality::PARAMETER,
                  Type::BOOLEAN,
                  { { 1.0 } } });
  add("gravity", "m/s^2", "in the frame of the base", { arm.gravity.begin(), arm.gravity.end() }, { -100.0, 100.0 });
  add("controller.position", "1/s", "speed wanted for an error of the angle", gainsOf(arm, &JointGains::position),
      { 0.0, 1e3 });
  add("controller.speed", "N.m.s/rad", "torque for an error of the speed", gainsOf(arm, &JointGains::speed),
      { 0.0, 1e6 });
  add("controller.integral_time", "s", "of the speed's control", gainsOf(arm, &JointGains::integral_time),
      { 1e-3, 1e6 });
  add("controller.coulomb", "N.m", "friction that is fed forward, constant", gainsOf(arm, &JointGains::coulomb),
      { -1e4, 1e4 });
  add("controller.viscous", "N.m.s/rad", "and by speed", gainsOf(arm, &JointGains::viscous), { -1e4, 1e4 });
}
}  // namespace

std::string prefixOf(const ArmJoint& joint)
{
  return joint.short_name + '.';
}

std::vector<FmuVariable> armVariables(const ArmDescription& arm, const std::vector<Parameters>& drives)
{
  std::vector<FmuVariable> all{ timeVariable() };
  addArmInputs(arm, all);
  addArmOutputs(arm.joints.size(), all);
  addArmParameters(arm, all);
  for (std::size_t i = 0; i < drives.size(); ++i)
  {
    addDrive(drives[i], prefixOf(arm.joints[i]), all);
  }
  return all;
}
}  // namespace hjt::fmu
