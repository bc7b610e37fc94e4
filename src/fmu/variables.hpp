// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harmonic_joint_twin/twin/twin.hpp"

#include "base/range.hpp"

namespace hjt::fmu
{
/// Of FMI 3.0, by the names of its elements in the description.
enum class Type
{
  FLOAT64,
  INT32,
  BOOLEAN,
  STRING
};

enum class Causality
{
  INDEPENDENT,
  INPUT,
  OUTPUT,
  PARAMETER
};

/// A value of a variable: numbers, one where it is no array, or a text.
struct Value
{
  std::vector<double> numbers{ 0.0 };
  std::string text{};
};

/// A variable of the unit, for its description and calls; its value reference is its place in the list.
struct FmuVariable
{
  std::string name;
  std::string unit;  ///< "-": none
  std::string description;
  Causality causality{};
  Type type{};
  Value start{};  ///< of inputs and parameters
  std::optional<Range> range{};
  bool is_array{};
  bool is_discrete{};  ///< of inputs of type FLOAT64
  bool is_clamped{};   ///< of inputs: a number beyond the range is taken and clamped
};

constexpr std::size_t TIME = 0;  ///< value reference in every unit

/// The variables of a drive, counted from its first one on: inputs, scalar outputs, tooth outputs, places of the
/// faults, then the parameters that shape it.
enum DriveReference : unsigned
{
  MOTOR_TORQUE,
  LOAD_TORQUE,
  TEMPERATURE,
  BRAKE,
  FIRST_FAULT,  ///< severity, one for each FaultKind
  FIRST_OUTPUT = FIRST_FAULT + FAULT_KINDS
};

/// An output that is one number.
struct ScalarOutput
{
  const char* name;
  const char* unit;
  const char* description;
  Type type;
  double (*of)(const Twin&, const JointOutputs&);
  bool watches{};  ///< it is of indicators or assessment: Twin::watchSignals
};
const std::vector<ScalarOutput>& scalarOutputs();

/// An output with a number for each tooth.
struct ToothOutput
{
  const char* name;
  const char* description;
  std::vector<double> ToothForces::*forces;
};
const std::vector<ToothOutput>& toothOutputs();

FmuVariable timeVariable();

/// Adds those of a drive, with this prefix of their names. What the twin is beside a robot or publishes is left out,
/// and what sizes or steps would change with; within an arm also what the arm gives.
void addDrive(const Parameters& parameters, const std::string& prefix, std::vector<FmuVariable>& all);

/// All variables of a unit that is one drive: time, then the drive.
std::vector<FmuVariable> driveVariables(const Parameters& parameters);

/// Of the place of a kind of fault, counted from the drive's first variable on.
std::size_t placeReference(std::size_t kind);

/// Of the texts of the resources in this version: ties description, library and resources to each other.
std::string instantiationToken(const std::string& text);
void requireToken(const std::string& token, const std::string& text);  ///< @throws InputError if it is another

/// Parameters that name a file, which lies with the description; their values then are file names.
constexpr const char* FILE_PARAMETERS[]{ "indicators.signatures", "manufacture.flexspline_pitch_table",
                                         "manufacture.circular_spline_pitch_table" };
constexpr const char* PARAMETER_FILE = "parameters.yaml";  ///< among the resources
}  // namespace hjt::fmu
