// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// One configured value and where it came from, for the error text ("config/gear.yaml:12", "--set", "parameter
/// server").
struct ParameterValue
{
  std::variant<bool, std::int64_t, double, std::string, std::vector<double>> value;
  std::string origin;  ///< file and line, option or server
};

/// Flat `section.key` to value; the common form of a YAML file, `--set` and the ROS parameter server.
using ParameterMap = std::map<std::string, ParameterValue>;

/// Top-level key of the list of faults. In the map they are `faults.N.kind`, `faults.N.severity` ..., N from 0 on.
constexpr const char* FAULTS = "faults";
std::string faultKey(int number);     ///< `faults.N`
void eraseFaults(ParameterMap& map);  ///< a list of faults replaces the one before it as a whole

/// Reads a YAML file of the form `section: {key: value}`, and the list `faults`, over `map`; later files win.
/// Numbers in any decimal spelling, 1e-3 as well as 1.0e-3.
/// @throws ParameterError naming file and line.
void readYamlFile(const std::string& path, ParameterMap& map);

/// Reads the default configuration over `map`: the files that `directory`/stages lists, in that order.
/// @throws ParameterError naming file and line.
void readDefaultConfiguration(const std::string& directory, ParameterMap& map);

/// The value of one scalar of a YAML file, by rosparam's rules; a quoted one is a text whatever it looks like. `key`
/// and `origin` are for the error text. @throws ParameterError.
ParameterValue parseScalar(const std::string& text, bool quoted, const std::string& key, const std::string& origin);

/// The number that a value is, or that a text spells: on the parameter server 1e-3 is a text. Nothing if it is none.
std::optional<double> numberOf(const decltype(ParameterValue::value)& value);

/// The value as error texts spell it.
std::string valueText(const ParameterValue& value);

/// Reads one `section.key=value` (value in YAML) over `map`. @throws ParameterError.
void readAssignment(const std::string& assignment, ParameterMap& map);

/// Fills and checks the parameters.
/// @throws ParameterError on a missing, unknown, mistyped or out-of-range key, and where two keys contradict each
/// other.
Parameters parseParameters(const ParameterMap& map);

/// Fills the fields that the map names, adds its faults, and checks all: for many sets of parameters that differ in a
/// few. @throws ParameterError.
void changeParameters(Parameters& parameters, const ParameterMap& changes);

/// Hash of all values (FNV-1a, 64 bits).
std::uint64_t parametersHash(const Parameters& parameters);

/// All keys, values and units, one a line, as `section.key: value  # [unit] meaning`.
std::string describeParameters(const Parameters& parameters);

/// Reads such a text over `map`; its faults replace those of `map`. `source`: whose, for the error text.
/// @throws ParameterError naming source and line.
void readDescription(const std::string& text, const std::string& source, ParameterMap& map);

/// The table of docs/parameters.md: key, unit, range, meaning.
std::string parameterTableMarkdown();
}  // namespace hjt
