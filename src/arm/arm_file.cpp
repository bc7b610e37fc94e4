// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_description.hpp"

#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
constexpr const char* LIKE = "like";
constexpr const char* DESCRIPTION = "description";
constexpr int MAX_FILES = 8;  // largest number of files in a chain in which each file is like the next
// Limits of nested levels and of values, needed because an alias of YAML can contain itself or many copies of values.
constexpr int MAX_DEPTH = 32;
constexpr std::size_t MAX_VALUES = 100'000;

/// Reads the values of one YAML file.
class Reading
{
public:
  explicit Reading(std::string file) : file_(std::move(file)) {}

  /// Returns the values. `place`: the place where another file names this file, as the beginning of an error text.
  ParameterMap read(const std::string& place)
  {
    try
    {
      const YAML::Node root = YAML::Load(textOf(file_, place));
      if (!root.IsMap())
      {
        throw ParameterError(file_ + ": the file must hold keys with values");
      }
      take(root, "", 0);
    }
    catch (const YAML::Exception& error)
    {
      throw ParameterError(file_ + ":" + std::to_string(error.mark.line + 1) + ": " + error.msg);
    }
    return std::move(values_);
  }

private:
  void take(const YAML::Node& node, const std::string& key, int depth)
  {
    const std::string origin = file_ + ":" + std::to_string(node.Mark().line + 1);
    if (depth > MAX_DEPTH || ++count_ > MAX_VALUES)
    {
      throw ParameterError(origin + ": " + key + " makes the file too large: at most " + std::to_string(MAX_DEPTH) +
                           " levels and " + std::to_string(MAX_VALUES) + " values; each use of an alias counts");
    }
    if (node.IsMap())
    {
      for (const auto& entry : node)
      {
        take(entry.second, below(key, entry.first.as<std::string>()), depth + 1);
      }
    }
    else if (node.IsSequence() && !holdsNumbers(node, origin))
    {
      int number = 0;
      for (const YAML::Node& element : node)
      {
        take(element, below(key, std::to_string(number++)), depth + 1);
      }
    }
    else if (!node.IsDefined() || node.IsNull())
    {
      throw ParameterError(origin + ": " + key + " has no value");
    }
    else if (!values_.emplace(key, valueOf(node, key, origin)).second)
    {
      throw ParameterError(origin + ": " + key + " occurs twice in this file (first at " + values_.at(key).origin +
                           ")");
    }
  }

  static std::string below(const std::string& key, const std::string& name)
  {
    return key.empty() ? name : key + "." + name;
  }

  /// Whether a list is a list of numbers, judged by its first element. An empty list is a list of numbers.
  static bool holdsNumbers(const YAML::Node& list, const std::string& origin)
  {
    return list.size() == 0 || (list[0].IsScalar() && numberIn(list[0], "", origin));
  }

  static std::optional<double> numberIn(const YAML::Node& node, const std::string& key, const std::string& origin)
  {
    return node.IsScalar() ? numberOf(scalarOf(node, key, origin).value) : std::nullopt;
  }

  static ParameterValue scalarOf(const YAML::Node& node, const std::string& key, const std::string& origin)
  {
    // yaml-cpp gives a quoted text the tag "!", and a plain text the tag "?".
    return parseScalar(node.Scalar(), node.Tag() == "!", key, origin);
  }

  static ParameterValue valueOf(const YAML::Node& node, const std::string& key, const std::string& origin)
  {
    if (node.IsScalar())
    {
      return scalarOf(node, key, origin);
    }
    std::vector<double> numbers;
    for (const YAML::Node& element : node)
    {
      const std::optional<double> number = numberIn(element, key, origin);
      if (!number)
      {
        throw ParameterError(origin + ": " + key + " must be a list of numbers alone");
      }
      numbers.push_back(*number);
    }
    return { numbers, origin };
  }

  std::string file_;
  ParameterMap values_;
  std::size_t count_{};
};

std::string sectionOf(const std::string& key)
{
  return key.substr(0, key.find('.'));
}

/// Name of a file that the map holds under `key`. The value must be a text.
std::string fileName(const ParameterMap& map, const char* key)
{
  const ParameterValue& value = map.at(key);
  const auto* text = std::get_if<std::string>(&value.value);
  if (text == nullptr)
  {
    throw ParameterError(value.origin + ": " + key + " = " + valueText(value) + " must be the name of a file");
  }
  return *text;
}

ParameterMap readLike(const std::string& path, const std::string& place, int files)
{
  ParameterMap own = Reading(path).read(place);
  if (own.count(DESCRIPTION) != 0)
  {
    own[DESCRIPTION].value = beside(path, fileName(own, DESCRIPTION));
  }
  if (own.count(LIKE) == 0)
  {
    return own;
  }
  if (files == MAX_FILES)
  {
    throw ParameterError(own[LIKE].origin + ": like: a chain of more than " + std::to_string(MAX_FILES) + " files");
  }
  const ParameterMap other = readLike(beside(path, fileName(own, LIKE)), own[LIKE].origin + ": like: ", files + 1);
  own.erase(LIKE);
  ParameterMap whole = own;
  for (const auto& [key, value] : other)
  {
    // A section in this file replaces the whole section of the same name in the file that `like` names.
    const auto given = own.lower_bound(sectionOf(key));
    if (given == own.end() || sectionOf(given->first) != sectionOf(key))
    {
      whole.emplace(key, value);
    }
  }
  return whole;
}
}  // namespace

std::string beside(const std::string& path, const std::string& name)
{
  return (std::filesystem::path(path).parent_path() / name).string();
}

std::string textOf(const std::string& path, const std::string& place)
{
  std::string reason = "it is empty";
  std::optional<std::string> text = wholeFile(path, MAX_TEXT, &reason);
  if (!text || text->empty())
  {
    throw ParameterError(place + path + " cannot be read: " + reason);
  }
  return std::move(*text);
}

ParameterMap readArmFile(const std::string& path)
{
  return readLike(path, "", 0);
}
}  // namespace hjt
