// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "arm/arm_description.hpp"
#include "fmu/variables.hpp"

namespace hjt::fmu
{
constexpr const char* ARM_FILE = "arm.yaml";  ///< file in the resources, which also have a directory for each drive

/// Text for the resources of a unit, with what the closed loop of an arm needs: links as numbers, gravity, payload,
/// limits and gains. The joints must have gains.
std::string armResource(const ArmDescription& arm);

/// Reads a text of `armResource` from a file. @throws ParameterError.
ArmDescription readArmResource(const std::string& path);

/// Value references of an arm's variables. The time comes before them. The variables of the drives (DriveReference)
/// come after them, base first. Arrays have a value for each joint, or x, y, z, unless stated otherwise.
enum ArmReference : unsigned
{
  SET_POSITION = TIME + 1,
  SET_VELOCITY,
  SET_ACCELERATION,
  WRENCH_FORCE,
  WRENCH_MOMENT,
  PAYLOAD_MASS,
  PAYLOAD_CENTRE,
  FIRST_ARM_OUTPUT,  ///< first of seven outputs: those in ARM_QUANTITIES from the feedforward's current on
  TOOL_ORIENTATION = FIRST_ARM_OUTPUT + 7,
  TOOL_ERROR,
  PROTECTIVE_STOP,
  START_POSITION,
  CONTROLLER,
  GRAVITY,
  GAIN_POSITION,
  GAIN_SPEED,
  GAIN_INTEGRAL_TIME,
  GAIN_COULOMB,
  GAIN_VISCOUS,
  FIRST_DRIVE
};

std::string prefixOf(const ArmJoint& joint);

/// All variables of a unit for an arm. The joints of the arm must have gains.
std::vector<FmuVariable> armVariables(const ArmDescription& arm, const std::vector<Parameters>& drives);
}  // namespace hjt::fmu
