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
/// One configured value and its origin for error texts, for example "config/gear.yaml:12" or "--set".
struct ParameterValue
{
  std::variant<bool, std::int64_t, double, std::string, std::vector<double>> value;
  std::string origin;  ///< file and line, option, or "parameter server"
};

/// Flat map from `section.key` to value: common form of YAML files, `--set` and the ROS parameter server.
using ParameterMap = std::map<std::string, ParameterValue>;

/// Top-level key of the list of faults. The map holds `faults.N.kind`, `faults.N.severity` and so on, N from 0.
constexpr const char* FAULTS = "faults";
std::string faultKey(int number);     ///< key of fault N: `faults.N`
void eraseFaults(ParameterMap& map);  ///< removes all faults; a new list of faults replaces the old list as a whole

/// Reads a YAML file of the form `section: {key: value}`, with the list `faults`. Its values replace those in `map`.
/// Numbers may have any decimal spelling, 1e-3 as well as 1.0e-3.
/// @throws ParameterError that names file and line.
void readYamlFile(const std::string& path, ParameterMap& map);

/// Reads the default configuration: the files that `directory`/stages lists, in that order, as readYamlFile does.
/// @throws ParameterError that names file and line.
void readDefaultConfiguration(const std::string& directory, ParameterMap& map);

/// Value of one YAML scalar by the rules of rosparam; a `quoted` scalar is always a text. The error text contains
/// `key` and `origin`. @throws ParameterError.
ParameterValue parseScalar(const std::string& text, bool quoted, const std::string& key, const std::string& origin);

/// The number in `value`, also if a text spells it: the parameter server holds 1e-3 as a text. Nothing if it is no
/// number.
std::optional<double> numberOf(const decltype(ParameterValue::value)& value);

/// The value as error texts print it.
std::string valueText(const ParameterValue& value);

/// Reads one `section.key=value`, its value in YAML, into `map`. @throws ParameterError.
void readAssignment(const std::string& assignment, ParameterMap& map);

/// Converts a complete map to checked parameters.
/// @throws ParameterError if a key is missing, unknown, mistyped or out of range, or if two keys contradict each other.
Parameters parseParameters(const ParameterMap& map);

/// Changes the parameters that the map names, adds its faults, and checks all parameters. @throws ParameterError.
void changeParameters(Parameters& parameters, const ParameterMap& changes);

/// Hash of all values (FNV-1a, 64 bits).
std::uint64_t parametersHash(const Parameters& parameters);

/// Text of all parameters, one per line: `section.key: value  # [unit] meaning`.
std::string describeParameters(const Parameters& parameters);

/// Reads a text of describeParameters into `map`; its faults replace those of `map`. Error texts name `source`.
/// @throws ParameterError that names source and line.
void readDescription(const std::string& text, const std::string& source, ParameterMap& map);

/// The table of docs/parameters.md with key, unit, range and meaning.
std::string parameterTableMarkdown();
}  // namespace hjt
