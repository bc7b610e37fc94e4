// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arm/arm_description.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "twin/options.hpp"

namespace hjt
{
/// Of a shipped arm with several names the one that armsLike() has, else `name`.
std::string mainName(const std::string& name, const std::filesystem::path& directory);

/// `name` if that is a file, else arms/NAME.yaml in the directory of the default configuration.
/// @throws ParameterError if there is neither.
std::string findArm(const std::string& name, const std::filesystem::path& directory);

/// Files of the arms there, by name; further names of an arm, links beside its file, are left out.
std::vector<std::filesystem::path> armFiles(const std::filesystem::path& directory);

/// The names of the joints, from the base on.
std::vector<std::string> jointNames(const ArmDescription& arm);

/// Names of the arms there whose joints have the same names. @throws ParameterError.
std::vector<std::string> armsLike(const ArmDescription& arm, const std::filesystem::path& directory);

/// The joint of this name or short name; none: the arm has none.
std::optional<std::size_t> findJoint(const ArmDescription& arm, const std::string& name);

/// Short names of the joints, for error texts.
std::string shortNames(const ArmDescription& arm);

/// The drive of a joint: default configuration, the joint's overlays and parameters, and `identified`/SHORT_NAME.yaml
/// if that directory is given. Its load is that of the arm. @throws ParameterError.
ParameterMap armJointParameters(const ArmJoint& joint, const std::filesystem::path& directory,
                                const std::string& identified);

/// The same of a drive that turns in a closed loop. A recording's currents can hold less of a rotor's inertia than the
/// rotor has, down to nothing: an identified one that is less than the configured is not taken. @throws ParameterError.
ParameterMap armDriveParameters(const ArmJoint& joint, const std::filesystem::path& directory,
                                const std::string& identified);

/// Those of all drives, solver.scene = auto where neither the joint's files nor the options say otherwise.
std::vector<ParameterMap> armDriveMaps(const ArmDescription& arm, const ConfigurationOptions& options,
                                       const std::string& identified);

/// Where `identified`, a directory or empty, holds the gains of the arm's controller, they are the joints'.
/// @throws ParameterError.
void addIdentifiedGains(const std::string& identified, ArmDescription& arm);
constexpr const char* GAINS_FILE = "controller.yaml";

/// The joints in the order of ros_control's states, which UR's driver publishes: by their names.
std::vector<std::size_t> driverOrder(const ArmDescription& arm);
std::vector<std::string> driverNames(const ArmDescription& arm);

/// Drives of an arm are of one series and none is the other: where teeth or spaces have seeded pitch deviations, each
/// joint's seeds are those configured and twice its number from the base on more; the seed of its sensors' noise is its
/// number more.
void giveOwnSeeds(std::vector<Parameters>& drives);

/// Adds faults to those of the drives, each JOINT:KIND:SEVERITY[:PLACE[:ONSET]], JOINT a joint's name or short name.
/// @throws ParameterError naming the fault.
void addArmFaults(const ArmDescription& arm, const std::vector<std::string>& faults, std::vector<Parameters>& drives);

/// The drives of all joints, with seeds of their own and these faults. @throws ParameterError.
std::vector<Parameters> armDrives(const ArmDescription& arm, const ConfigurationOptions& options,
                                  const std::string& identified, const std::vector<std::string>& faults);

/// Takes out of a checked drive, whose load is that of the links, what a controller's torque holds of the motor beside
/// it: at the joint [kg.m^2].
inline double takeInertiaInLoad(Parameters& parameters)
{
  const double ratio = nominalRatio(parameters.gear);
  return ratio * ratio * std::exchange(parameters.telemetry.inertia_in_load, 0.0);
}
}  // namespace hjt
