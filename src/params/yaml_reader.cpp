// SPDX-License-Identifier: BSD-3-Clause
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>

#include <yaml-cpp/yaml.h>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
namespace
{
using Value = decltype(ParameterValue::value);

// How PyYAML, and so rosparam, tells numbers from texts: a float has a dot, and a sign in its exponent.
const std::regex INTEGER(R"([-+]?(0|[1-9][0-9]*))");
const std::regex FLOATING(R"(([-+]?[0-9]+\.[0-9]*|\.[0-9]+)([eE][-+][0-9]+)?)");
const std::regex INFINITE(R"([-+]?\.(inf|Inf|INF))");
const std::regex NOT_A_NUMBER(R"(\.(nan|NaN|NAN))");
const std::regex TRUE_TEXT("yes|Yes|YES|true|True|TRUE|on|On|ON");
const std::regex FALSE_TEXT("no|No|NO|false|False|FALSE|off|Off|OFF");
const std::regex NO_VALUE("~|null|Null|NULL|");
// rosparam's own addition for angles.
const std::regex DEGREES(R"(deg\(([^)]*)\))");
// PyYAML reads these as numbers, though hardly the ones that were meant: octal, hexadecimal, binary, 1_000, 1:30.
const std::regex TREACHEROUS(R"([-+]?(0[0-7_]+|0b[01_]+|0x[0-9a-fA-F_]+|[0-9][0-9_]*(:[0-5]?[0-9])+(\.[0-9_]*)?)"
                             R"(|[0-9]+_[0-9_]*(\.[0-9_]*([eE][-+][0-9]+)?)?))");

[[noreturn]] void fail(const std::string& origin, const std::string& what)
{
  throw ParameterError(origin + ": " + what);
}

std::string originOf(const std::string& source, const YAML::Node& node)
{
  return source + ":" + std::to_string(node.Mark().line + 1);
}

/// The value of an unquoted text, by rosparam's rules.
Value plainValue(const std::string& text, const std::string& origin, const std::string& key)
{
  std::smatch match;
  if (std::regex_match(text, NO_VALUE))
  {
    fail(origin, key + " has no value");
  }
  if (std::regex_match(text, TREACHEROUS))
  {
    fail(origin, key + " = " + text + ": write numbers in plain decimal digits, and put texts in quotes");
  }
  if (std::regex_match(text, INTEGER))
  {
    errno = 0;
    const std::int64_t value = std::strtoll(text.c_str(), nullptr, 10);
    if (errno == ERANGE)
    {
      fail(origin, key + " = " + text + " does not fit an integer");
    }
    return value;
  }
  if (std::regex_match(text, FLOATING))
  {
    return std::strtod(text.c_str(), nullptr);
  }
  if (std::regex_match(text, INFINITE))
  {
    return text.front() == '-' ? -HUGE_VAL : HUGE_VAL;
  }
  if (std::regex_match(text, NOT_A_NUMBER))
  {
    return std::nan("");
  }
  if (std::regex_match(text, TRUE_TEXT) || std::regex_match(text, FALSE_TEXT))
  {
    return std::regex_match(text, TRUE_TEXT);
  }
  if (std::regex_match(text, match, DEGREES) && looseNumber(match[1]))
  {
    return *looseNumber(match[1]) * (M_PI / 180.0);
  }
  return text;
}

Value scalarValue(const YAML::Node& node, const std::string& origin, const std::string& key)
{
  // yaml-cpp tags a quoted text "!", a plain one "?".
  return parseScalar(node.Scalar(), node.Tag() == "!", key, origin).value;
}

Value listValue(const YAML::Node& node, const std::string& origin, const std::string& key)
{
  std::vector<double> numbers;
  for (const YAML::Node& element : node)
  {
    if (!element.IsScalar())
    {
      fail(origin, key + " must be a list of plain numbers");
    }
    const Value value = scalarValue(element, origin, key);
    if (const auto* number = std::get_if<double>(&value))
    {
      numbers.push_back(*number);
    }
    else if (const auto* whole = std::get_if<std::int64_t>(&value))
    {
      numbers.push_back(static_cast<double>(*whole));
    }
    else
    {
      const auto meant = looseNumber(element.Scalar());
      fail(origin, key + ": element '" + element.Scalar() + "' is not a number" +
                       (meant ? " to rosparam: write " + numberText(*meant) : ""));
    }
  }
  return numbers;
}

ParameterValue readValue(const YAML::Node& node, const std::string& origin, const std::string& key)
{
  if (node.IsSequence())
  {
    return { listValue(node, origin, key), origin };
  }
  if (node.IsScalar())
  {
    return { scalarValue(node, origin, key), origin };
  }
  fail(origin, key + (node.IsNull() ? " has no value" : " must be a value or a list of numbers"));
}

std::string keyText(const YAML::Node& node, const std::string& origin)
{
  if (!node.IsScalar())
  {
    fail(origin, "a key must be a plain name");
  }
  return node.Scalar();
}

void readSection(const std::string& source, const std::string& section, const YAML::Node& keys, ParameterMap& read)
{
  for (const auto& entry : keys)
  {
    const std::string origin = originOf(source, entry.first);
    const std::string key = section + "." + keyText(entry.first, origin);
    if (!read.emplace(key, readValue(entry.second, origin, key)).second)
    {
      fail(origin, key + " stands twice in this file (first at " + read.at(key).origin + ")");
    }
  }
}

/// The list of faults: FAULTS.N.key each, N from 0 on. It replaces a list read before.
void readFaults(const std::string& source, const YAML::Node& list, ParameterMap& read)
{
  int number = 0;
  for (const YAML::Node& fault : list)
  {
    const std::string name = faultKey(number++);
    if (!fault.IsMap())
    {
      fail(originOf(source, fault), name + " must be {kind: ..., severity: ..., place: ..., onset: ...}");
    }
    readSection(source, name, fault, read);
  }
}

void readDocument(const std::string& source, const YAML::Node& root, ParameterMap& map)
{
  if (!root.IsMap())
  {
    fail(source, "expected `section: {key: value}`");
  }
  ParameterMap read;
  for (const auto& entry : root)
  {
    const std::string origin = originOf(source, entry.first);
    const std::string section = keyText(entry.first, origin);
    if (section == FAULTS && entry.second.IsSequence())
    {
      eraseFaults(map);
      readFaults(source, entry.second, read);
      continue;
    }
    if (!entry.second.IsMap())
    {
      fail(origin, "'" + section + "' must be a section with keys below it");
    }
    readSection(source, section, entry.second, read);
  }
  for (auto& [key, value] : read)
  {
    map[key] = std::move(value);
  }
}
}  // namespace

std::string faultKey(int number)
{
  return std::string(FAULTS) + '.' + std::to_string(number);
}

void eraseFaults(ParameterMap& map)
{
  const std::string prefix = std::string(FAULTS) + '.';
  for (auto entry = map.lower_bound(prefix); entry != map.end() && entry->first.rfind(prefix, 0) == 0;)
  {
    entry = map.erase(entry);
  }
}

void readYamlFile(const std::string& path, ParameterMap& map)
{
  std::ifstream file(path);
  std::stringstream text;
  if (!file || !(text << file.rdbuf()))
  {
    fail(path, "cannot be read, or is empty");
  }
  std::vector<YAML::Node> documents;
  try
  {
    documents = YAML::LoadAll(text.str());
  }
  catch (const YAML::Exception& error)
  {
    fail(path + ":" + std::to_string(error.mark.line + 1), error.msg);
  }
  if (documents.size() != 1)
  {
    fail(path, "expected one YAML document, found " + std::to_string(documents.size()));
  }
  readDocument(path, documents.front(), map);
}

ParameterValue parseScalar(const std::string& text, bool quoted, const std::string& key, const std::string& origin)
{
  return { quoted ? Value(text) : plainValue(text, origin, key), origin };
}

void readAssignment(const std::string& assignment, ParameterMap& map)
{
  const std::string origin = "--set " + assignment;
  const std::size_t equals = assignment.find('=');
  const std::string key = assignment.substr(0, equals);
  if (equals == std::string::npos || !std::regex_match(key, std::regex(R"([A-Za-z0-9_]+\.[A-Za-z0-9_]+)")))
  {
    fail(origin, "expected section.key=value");
  }
  try
  {
    map[key] = readValue(YAML::Load(assignment.substr(equals + 1)), origin, key);
  }
  catch (const YAML::Exception& error)
  {
    fail(origin, error.msg);
  }
}
}  // namespace hjt
