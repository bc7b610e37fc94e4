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
/// Configured value with its origin for error messages, for example "config/gear.yaml:12" or "--set".
struct ParameterValue
{
  std::variant<bool, std::int64_t, double, std::string, std::vector<double>> value;
  std::string origin;  ///< file and line, option, or "parameter server"
};

/// Map from `section.key` to value, the common form for YAML files, `--set` and the ROS parameter server.
using ParameterMap = std::map<std::string, ParameterValue>;

/// Top-level key of the list of faults. A ParameterMap has `faults.N.kind`, `faults.N.severity` ..., with N from 0.
constexpr const char* FAULTS = "faults";
std::string faultKey(int number);     ///< key of fault N: `faults.N`
void eraseFaults(ParameterMap& map);  ///< removes all faults, because a new list of faults replaces the old list

/// Reads a YAML file of the form `section: {key: value}`, with the list `faults`. The values replace those in `map`.
/// Numbers may have any decimal spelling, for example 1e-3 or 1.0e-3.
/// @throws ParameterError that names file and line.
void readYamlFile(const std::string& path, ParameterMap& map);

/// Reads the default configuration: calls readYamlFile for the files that `directory`/stages lists, in the order of the
/// list.
/// @throws ParameterError that names file and line.
void readDefaultConfiguration(const std::string& directory, ParameterMap& map);

/// Value of a YAML scalar by the rules of rosparam. A `quoted` scalar is always a text. The error message contains
/// `key` and `origin`. @throws ParameterError.
ParameterValue parseScalar(const std::string& text, bool quoted, const std::string& key, const std::string& origin);

/// Number in `value`; nothing if `value` is no number. A text like 1e-3, as the parameter server holds it, is a number.
std::optional<double> numberOf(const decltype(ParameterValue::value)& value);

/// Text of a parameter's value for error messages.
std::string valueText(const ParameterValue& value);

/// Reads the text `section.key=value`, whose value is YAML, into `map`. @throws ParameterError.
void readAssignment(const std::string& assignment, ParameterMap& map);

/// Converts a complete map to checked parameters.
/// @throws ParameterError if a key is missing, unknown, mistyped or out of range, or if two keys contradict each other.
Parameters parseParameters(const ParameterMap& map);

/// Applies the values of `changes`, adds the faults of `changes`, checks all parameters. @throws ParameterError.
void changeParameters(Parameters& parameters, const ParameterMap& changes);

/// Hash of all values (FNV-1a, 64 bits).
std::uint64_t parametersHash(const Parameters& parameters);

/// Text of all parameters, one per line: `section.key: value  # [unit] meaning`.
std::string describeParameters(const Parameters& parameters);

/// Reads a text of describeParameters into `map`. The faults in the text replace those of `map`. @throws ParameterError
/// that names `source` and line.
void readDescription(const std::string& text, const std::string& source, ParameterMap& map);

/// Table of docs/parameters.csv in Markdown, with key, type, unit, range and meaning of each parameter.
std::string parameterTableMarkdown();
}  // namespace hjt
