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
}  // namespace hjt
