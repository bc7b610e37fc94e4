// SPDX-License-Identifier: BSD-3-Clause
#include "params/configuration_files.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <initializer_list>
#include <optional>
#include <regex>
#include <variant>

#include <dlfcn.h>

#include <yaml-cpp/yaml.h>

#include "base/number_text.hpp"
#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "params/field_reader.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

/// Name of the file that lists the files of the default configuration, in the directory of this configuration.
constexpr const char* STAGES = "stages";

fs::path findDirectory(const std::string& given)
{
  if (!given.empty())
  {
    return given;
  }
  if (const char* from_environment = std::getenv("HJT_CONFIG_DIR"))
  {
    return from_environment;
  }
  return packageDirectory() / "config";
}
}  // namespace

fs::path libraryDirectory()
{
  static const int HERE = 0;
  Dl_info library{};
  return dladdr(&HERE, &library) != 0 ? fs::absolute(library.dli_fname).parent_path() : "";
}

fs::path packageDirectory()
{
  // The executable PREFIX/lib/harmonic_joint_twin/joint_twin and the library PREFIX/lib/libharmonic_joint_twin_core.so
  // belong to PREFIX/share/harmonic_joint_twin, whose `config` is a link in a development space.
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  const fs::path libraries = libraryDirectory();
  for (const fs::path& beside : { executable.parent_path() / "../..", libraries / ".." })
  {
    const fs::path config = fs::canonical(beside / "share/harmonic_joint_twin/config", error);
    if (!error && fs::exists(config / STAGES))
    {
      return config.parent_path();
    }
  }
  throw ParameterError("no default configuration found, because neither " + executable.string() + " nor " +
                       libraries.string() +
                       " is in an installation or development space of harmonic_joint_twin. Give the directory of the "
                       "configuration with --config-dir or HJT_CONFIG_DIR");
}

fs::path configurationDirectory(const std::string& given)
{
  fs::path directory = findDirectory(given);
  if (!fs::exists(directory / STAGES))
  {
    throw ParameterError("no default configuration in '" + directory.string() +
                         "'. Give the directory of the configuration with --config-dir or HJT_CONFIG_DIR");
  }
  return fs::absolute(directory);
}

std::string findConfiguration(const std::string& name, const fs::path& directory)
{
  for (const fs::path& candidate : { fs::path(name), directory.parent_path() / name, directory / name })
  {
    if (fs::exists(candidate))
    {
      return candidate.string();
    }
  }
  return name;
}

void putOver(const ParameterMap& values, ParameterMap& map)
{
  for (const auto& [key, value] : values)
  {
    map[key] = value;
  }
}

void findNamedFiles(const fs::path& directory, ParameterMap& map)
{
  const auto found = map.find("indicators.signatures");
  std::string* name = found == map.end() ? nullptr : std::get_if<std::string>(&found->second.value);
  if (name != nullptr && *name != NO_FILE)
  {
    *name = findConfiguration(*name, directory);
  }
}

namespace
{
using Value = decltype(ParameterValue::value);

/// Whether PyYAML reads the text as a number that a user hardly meant, for example 017, 0x11, 0b11, 1_000 or 1:30.
bool isTreacherous(const std::string& text)
{
  static const std::regex NUMBER(R"([-+]?(0[0-7_]+|0b[01_]+|0x[0-9a-fA-F_]+|[0-9][0-9_]*(:[0-5]?[0-9])+(\.[0-9_]*)?)"
                                 R"(|[0-9]+_[0-9_]*(\.[0-9_]*([eE][-+][0-9]+)?)?))");
  return std::regex_match(text, NUMBER);
}

bool isOneOf(const std::string& text, std::initializer_list<const char*> spellings)
{
  return std::find(spellings.begin(), spellings.end(), text) != spellings.end();
}

/// Number in "deg(...)", rosparam's notation for an angle in degrees.
std::optional<double> degrees(const std::string& text)
{
  const std::string begin = "deg(";
  return text.rfind(begin, 0) == 0 && text.back() == ')' ?
             decimalNumber(text.substr(begin.size(), text.size() - begin.size() - 1)) :
             std::nullopt;
}

[[noreturn]] void fail(const std::string& origin, const std::string& what)
{
  throw ParameterError(origin + ": " + what);
}

std::string originOf(const std::string& source, const YAML::Node& node)
{
  return source + ":" + std::to_string(node.Mark().line + 1);
}

/// Value of an unquoted text by the rules of rosparam, but 1e-6 is a number here and a text in rosparam.
Value plainValue(const std::string& text, const std::string& origin, const std::string& key)
{
  if (isOneOf(text, { "", "~", "null", "Null", "NULL" }))
  {
    fail(origin, key + " has no value");
  }
  if (isTreacherous(text))
  {
    fail(origin, key + " = " + text + ": write a number in plain decimal digits, or put a text in quotes");
  }
  if (const auto number = decimalNumber(text))
  {
    if (text.find_first_of(".eE") != std::string::npos)
    {
      return *number;
    }
    errno = 0;
    const std::int64_t value = std::strtoll(text.c_str(), nullptr, 10);
    if (errno == ERANGE)
    {
      fail(origin, key + " = " + text + " is too large for a whole number");
    }
    return value;
  }
  if (const auto number = nonFiniteNumber(text))
  {
    return *number;
  }
  const bool is_true = isOneOf(text, { "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON" });
  if (is_true || isOneOf(text, { "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF" }))
  {
    return is_true;
  }
  if (const auto angle = degrees(text))
  {
    return *angle * (M_PI / 180.0);
  }
  return text;
}

Value scalarValue(const YAML::Node& node, const std::string& origin, const std::string& key)
{
  // In yaml-cpp a quoted text has the tag "!", and a plain text the tag "?".
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
    const std::optional<double> number = numberOf(scalarValue(element, origin, key));
    if (!number)
    {
      fail(origin, key + ": element '" + element.Scalar() + "' is not a number");
    }
    numbers.push_back(*number);
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
      fail(origin, key + " occurs twice in this file (first at " + read.at(key).origin + ")");
    }
  }
}

/// Reads the list of faults into the keys FAULTS.N.key, with N from 0.
void readFaults(const std::string& source, const YAML::Node& list, ParameterMap& read)
{
  int number = 0;
  for (const YAML::Node& fault : list)
  {
    const std::string name = faultKey(number++);
    if (!fault.IsMap())
    {
      fail(originOf(source, fault), name + " must be " + FAULT_FORM);
    }
    readSection(source, name, fault, read);
  }
}

/// Content of a configuration file.
struct Document
{
  std::string text;
  ParameterMap values;
  bool has_faults{};  // whether the file has a list of faults, which may be empty
};

Document readDocument(const std::string& source, const YAML::Node& root)
{
  if (!root.IsMap())
  {
    fail(source, "expected `section: {key: value}`");
  }
  Document read;
  for (const auto& entry : root)
  {
    const std::string origin = originOf(source, entry.first);
    const std::string section = keyText(entry.first, origin);
    if (section == FAULTS && entry.second.IsSequence())
    {
      read.has_faults = true;
      readFaults(source, entry.second, read.values);
      continue;
    }
    if (!entry.second.IsMap() || section == FAULTS)
    {
      const std::string value = entry.second.IsScalar() ? " = " + entry.second.Scalar() : "";
      fail(origin, section + value + " must be " +
                       (section == FAULTS ? std::string("a list of ") + FAULT_FORM : "keys and values"));
    }
    readSection(source, section, entry.second, read.values);
  }
  return read;
}

Document parsedDocument(const std::string& path, const std::string& text)
{
  std::vector<YAML::Node> documents;
  try
  {
    documents = YAML::LoadAll(text);
  }
  catch (const YAML::Exception& error)
  {
    fail(path + ":" + std::to_string(error.mark.line + 1), error.msg);
  }
  if (documents.size() != 1)
  {
    fail(path, "the file must hold one YAML document, but holds " + std::to_string(documents.size()));
  }
  Document read = readDocument(path, documents.front());
  read.text = text;
  return read;
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
  std::string reason = "it is empty";
  const std::optional<std::string> text = wholeFile(path, MAX_TEXT, &reason);
  if (!text || text->empty())
  {
    fail(path, "cannot be read: " + reason);
  }
  // Keeps the content of files, because all joints of all arms read the same files.
  thread_local std::map<std::string, Document> known;
  Document& document = known[path];
  if (document.text != *text)
  {
    document = parsedDocument(path, *text);
  }
  if (document.has_faults)
  {
    eraseFaults(map);
  }
  for (const auto& [key, value] : document.values)
  {
    map[key] = value;
  }
}

void readDefaultConfiguration(const std::string& directory, ParameterMap& map)
{
  const std::string list = directory + "/stages";
  std::ifstream file(list);
  if (!file)
  {
    fail(list, "cannot be read, so that this directory has no default configuration");
  }
  for (std::string name; std::getline(file, name);)
  {
    if (!name.empty() && name.front() != '#')
    {
      readYamlFile(directory + '/' + name, map);
    }
  }
}

ParameterValue parseScalar(const std::string& text, bool quoted, const std::string& key, const std::string& origin)
{
  return { quoted ? Value(text) : plainValue(text, origin, key), origin };
}

void readDescription(const std::string& text, const std::string& source, ParameterMap& map)
{
  eraseFaults(map);
  try
  {
    const YAML::Node root = YAML::Load(text);
    if (!root.IsMap())
    {
      fail(source, "expected a line `section.key: value` for each parameter");
    }
    for (const auto& entry : root)
    {
      const std::string origin = originOf(source, entry.first);
      const std::string key = keyText(entry.first, origin);
      map[key] = readValue(entry.second, origin, key);
    }
  }
  catch (const YAML::Exception& error)
  {
    fail(source, error.what());
  }
}

void readAssignment(const std::string& assignment, ParameterMap& map)
{
  const std::string origin = "--set " + assignment;
  const std::size_t equals = assignment.find('=');
  const std::string key = assignment.substr(0, equals);
  const auto is_name = [](const std::string& name)
  {
    return !name.empty() &&
           std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
  };
  const std::size_t dot = key.find('.');
  if (equals == std::string::npos || dot == std::string::npos || !is_name(key.substr(0, dot)) ||
      !is_name(key.substr(dot + 1)))
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
