// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "arm/moving_arm.hpp"
#include "test_parameters.hpp"
#include "twin_runs.hpp"

namespace hjt
{

/// One joint about `axis` with a rod of 4 kg whose centre lies 0.3 m from it; a second one, of 2 kg, at its end.
inline std::string urdf(const std::string& axis, int joints, const std::string& base_rpy = "0 0 0")
{
  std::string text =
      "<robot name='rods'><link name='world'/><link name='base'/>"
      "<joint name='stand' type='fixed'><parent link='world'/><child link='base'/><origin rpy='" +
      base_rpy + "'/></joint>";
  std::string parent = "base";
  for (int i = 0; i < joints; ++i)
  {
    const std::string number = std::to_string(i);
    text += "<joint name='joint_" + number + "' type='revolute'><parent link='" + parent + "'/><child link='rod_" +
            number + "'/><origin xyz='" + (i == 0 ? "0 0 0" : "0.5 0 0") + "'/><axis xyz='" + axis +
            "'/><limit effort='1' velocity='1' lower='-9' upper='9'/></joint><link name='rod_" + number +
            "'><inertial><origin xyz='0.3 0 0'/><mass value='" + (i == 0 ? "4" : "2") +
            "'/><inertia ixx='0.01' iyy='0.08' izz='0.08' ixy='0' ixz='0' iyz='0'/></inertial></link>";
    parent = "rod_" + number;
  }
  return text + "</robot>";
}

inline ArmDescription rods(const std::string& axis, int joints)
{
  ArmDescription arm;
  arm.origin = "rods";
  arm.urdf = urdf(axis, joints);
  arm.base = "world";
  arm.tip = "rod_" + std::to_string(joints - 1);
  arm.gravity = { 0.0, 0.0, -9.81 };
  for (int i = 0; i < joints; ++i)
  {
    ArmJoint& joint = arm.joints.emplace_back();
    joint.name = joint.short_name = "joint_" + std::to_string(i);
  }
  readLinks(arm);
  return arm;
}

inline Parameters drive(double rate = 10e3)
{
  Parameters parameters = shippedParameters();
  parameters.output.gravity_torque = 0.0;
  parameters.solver.rate = rate;
  parameters.brake.delay = 0.0;
  return parameters;
}

/// Where the two rods of a test mostly stand.
inline const std::vector<JointMotion> REST{ { 0.3, 0.0, 0.0 }, { -0.8, 0.0, 0.0 } };

/// Two rods that stand upright and fall.
inline MovingArm movingRods(const ArmMotion& motion)
{
  return { rods("0 1 0", 2), { drive(), drive() }, motion, {} };
}
}  // namespace hjt
