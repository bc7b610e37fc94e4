// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/parameter_server.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <ros/param.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
using XmlRpc::XmlRpcValue;

/// Read by diagnostic_updater itself from the same namespace.
constexpr const char* DIAGNOSTIC_PERIOD = "diagnostic_period";

// XmlRpcValue converts by reference to non-const only.
template <class T>
T valueOf(XmlRpcValue& value)
{
  return static_cast<T&>(value);
}

using Value = decltype(ParameterValue::value);

/// Nothing if `leaf` is no boolean, number or text.
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
      throw ParameterError(faultKey(i) + ": " + origin + " holds no fault {kind, severity, place, onset}");
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
    throw ParameterError(key + ": " + origin + " holds neither a number, a text, a boolean nor a list of numbers");
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
    else if (key != DIAGNOSTIC_PERIOD && key != ARM && key != IDENTIFIED && key != DESCRIPTION)
    {
      addLeaf(key, value, origin + '/' + name, map);
    }
  }
}
}  // namespace

ParameterMap readParameterServer(const std::string& parameter_namespace)
{
  ParameterMap map;
  XmlRpcValue tree;
  if (ros::param::get(parameter_namespace, tree) && tree.getType() == XmlRpcValue::TypeStruct)
  {
    addTree("", tree, parameter_namespace, map);
  }
  return map;
}
}  // namespace hjt
