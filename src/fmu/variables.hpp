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
/// Types of variables, with the names that FMI 3.0 uses in the description of a unit.
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

/// Value of a variable: a text, one number, or the numbers of an array.
struct Value
{
  std::vector<double> numbers{ 0.0 };
  std::string text{};
};

/// A variable of a unit, for the unit's description and calls. Its index in the list of all is the value reference.
struct FmuVariable
{
  std::string name;
  std::string unit;  ///< unit of the values; "-" for no unit
  std::string description;
  Causality causality{};
  Type type{};
  Value start{};  ///< start value of inputs and parameters
  std::optional<Range> range{};
  bool is_array{};
  bool is_discrete{};  ///< whether an input of type FLOAT64 changes at discrete times only
  bool is_clamped{};   ///< whether the twin clamps numbers out of the range of this input
};

constexpr std::size_t TIME = 0;  ///< value reference of the time in every unit

/// Value references of a drive's variables, counted from the first one: inputs, scalar outputs, outputs of the teeth,
/// places of the faults, then the parameters of the drive.
enum DriveReference : unsigned
{
  MOTOR_TORQUE,
  LOAD_TORQUE,
  TEMPERATURE,
  BRAKE,
  FIRST_FAULT,  ///< severity of the first FaultKind; the severities of the other kinds follow
  FIRST_OUTPUT = FIRST_FAULT + FAULT_KINDS
};

struct ScalarOutput
{
  const char* name;
  const char* unit;
  const char* description;
  Type type;
  double (*of)(const Twin&, const JointOutputs&);
  bool watches{};  ///< whether the output needs Twin::watchSignals, as indicators and assessment do
};
const std::vector<ScalarOutput>& scalarOutputs();

struct ToothOutput
{
  const char* name;
  const char* description;
  std::vector<double> ToothForces::*forces;
};
const std::vector<ToothOutput>& toothOutputs();

FmuVariable timeVariable();

/// Adds the variables of a drive with `prefix`. Some parameters are no variables: those for a twin beside a robot or
/// for publishing, those that would change sizes or steps, and in an arm also those that the arm determines.
void addDrive(const Parameters& parameters, const std::string& prefix, std::vector<FmuVariable>& all);

/// All variables of a unit for one drive: the time, then the variables of the drive.
std::vector<FmuVariable> driveVariables(const Parameters& parameters);

/// Value reference of the place of a kind of fault, counted from the first variable of the drive.
std::size_t placeReference(std::size_t kind);

/// Token by which a unit detects that its description, library and resources belong together. The token follows from
/// the texts of the resources and from the version of the package.
std::string instantiationToken(const std::string& text);
void requireToken(const std::string& token, const std::string& text);  ///< @throws InputError for a wrong token

/// Parameters whose value is the name of a file. The file is in the unit.
constexpr const char* FILE_PARAMETERS[]{ "indicators.signatures", "manufacture.flexspline_pitch_table",
                                         "manufacture.circular_spline_pitch_table" };
constexpr const char* PARAMETER_FILE = "parameters.yaml";  ///< file in the resources
}  // namespace hjt::fmu
