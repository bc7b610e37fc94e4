// SPDX-License-Identifier: BSD-3-Clause
#include "apps/sweep/plan_node.hpp"

#include <algorithm>

#include <yaml-cpp/yaml.h>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
PlanNode convert(const YAML::Node& from, const std::string& file, const std::string& path)
{
  PlanNode node;
  node.path = path;
  node.origin = file + ":" + std::to_string(from.Mark().line + 1);
  const auto below = [&](const std::string& key) { return path.empty() ? key : path + "." + key; };
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
      node.entries.emplace_back(key, convert(element, file, below(key)));
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
      node.entries.emplace_back(key, convert(entry.second, file, below(key)));
    }
  }
  else
  {
    node.refuse("has no value");
  }
  return node;
}
}  // namespace

const PlanNode* PlanNode::find(const std::string& key) const
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

PlanNode readPlanFile(const std::string& path)
{
  try
  {
    const PlanNode root = convert(YAML::LoadFile(path), path, "");
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
