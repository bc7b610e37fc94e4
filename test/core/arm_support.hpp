// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl_parser/kdl_parser.hpp>

#include "arm/arm_configuration.hpp"
#include "arm/arm_dynamics.hpp"
#include "arm/arm_load.hpp"
#include "arm/load_fit.hpp"
#include "base/csv_table.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "statics/gear_rules.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
using Angles = std::array<double, 6>;

constexpr std::size_t ELBOW = 2;  // its place among the joints

inline ArmDescription shipped(const std::string& name)
{
  return readArmDescription(HJT_TEST_CONFIG_DIR "/arms/" + name + ".yaml");
}

inline std::vector<JointMotion> motionOf(const Angles& position, const Angles& velocity = {},
                                         const Angles& acceleration = {})
{
  std::vector<JointMotion> motion(position.size());
  for (std::size_t i = 0; i < motion.size(); ++i)
  {
    motion[i] = { position[i], velocity[i], acceleration[i] };
  }
  return motion;
}

inline std::vector<double> torquesOf(ArmDynamics& dynamics, const std::vector<JointMotion>& motion)
{
  std::vector<double> torques(motion.size());
  dynamics.torques(motion, torques);
  return torques;
}

constexpr Angles BENT{ 0.1, -1.2, 0.7, -0.5, 0.9, 0.4 };

/// Each joint to and fro about BENT at a rate of its own.
inline std::vector<JointMotion> swingAt(double time)
{
  std::vector<JointMotion> motion(BENT.size());
  for (std::size_t i = 0; i < motion.size(); ++i)
  {
    const double rate = 0.9 + 0.13 * static_cast<double>(i);
    motion[i] = { BENT[i] + 0.8 * std::sin(rate * time), 0.8 * rate * std::cos(rate * time),
                  -0.8 * rate * rate * std::sin(rate * time) };
  }
  return motion;
}

inline MotionSample sampleOf(const JointMotion& motion, double time)
{
  MotionSample sample;
  sample.time = time;
  sample.position = motion.position;
  sample.velocity = motion.velocity;
  sample.acceleration = motion.acceleration;
  return sample;
}

/// Of the drives of an arm.
inline std::vector<Parameters> drives(const ArmDescription& arm)
{
  std::vector<Parameters> joints;
  for (const ArmJoint& joint : arm.joints)
  {
    takeInertiaInLoad(joints.emplace_back(parseParameters(armJointParameters(joint, HJT_TEST_CONFIG_DIR, ""))));
  }
  return joints;
}

/// All that is ready of a stream of rows.
template <class Visit>
void popAll(ArmLoad& load, const Visit& visit, bool at_end = false)
{
  while (const ArmSample* sample = load.pop(at_end))
  {
    visit(*sample);
  }
}
}  // namespace hjt
