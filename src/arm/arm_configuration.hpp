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
/// Returns the main name of a shipped arm that has several names: the name that armsLike() returns. Keeps other names.
std::string mainName(const std::string& name, const std::filesystem::path& directory);

/// Returns the file of an arm: `name` itself if it is a file, otherwise arms/NAME.yaml in the directory of the default
/// configuration.
/// @throws ParameterError if neither file exists.
std::string findArm(const std::string& name, const std::filesystem::path& directory);

/// Files of the arms in a directory of configurations, sorted by name. The list does not contain links in the same
/// directory to an arm's file, because a link is a further name of this arm.
std::vector<std::filesystem::path> armFiles(const std::filesystem::path& directory);

/// Names of the arm's joints in messages, from the base on.
std::vector<std::string> jointNames(const ArmDescription& arm);

/// Names of the arms in `directory` whose joints have the same names as the joints of `arm`. @throws ParameterError.
std::vector<std::string> armsLike(const ArmDescription& arm, const std::filesystem::path& directory);

/// Number of the joint that has this name or short name; none if the arm has no such joint.
std::optional<std::size_t> findJoint(const ArmDescription& arm, const std::string& name);

std::string shortNames(const ArmDescription& arm);  ///< short names of the joints, as a list for error texts

/// Parameters of the drive of a joint. The joint's overlays, then the joint's parameters, replace values of the default
/// configuration. If `identified` is not empty, the file SHORT_NAME.yaml in this directory replaces values last.
/// telemetry.load is `arm`. @throws ParameterError.
ParameterMap armJointParameters(const ArmJoint& joint, const std::filesystem::path& directory,
                                const std::string& identified);

/// As armJointParameters(), but for a drive that a controller moves. Ignores an identified inertia of the rotor below
/// the configured inertia, because the currents of a recording can show too small an inertia. @throws ParameterError.
ParameterMap armDriveParameters(const ArmJoint& joint, const std::filesystem::path& directory,
                                const std::string& identified);

/// Parameters of the drive of each joint. Sets solver.scene to `auto` unless the joint's files or `options` set it.
std::vector<ParameterMap> armDriveMaps(const ArmDescription& arm, const ConfigurationOptions& options,
                                       const std::string& identified);

/// Gives the joints the controller gains from the file GAINS_FILE in the directory `identified`. Changes nothing if
/// this file does not exist or `identified` is empty. @throws ParameterError.
void addIdentifiedGains(const std::string& identified, ArmDescription& arm);
constexpr const char* GAINS_FILE = "controller.yaml";

/// Numbers of the joints in alphabetical order of their names, as UR's driver publishes them.
std::vector<std::size_t> driverOrder(const ArmDescription& arm);
std::vector<std::string> driverNames(const ArmDescription& arm);

/// Gives each drive of an arm its own seeds, so that no two drives have the same gear or noise. Adds the joint's number
/// from the base on to the seed of the sensor noise, and twice this number to the seeds of the pitch deviations.
void giveOwnSeeds(std::vector<Parameters>& drives);

/// Adds faults to the drives. A fault is written JOINT:KIND:SEVERITY[:PLACE[:ONSET]], where JOINT is the name or the
/// short name of a joint. @throws ParameterError naming the fault.
void addArmFaults(const ArmDescription& arm, const std::vector<std::string>& faults, std::vector<Parameters>& drives);

/// Parameters of the drive of each joint, with the seeds of giveOwnSeeds() and with `faults`. @throws ParameterError.
std::vector<Parameters> armDrives(const ArmDescription& arm, const ConfigurationOptions& options,
                                  const std::string& identified, const std::vector<std::string>& faults);

/// Sets telemetry.inertia_in_load of a drive to 0, because a load that is computed from the links contains no inertia
/// of the motor. Returns the inertia that was set before, at the joint [kg.m^2].
inline double takeInertiaInLoad(Parameters& parameters)
{
  const double ratio = nominalRatio(parameters.gear);
  return ratio * ratio * std::exchange(parameters.telemetry.inertia_in_load, 0.0);
}
}  // namespace hjt
