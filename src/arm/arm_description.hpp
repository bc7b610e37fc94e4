// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "arm/joint_gains.hpp"
#include "base/range.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// One joint of an arm and the drive in it.
struct ArmJoint
{
  std::string name;                   ///< in the messages and in the URDF
  std::string short_name;             ///< of files and namespaces, a name in ROS; no other joint's
  std::vector<std::string> overlays;  ///< configuration files of its drive, later wins
  ParameterMap parameters;            ///< over the overlays
  double speed_limit{};               ///< 0: none given [rad/s]
  double torque_limit{};              ///< at the output, 0: none given [N.m]
  std::vector<double> check_up;       ///< angles of all joints where its check-up begins; empty: none [rad]
  std::optional<JointGains> gains;    ///< of its controller; none: ArmController::defaultGains
};

inline constexpr Range PAYLOAD_MASS{ 0.0, 1e4 };  ///< [kg]

/// Mass at the tip of an arm.
struct Payload
{
  double mass{};                   ///< [kg]
  std::array<double, 3> centre{};  ///< in the frame of the tip [m]
};

/// An arm as its YAML file describes it, and the URDF that the file names.
struct ArmDescription
{
  std::string origin;               ///< path of the YAML file, for error texts
  std::string urdf;                 ///< text of the description
  std::string base;                 ///< link that stands still
  std::string tip;                  ///< link that carries the payload
  std::array<double, 3> gravity{};  ///< in the frame of the base [m/s^2]
  Payload payload;
  double state_rate{ 125.0 };    ///< of the controller's states [Hz]
  std::vector<ArmJoint> joints;  ///< from the base on; at least one
};

/// @throws ParameterError naming file, line and key: unreadable, missing, unknown, mistyped or out of range.
ArmDescription readArmDescription(const std::string& path);

/// A controller's gains, SHORT_NAME.position ... of the joints that the file names. @throws ParameterError alike.
void readGains(const std::string& path, ArmDescription& arm);
}  // namespace hjt
