// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/plan_node.hpp"

#include <algorithm>

#include <yaml-cpp/yaml.h>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
// An alias can stand for itself, or for ever more copies of others.
constexpr int DEEPEST = 32;
constexpr std::size_t MAX_NODES = 100'000;

PlanNode convert(const YAML::Node& from, const std::string& file, const std::string& path, int depth,
                 std::size_t& nodes)
{
  PlanNode node;
  node.path = path;
  node.origin = file + ":" + std::to_string(from.Mark().line + 1);
  if (depth > DEEPEST || ++nodes > MAX_NODES)
  {
    node.refuse("makes the plan too large: at most " + std::to_string(DEEPEST) + " levels and " +
                std::to_string(MAX_NODES) + " values, aliases counted each time");
  }
  const auto below = [&](const YAML::Node& entry, const std::string& key)
  { return convert(entry, file, path.empty() ? key : path + "." + key, depth + 1, nodes); };
  if (from.IsScalar())
  {
    node.kind = PlanNode::Kind::SCALAR;
    node.scalar = parseScalar(from.Scalar(), from.Tag() == "!", path, node.origin);
  }
  else if (from.IsSequence())
  {
    node.kind = PlanNode::Kind::LIST;
    for (const YAML::Node& element : from)
    {
      const std::string key = std::to_string(node.entries.size());
      node.entries.emplace_back(key, below(element, key));
    }
  }
  else if (from.IsMap())
  {
    node.kind = PlanNode::Kind::MAP;
    for (const auto& entry : from)
    {
      const std::string key = entry.first.as<std::string>();
      if (node.find(key) != nullptr)
      {
        node.find(key)->refuse("stands twice");
      }
      node.entries.emplace_back(key, below(entry.second, key));
    }
  }
  else
  {
    node.refuse("has no value");
  }
  return node;
}
}  // namespace

const PlanNode* PlanNode::find(std::string_view key) const
{
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const Entry& entry) { return entry.first == key; });
  return found == entries.end() ? nullptr : &found->second;
}

void PlanNode::refuse(const std::string& what) const
{
  const std::string value = kind == Kind::SCALAR ? " = " + valueText(scalar) : "";
  throw InputError(origin + ": " + (path.empty() ? "the plan" : path + value) + " " + what);
}

std::optional<double> numberIn(const ParameterValue& value)
{
  if (const auto* whole = std::get_if<std::int64_t>(&value.value))
  {
    return static_cast<double>(*whole);
  }
  const auto* number = std::get_if<double>(&value.value);
  return number != nullptr ? std::optional<double>(*number) : std::nullopt;
}

OrderedJson jsonOf(const ParameterValue& value)
{
  return std::visit([](const auto& content) { return OrderedJson(content); }, value.value);
}

OrderedJson jsonOf(const PlanNode& node)
{
  if (node.kind == PlanNode::Kind::SCALAR)
  {
    return jsonOf(node.scalar);
  }
  OrderedJson json = node.kind == PlanNode::Kind::MAP ? OrderedJson::object() : OrderedJson::array();
  for (const auto& [key, below] : node.entries)
  {
    if (node.kind == PlanNode::Kind::MAP)
    {
      json[key] = jsonOf(below);
    }
    else
    {
      json.push_back(jsonOf(below));
    }
  }
  return json;
}

PlanNode readPlanFile(const std::string& path)
{
  try
  {
    std::size_t nodes = 0;
    const PlanNode root = convert(YAML::LoadFile(path), path, "", 0, nodes);
    if (root.kind != PlanNode::Kind::MAP)
    {
      root.refuse("must be a mapping of keys to values");
    }
    return root;
  }
  catch (const YAML::BadFile&)
  {
    throw InputError(path + " cannot be read");
  }
  catch (const YAML::Exception& error)
  {
    throw InputError(path + ":" + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
}
}  // namespace hjt
