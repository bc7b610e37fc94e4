// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/range.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// Control of one joint, all seen from the joint.
struct JointGains
{
  double position{};       ///< speed wanted for an error of the angle [1/s]
  double speed{};          ///< torque for an error of the speed [N.m.s/rad]
  double integral_time{};  ///< of the speed control [s]
  double coulomb{};        ///< friction that is fed forward: constant [N.m]
  double viscous{};        ///< and by speed [N.m.s/rad]
};

/// One joint of an arm and the drive in it.
struct ArmJoint
{
  std::string name;                   ///< in the messages and in the URDF
  std::string short_name;             ///< of files and namespaces, a name in ROS; no other joint's
  std::vector<std::string> overlays;  ///< configuration files of its drive, later wins
  ParameterMap parameters;            ///< over the overlays
  Range angles{ -100.0, 100.0 };      ///< of the URDF; without limits 16 turns either way [rad]
  double speed_limit{};               ///< 0: none given [rad/s]
  double torque_limit{};              ///< at the output, 0: none given [N.m]
  double feedback_limit{};            ///< of its controller's torque beyond what is fed forward, 0: none [N.m]
  double delay{};                     ///< of a set point until its controller acts on it [s]
  std::vector<double> check_up;       ///< angles of all joints where its check-up begins; empty: none [rad]
  std::optional<JointGains> gains;    ///< of its controller; none: ArmController::defaultGains
};

inline constexpr Range PAYLOAD_MASS{ 0.0, 1e4 };       ///< [kg]
inline constexpr Range PAYLOAD_CENTRE{ -10.0, 10.0 };  ///< each of its coordinates [m]

/// Mass at the tip of an arm.
struct Payload
{
  double mass{};                   ///< [kg]
  std::array<double, 3> centre{};  ///< in the frame of the tip [m]
};

/// Values out of range; empty: none.
std::string payloadErrors(const Payload& payload);

/// How a joint moves the link that it carries.
enum class LinkMotion : std::uint8_t
{
  FIXED,
  TURNS,
  SLIDES
};

/// A link of an arm and the joint that carries it, as numbers.
struct ArmLink
{
  LinkMotion motion{};
  std::array<double, 3> axis{};      ///< of the joint, in the frame of the link before, of length 1; fixed: none [-]
  std::array<double, 3> origin{};    ///< of the joint, in the frame of the link before [m]
  std::array<double, 3> position{};  ///< of the link's frame in that of the link before, at an angle of 0 [m]
  std::array<double, 9> rotation{};  ///< likewise, by rows [-]
  double mass{};                     ///< [kg]
  std::array<double, 3> centre{};    ///< of its mass, in its frame [m]
  std::array<double, 6> inertia{};   ///< about its centre: xx, yy, zz, xy, xz, yz [kg.m^2]
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
  double drag{};                 ///< of a force on the tip against its motion [N]
  double state_rate{ 125.0 };    ///< of the controller's states [Hz]
  std::vector<ArmJoint> joints;  ///< from the base on; at least one
  std::vector<ArmLink> links;    ///< from the base on to the tip, as readLinks finds them
};

/// With its links. @throws ParameterError naming file, line and key: unreadable, missing, unknown, mistyped or out of
/// range; and as readLinks.
ArmDescription readArmDescription(const std::string& path);

/// The links of the URDF's chain from base to tip, and the ranges of the joints' angles. @throws ParameterError if any
/// of it cannot be read, it has no such chain, other joints than the description names, a joint that moves no mass, or
/// masses, inertia, places or axes that no robot has.
void readLinks(ArmDescription& arm);

/// A controller's gains, SHORT_NAME.position ... of the joints that the file names. @throws ParameterError alike.
void readGains(const std::string& path, ArmDescription& arm);

/// From a time on that payload is carried.
struct PayloadFrom
{
  double time{};  ///< [s]
  Payload payload;
};

/// Payloads of an arm in order of time; empty: the configured one.
using PayloadCourse = std::vector<PayloadFrom>;

/// The text of a file of at most MAX_TEXT bytes (base/whole_file.hpp). `place`: where it is named, for the error text.
/// @throws ParameterError if it is no regular file, larger, empty, or cannot be read.
std::string textOf(const std::string& path, const std::string& place = "");

/// `name` in the folder of the file `path`; `name` if it is absolute.
std::string beside(const std::string& path, const std::string& name);

/// Contents of an arm's YAML file, under keys joined by dots: "payload.mass", "joints.0.name". A list of numbers is one
/// value; elements of another have keys of their own. Keys that the file does not give are those of the file that it is
/// `like`, and so on; "description" is beside the file that gives it.
/// @throws ParameterError naming file and line.
ParameterMap readArmFile(const std::string& path);
}  // namespace hjt
