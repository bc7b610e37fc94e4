// SPDX-License-Identifier: BSD-3-Clause
#include "apps/sweep/plan_values.hpp"

#include <algorithm>
#include <cmath>

#include "apps/sweep/variable.hpp"

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
[[noreturn]] void refuse(const PlanNode& node, const ParameterValue& value, const std::string& what)
{
  throw InputError(node.origin + ": " + node.path + " = " + valueText(value) + " " + what);
}

void requireRange(const PlanNode& node, const ParameterValue& value, double number, const char* unit,
                  const Range& range)
{
  // Written so that NaN fails.
  if (!(number >= range.min && number <= range.max))
  {
    const std::string with_unit = " [" + std::string(unit) + "]";
    refuse(node, value, with_unit.substr(1) + " is out of range, allowed: " + rangeText(range) + with_unit);
  }
}

const char* kindName(PlanNode::Kind kind)
{
  return kind == PlanNode::Kind::SCALAR ? "a value" : kind == PlanNode::Kind::LIST ? "a list" : "a mapping";
}
}  // namespace

ParameterValue PlanValues::value(const PlanNode& node) const
{
  const auto drawn = drawn_.find(&node);
  if (drawn != drawn_.end())
  {
    return drawn->second;
  }
  if (node.kind == PlanNode::Kind::SCALAR)
  {
    return node.scalar;
  }
  if (node.kind == PlanNode::Kind::MAP)
  {
    node.refuse("must be a value or one of grid, uniform, log_uniform, normal, integer, choice");
  }
  std::vector<double> numbers;
  for (const auto& [key, element] : node.entries)
  {
    const ParameterValue one = value(element);
    if (const auto* number = std::get_if<double>(&one.value))
    {
      numbers.push_back(*number);
    }
    else if (const auto* whole = std::get_if<std::int64_t>(&one.value))
    {
      numbers.push_back(static_cast<double>(*whole));
    }
    else
    {
      element.refuse("must be a number");
    }
  }
  return { numbers, node.origin };
}

double PlanValues::number(const PlanNode& map, const std::string& key, const char* unit, const Range& range) const
{
  const PlanNode& node = required(map, key);
  const ParameterValue found = value(node);
  double number = 0.0;
  if (const auto* floating = std::get_if<double>(&found.value))
  {
    number = *floating;
  }
  else if (const auto* whole = std::get_if<std::int64_t>(&found.value))
  {
    number = static_cast<double>(*whole);
  }
  else
  {
    refuse(node, found, std::string("must be a number [") + unit + "], " + rangeText(range));
  }
  requireRange(node, found, number, unit, range);
  return number;
}

std::int64_t PlanValues::whole(const PlanNode& map, const std::string& key, const char* unit, const Range& range) const
{
  const PlanNode& node = required(map, key);
  const ParameterValue found = value(node);
  const auto* whole = std::get_if<std::int64_t>(&found.value);
  if (whole == nullptr)
  {
    refuse(node, found, std::string("must be a whole number [") + unit + "], " + rangeText(range));
  }
  requireRange(node, found, static_cast<double>(*whole), unit, range);
  return *whole;
}

std::string PlanValues::text(const PlanNode& map, const std::string& key) const
{
  const PlanNode& node = required(map, key);
  const ParameterValue found = value(node);
  const auto* text = std::get_if<std::string>(&found.value);
  if (text == nullptr || text->empty())
  {
    refuse(node, found, "must be a text");
  }
  return *text;
}

bool PlanValues::flag(const PlanNode& map, const std::string& key) const
{
  const PlanNode* node = map.find(key);
  if (node == nullptr)
  {
    return false;
  }
  const ParameterValue found = value(*node);
  const auto* flag = std::get_if<bool>(&found.value);
  if (flag == nullptr)
  {
    refuse(*node, found, "must be true or false");
  }
  return *flag;
}

const PlanNode& required(const PlanNode& map, const std::string& key)
{
  const PlanNode* node = map.find(key);
  if (node == nullptr)
  {
    map.refuse("lacks the key '" + key + "'");
  }
  return *node;
}

const PlanNode& required(const PlanNode& map, const std::string& key, PlanNode::Kind kind)
{
  const PlanNode& node = required(map, key);
  if (node.kind != kind)
  {
    node.refuse(std::string("must be ") + kindName(kind));
  }
  return node;
}

void allowOnly(const PlanNode& map, const std::vector<std::string>& keys)
{
  std::string list;
  for (const std::string& key : keys)
  {
    list += (list.empty() ? "" : ", ") + key;
  }
  if (map.kind != PlanNode::Kind::MAP)
  {
    map.refuse("must be a mapping with keys of: " + list);
  }
  for (const auto& [key, node] : map.entries)
  {
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
    {
      node.refuse("is unknown; allowed: " + list);
    }
  }
}
}  // namespace hjt
