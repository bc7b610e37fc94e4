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
/// Gains of the controller of one joint. All quantities are those at the joint.
struct JointGains
{
  double position{};       ///< speed that the controller demands per error of the joint angle [1/s]
  double speed{};          ///< torque of the controller per error of the joint speed [N.m.s/rad]
  double integral_time{};  ///< integral time of the control of the joint speed [s]
  double coulomb{};        ///< constant part of the friction that the controller feeds forward [N.m]
  double viscous{};        ///< friction that the controller feeds forward, per joint speed [N.m.s/rad]
};

/// One joint of an arm and the drive in it.
struct ArmJoint
{
  std::string name;                   ///< name of the joint in messages and in the URDF
  std::string short_name;             ///< unique name of the joint in files and namespaces
  std::vector<std::string> overlays;  ///< configuration files of the drive; later files replace values of earlier ones
  ParameterMap parameters;            ///< parameters of the drive, which replace values of the overlays
  Range angles{ -100.0, 100.0 };      ///< allowed angles by the URDF; 16 turns to each side if it has no limits [rad]
  double speed_limit{};               ///< largest speed of the joint; 0: not given [rad/s]
  double torque_limit{};              ///< largest torque at the output; 0: not given [N.m]
  double feedback_limit{};            ///< largest feedback torque of the controller; 0: no limit [N.m]
  double delay{};                     ///< time from a set point until the controller acts on it [s]
  std::vector<double> check_up;  ///< angles of all joints at the start of this joint's check-up; empty: not known [rad]
  std::optional<JointGains> gains;  ///< gains of the joint's controller; none: ArmController::defaultGains
};

inline constexpr Range PAYLOAD_MASS{ 0.0, 1e4 };       ///< allowed masses of a payload [kg]
inline constexpr Range PAYLOAD_CENTRE{ -10.0, 10.0 };  ///< allowed coordinates of a payload's centre of mass [m]

/// Mass at the tip of an arm.
struct Payload
{
  double mass{};                   ///< mass of the payload [kg]
  std::array<double, 3> centre{};  ///< centre of mass of the payload in the frame of the tip [m]
};

/// Says which value of the payload is out of range. The text is empty if all values are in range.
std::string payloadErrors(const Payload& payload);

/// The way in which a joint moves the link that it carries.
enum class LinkMotion : std::uint8_t
{
  FIXED,
  TURNS,
  SLIDES
};

/// A link of an arm, and the joint that carries the link.
struct ArmLink
{
  LinkMotion motion{};
  std::array<double, 3>
      axis{};  ///< unit vector of the joint's axis in the frame of the link before; 0 for a fixed joint [-]
  std::array<double, 3> origin{};  ///< a point of the joint's axis in the frame of the link before [m]
  std::array<double, 3>
      position{};  ///< origin of the link's frame in the frame of the link before, at a joint angle of 0 [m]
  std::array<double, 9> rotation{};  ///< rotation from the link's frame to that of the link before, by rows [-]
  double mass{};                     ///< mass of the link [kg]
  std::array<double, 3> centre{};    ///< centre of mass of the link in the link's frame [m]
  std::array<double, 6> inertia{};   ///< inertia of the link about its centre of mass: xx, yy, zz, xy, xz, yz [kg.m^2]
};

/// An arm: the contents of its YAML file and of the URDF that this file names.
struct ArmDescription
{
  std::string origin;               ///< path of the YAML file, for error texts
  std::string urdf;                 ///< text of the URDF
  std::string base;                 ///< name of the link that stands still
  std::string tip;                  ///< name of the link that carries the payload
  std::array<double, 3> gravity{};  ///< acceleration of gravity in the frame of the base [m/s^2]
  Payload payload;
  double drag{};                 ///< size of the drag: a force on the tip against the tip's motion [N]
  double state_rate{ 125.0 };    ///< rate at which the arm's controller publishes its states [Hz]
  std::vector<ArmJoint> joints;  ///< joints of the arm from the base on, at least one
  std::vector<ArmLink> links;    ///< links from the base to the tip, by readLinks
};

/// Reads the file of an arm and the links of its URDF. @throws ParameterError naming file, line and key of a value that
/// is unreadable, missing, unknown, mistyped or out of range, and for the reasons of readLinks().
ArmDescription readArmDescription(const std::string& path);

/// Reads from the URDF the links of the chain from base to tip and the ranges of the joints' angles.
/// @throws ParameterError if the URDF cannot be read or has no such chain, if its joints are not those of the
/// description, if a joint moves no mass, or if masses, inertia, places or axes are not possible for a robot.
void readLinks(ArmDescription& arm);

/// Reads the gains of a controller, SHORT_NAME.position and so on, for the joints that the file names.
/// @throws ParameterError for the reasons that readArmDescription names.
void readGains(const std::string& path, ArmDescription& arm);

/// A payload and the time from which on an arm carries it.
struct PayloadFrom
{
  double time{};  ///< time from which the arm carries the payload [s]
  Payload payload;
};

/// Payloads of an arm in the order of their times. Without entries the arm carries the configured payload.
using PayloadCourse = std::vector<PayloadFrom>;

/// Text of a file of at most MAX_TEXT bytes (base/whole_file.hpp). `place`: place where another file names this file,
/// for the error text. @throws ParameterError if the file is not regular, larger, empty, or cannot be read.
std::string textOf(const std::string& path, const std::string& place = "");

/// The path of the file `name` in the folder of the file `path`. An absolute `name` stays as it is.
std::string beside(const std::string& path, const std::string& name);

/// Contents of an arm's YAML file, under keys joined by dots: "payload.mass", "joints.0.name". A list of numbers is one
/// value; the elements of any other list have keys of their own. Keys that the file does not give come from the file
/// that its key `like` names. The path of "description" is relative to the file that gives it.
/// @throws ParameterError naming file and line.
ParameterMap readArmFile(const std::string& path);
}  // namespace hjt
