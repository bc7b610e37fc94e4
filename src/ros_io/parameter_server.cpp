// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/parameter_server.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <variant>

#include <ros/names.h>
#include <ros/param.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include "base/text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
using XmlRpc::XmlRpcValue;

/// Name of a parameter of the node that is not a parameter of the twin: the period of /diagnostics.
constexpr const char* DIAGNOSTIC_PERIOD = "diagnostic_period";

// The conversions of XmlRpcValue need a reference that is not const.
template <class T>
T valueOf(XmlRpcValue& value)
{
  return static_cast<T&>(value);
}

using Value = decltype(ParameterValue::value);

/// The value as a parameter; empty if `leaf` is not a boolean, a number or a text.
std::optional<Value> scalarValue(XmlRpcValue& leaf)
{
  switch (leaf.getType())
  {
    case XmlRpcValue::TypeBoolean:
      return valueOf<bool>(leaf);
    case XmlRpcValue::TypeInt:
      return static_cast<std::int64_t>(valueOf<int>(leaf));
    case XmlRpcValue::TypeDouble:
      return valueOf<double>(leaf);
    case XmlRpcValue::TypeString:
      return valueOf<std::string>(leaf);
    default:
      return std::nullopt;
  }
}

std::vector<double> readNumbers(const std::string& key, XmlRpcValue& list)
{
  std::vector<double> numbers;
  for (int i = 0; i < list.size(); ++i)
  {
    const std::optional<Value> entry = scalarValue(list[i]);
    const std::optional<double> number = entry ? numberOf(*entry) : std::nullopt;
    if (!number)
    {
      throw ParameterError(key + ": entry " + std::to_string(i) +
                           " of the list on the parameter server is not a number");
    }
    numbers.push_back(*number);
  }
  return numbers;
}

void addTree(const std::string& prefix, XmlRpcValue& tree, const std::string& origin, ParameterMap& map);

void addFaults(XmlRpcValue& list, const std::string& origin, ParameterMap& map)
{
  for (int i = 0; i < list.size(); ++i)
  {
    if (list[i].getType() != XmlRpcValue::TypeStruct)
    {
      throw ParameterError(faultKey(i) + ": " + origin + " is not a fault {kind, severity, place, onset}");
    }
    addTree(faultKey(i), list[i], origin, map);
  }
}

void addLeaf(const std::string& key, XmlRpcValue& leaf, const std::string& origin, ParameterMap& map)
{
  std::optional<Value> value = scalarValue(leaf);
  if (!value && leaf.getType() == XmlRpcValue::TypeArray)
  {
    value = readNumbers(key, leaf);
  }
  if (!value)
  {
    throw ParameterError(key + ": " + origin + " must be a number, a text, a boolean or a list of numbers");
  }
  map[key] = { *value, origin };
}

void addTree(const std::string& prefix, XmlRpcValue& tree, const std::string& origin, ParameterMap& map)
{
  for (auto& [name, value] : tree)
  {
    const std::string key = prefix.empty() ? name : prefix + '.' + name;
    if (value.getType() == XmlRpcValue::TypeStruct)
    {
      addTree(key, value, origin + '/' + name, map);
    }
    else if (key == FAULTS && value.getType() == XmlRpcValue::TypeArray)
    {
      addFaults(value, origin + '/' + name, map);
    }
    else
    {
      addLeaf(key, value, origin + '/' + name, map);
    }
  }
}

ParameterMap readAll(const std::string& parameter_namespace)
{
  ParameterMap map;
  XmlRpcValue tree;
  if (ros::param::get(parameter_namespace, tree) && tree.getType() == XmlRpcValue::TypeStruct)
  {
    addTree("", tree, parameter_namespace, map);
  }
  return map;
}

/// Whether `parseParameters` makes equal parameters of the two values.
bool areAlike(const Value& a, const Value& b)
{
  const std::optional<double> number_a = numberOf(a);
  const std::optional<double> number_b = numberOf(b);
  return number_a && number_b ? *number_a == *number_b : a == b;
}

XmlRpcValue xmlValue(const ParameterValue& parameter)
{
  return std::visit(
      [](const auto& value)
      {
        using T = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<T, std::int64_t>)
        {
          return XmlRpcValue(static_cast<int>(value));
        }
        else if constexpr (std::is_same_v<T, std::vector<double>>)
        {
          XmlRpcValue list;
          list.setSize(static_cast<int>(value.size()));
          for (std::size_t i = 0; i < value.size(); ++i)
          {
            list[static_cast<int>(i)] = value[i];
          }
          return list;
        }
        else
        {
          return XmlRpcValue(value);
        }
      },
      parameter.value);
}
}  // namespace

void writeParameterServer(const std::string& parameter_namespace, const ParameterMap& map)
{
  XmlRpcValue tree;
  XmlRpcValue faults;
  for (const auto& [key, parameter] : map)
  {
    const std::size_t first = key.find('.');
    const std::string section = key.substr(0, first);
    const std::string name = key.substr(first + 1);
    const std::size_t second = name.find('.');
    if (section == FAULTS && second != std::string::npos)
    {
      const int number = std::stoi(name.substr(0, second));
      if (faults.getType() == XmlRpcValue::TypeInvalid || faults.size() <= number)
      {
        faults.setSize(number + 1);
      }
      faults[number][name.substr(second + 1)] = xmlValue(parameter);
    }
    else
    {
      tree[section][name] = xmlValue(parameter);
    }
  }
  if (faults.getType() == XmlRpcValue::TypeArray)
  {
    tree[FAULTS] = faults;
  }
  for (const auto& [section, value] : tree)
  {
    ros::param::set(ros::names::append(parameter_namespace, section), value);
  }
}

ParameterMap readParameterServer(const std::string& parameter_namespace)
{
  ParameterMap map = readAll(parameter_namespace);
  for (const char* key :
       { DIAGNOSTIC_PERIOD, ARM, IDENTIFIED, REFERENCE, DESCRIPTION, PREFIX, SUFFIX, FAULT, CONTROLLER })
  {
    map.erase(key);
  }
  const std::string launch = LAUNCH + std::string(".");
  for (auto entry = map.lower_bound(launch); entry != map.end() && entry->first.rfind(launch, 0) == 0;)
  {
    map.emplace(entry->first.substr(launch.size()), entry->second);
    entry = map.erase(entry);
  }
  return map;
}

FoundParameters::FoundParameters(int argc, const char* const* argv)
{
  for (int i = 1; i < argc; ++i)
  {
    const std::string argument = argv[i];
    is_cleared_ = is_cleared_ || argument == CLEARED;
    if (argument.rfind('_', 0) == 0)
    {
      std::string key = argument.substr(1, argument.find(":=") - 1);
      std::replace(key.begin(), key.end(), '/', '.');
      given_.insert(key);
    }
  }
}

bool FoundParameters::areGiven(const ParameterMap& map) const
{
  return std::all_of(map.begin(), map.end(),
                     [this](const auto& parameter) { return given_.count(parameter.first) > 0; });
}

std::string FoundParameters::departures(const std::string& parameter_namespace,
                                        const std::vector<ParameterMap>& shipped) const
{
  std::vector<std::string> found;
  for (const auto& [key, parameter] : is_cleared_ ? ParameterMap{} : readAll(parameter_namespace))
  {
    const auto departs = [&key = key, &value = parameter.value](const ParameterMap& map)
    {
      const auto expected = map.find(key);
      return expected == map.end() || !areAlike(value, expected->second.value);
    };
    if (given_.count(key) == 0 && std::any_of(shipped.begin(), shipped.end(), departs))
    {
      std::string name = key;
      std::replace(name.begin(), name.end(), '.', '/');
      found.push_back(name + " = " + valueText(parameter));
    }
  }
  const std::size_t count = found.size();
  if (count > MAX_NAMED)
  {
    found.resize(MAX_NAMED);
    found.push_back(std::to_string(count - MAX_NAMED) + " more");
  }
  return joined(found, ", ");
}
}  // namespace hjt
