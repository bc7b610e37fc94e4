// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/plan_values.hpp"

#include <algorithm>

#include "datasets/variable.hpp"

#include "base/joined.hpp"
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

template <class T>
const T& contentOf(const PlanNode& node, const ParameterValue& value, const std::string& kind)
{
  const T* content = std::get_if<T>(&value.value);
  if (content == nullptr)
  {
    refuse(node, value, "must be " + kind);
  }
  return *content;
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
    const std::optional<double> number = numberIn(value(element));
    if (!number)
    {
      element.refuse("must be a number");
    }
    numbers.push_back(*number);
  }
  return { numbers, node.origin };
}

double PlanValues::number(const PlanNode& map, const std::string& key, const char* unit, const Range& range,
                          std::optional<double> otherwise) const
{
  if (otherwise && map.find(key) == nullptr)
  {
    return *otherwise;
  }
  const PlanNode& node = required(map, key);
  const ParameterValue found = value(node);
  const std::string with_unit = "[" + std::string(unit) + "]";
  const std::optional<double> number = numberIn(found);
  if (!number)
  {
    refuse(node, found, "must be a number " + with_unit + ", " + rangeText(range));
  }
  // Written so that NaN fails.
  if (!(*number >= range.min && *number <= range.max))
  {
    refuse(node, found, with_unit + " is out of range, allowed: " + rangeText(range) + " " + with_unit);
  }
  return *number;
}

std::int64_t PlanValues::whole(const PlanNode& map, const std::string& key, const char* unit, const Range& range,
                               std::optional<std::int64_t> otherwise) const
{
  if (otherwise && map.find(key) == nullptr)
  {
    return *otherwise;
  }
  const PlanNode& node = required(map, key);
  number(map, key, unit, range);
  return contentOf<std::int64_t>(node, value(node), "a whole number [" + std::string(unit) + "], " + rangeText(range));
}

std::string PlanValues::text(const PlanNode& map, const std::string& key,
                             const std::optional<std::string>& otherwise) const
{
  if (otherwise && map.find(key) == nullptr)
  {
    return *otherwise;
  }
  const PlanNode& node = required(map, key);
  const std::string text = contentOf<std::string>(node, value(node), "a text");
  if (text.empty())
  {
    node.refuse("must be a text");
  }
  return text;
}

bool PlanValues::flag(const PlanNode& map, const std::string& key) const
{
  const PlanNode* node = map.find(key);
  return node != nullptr && contentOf<bool>(*node, value(*node), "true or false");
}

const PlanNode& required(const PlanNode& map, std::string_view key)
{
  const PlanNode* node = map.find(key);
  if (node == nullptr)
  {
    map.refuse("lacks the key '" + std::string(key) + "'");
  }
  return *node;
}

const PlanNode& required(const PlanNode& map, std::string_view key, PlanNode::Kind kind)
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
  if (map.kind != PlanNode::Kind::MAP)
  {
    map.refuse("must be a mapping with keys of: " + joined(keys));
  }
  for (const auto& [key, node] : map.entries)
  {
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
    {
      node.refuse("is unknown; allowed: " + joined(keys));
    }
  }
}
}  // namespace hjt
