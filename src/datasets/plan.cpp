// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/plan.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
using Kind = PlanNode::Kind;

constexpr double MAX_RUNS = 1e9;
/// Where a plan has no classes: all runs are of this one.
const PlanNode::Entry HEALTHY{ "healthy", PlanNode{ Kind::LIST, "classes.healthy", "", {}, {} } };
/// Of the runs of a plan of lives.
const PlanNode::Entry LIFE{ "life", PlanNode{ Kind::LIST, "lives", "", {}, {} } };

/// With the overlays that the plan names, which lie beside it or in the default configuration's folder.
ConfigurationOptions withOverlays(const PlanNode& root, const std::string& directory, ConfigurationOptions options)
{
  if (root.find("overlays") != nullptr)
  {
    const PlanNode& list = required(root, "overlays", Kind::LIST);
    for (const auto& [key, node] : list.entries)
    {
      const std::string name = PlanValues().text(list, key);
      const std::filesystem::path beside = std::filesystem::path(directory) / name;
      options.configs.push_back(std::filesystem::exists(beside) ? beside.string() : name);
    }
  }
  return options;
}
}  // namespace

Plan::Plan(const std::string& path, const ConfigurationOptions& options)
  : directory_(std::filesystem::path(path).parent_path().string()), root_(readPlanFile(path))
{
  const bool of_arms = root_.find("arm") != nullptr;
  std::vector<std::string> keys{ "name",    "seed",  "duration", "overlays", "set",
                                 "repeats", "lives", "duty",     "classes",  "record" };
  if (of_arms)
  {
    keys.insert(keys.end(), { "arm", "identified" });
  }
  allowOnly(root_, keys);
  const ConfigurationOptions configuration = withOverlays(root_, directory_, options);
  const PlanValues values;
  name_ = values.text(root_, "name", std::filesystem::path(path).stem().string());
  seed_ = static_cast<std::uint32_t>(values.whole(root_, "seed", "-", { 0, 4294967295.0 }, 1));
  repeats_ = static_cast<std::uint64_t>(values.whole(root_, "repeats", "-", { 1, MAX_RUNS }, 1));
  if (of_arms)
  {
    arm_.emplace(root_, directory_, configuration);
  }
  else
  {
    base_ = loadParameterMap(configuration);
    duties_.readTables(required(root_, "duty", Kind::LIST), directory_);
  }
  recording_ = readRecording(required(root_, "record", Kind::MAP), of_arms);
  root_.find("lives") != nullptr ? makeLives() : makeBlocks();
  if (runs_ == 0)
  {
    root_.find("duty")->refuse("must have at least one duty cycle");
  }
  try
  {
    first_ = run(0).parameters;
  }
  catch (const InputError&)
  {
    // Whoever asks for the run is told.
  }
}

void Plan::collect(const PlanNode& node, std::vector<const Variable*>& into)
{
  if (Variable::stands(node))
  {
    const auto known = std::find_if(variables_.begin(), variables_.end(),
                                    [&](const auto& variable) { return &variable->node() == &node; });
    if (known == variables_.end())
    {
      variables_.push_back(std::make_unique<const Variable>(node));
      into.push_back(variables_.back().get());
    }
    else
    {
      into.push_back(known->get());
    }
    return;
  }
  for (const auto& [key, below] : node.entries)
  {
    collect(below, into);
  }
}

void Plan::makeBlocks()
{
  std::vector<const PlanNode::Entry*> classes;
  if (root_.find("classes") != nullptr)
  {
    for (const PlanNode::Entry& entry : required(root_, "classes", Kind::MAP).entries)
    {
      required(*root_.find("classes"), entry.first, Kind::LIST);
      classes.push_back(&entry);
    }
  }
  if (classes.empty())
  {
    classes.push_back(&HEALTHY);
  }
  for (const PlanNode::Entry* fault_class : classes)
  {
    for (const auto& [key, duty] : root_.find("duty")->entries)
    {
      addBlock(*fault_class, duty);
      Block& block = blocks_.back();
      block.first = runs_;
      double size = static_cast<double>(repeats_);
      for (const Variable* variable : block.variables)
      {
        size *= static_cast<double>(variable->gridSize());
        block.size *= variable->gridSize();
      }
      if (static_cast<double>(runs_) + size > MAX_RUNS)
      {
        root_.refuse("has more than " + numberText(MAX_RUNS) + " runs");
      }
      runs_ += block.size;
    }
  }
}

void Plan::addBlock(const PlanNode::Entry& fault_class, const PlanNode& duty)
{
  Block block{ &fault_class, &duty, {}, 0, repeats_ };
  if (!arm_ || root_.find("duration") != nullptr)
  {
    collect(required(root_, "duration"), block.variables);
  }
  if (root_.find("set") != nullptr)
  {
    collect(required(root_, "set", Kind::MAP), block.variables);
  }
  collect(duty, block.variables);
  collect(fault_class.second, block.variables);
  blocks_.push_back(block);
}

void Plan::makeLives()
{
  for (const char* other : { "classes", "repeats" })
  {
    if (root_.find(other) != nullptr)
    {
      root_.find(other)->refuse("is not allowed in a plan of lives: the faults follow from the drive's wear there");
    }
  }
  // The laws of ageing take the drive that is the same in all lives.
  ParameterMap nominal = base_;
  if (const PlanNode* settings = root_.find("set"))
  {
    for (const auto& [key, node] : settings->entries)
    {
      if (!Variable::stands(node))
      {
        nominal[key] = { PlanValues().value(node).value, node.origin };
      }
    }
  }
  eraseFaults(nominal);
  lives_ =
      std::make_unique<const Lives>(required(root_, "lives", Kind::MAP), parseParameters(nominal), directory_, seed_);
  const std::vector<PlanNode::Entry>& duties = root_.find("duty")->entries;
  for (const auto& [key, duty] : duties)
  {
    addBlock(LIFE, duty);
    Block& block = blocks_.back();
    block.first = blocks_.size() - 1;
    block.size = lives_->checkUps();
    block.apart = duties.size();
    for (const Variable* variable : block.variables)
    {
      if (variable->gridSize() > 1)
      {
        variable->node().refuse("cannot be a grid in a plan of lives: give a distribution or one value");
      }
    }
  }
  runs_ = lives_->checkUps() * duties.size();
}

std::vector<std::string> Plan::variableNames() const
{
  std::vector<std::string> names;
  for (const auto& variable : variables_)
  {
    names.push_back(variable->node().path);
  }
  if (lives_)
  {
    const std::vector<std::string> labels = Lives::labelNames();
    names.insert(names.end(), labels.begin(), labels.end());
  }
  return names;
}

OrderedJson Plan::snapshot() const
{
  OrderedJson tables = duties_.tables();
  if (lives_)
  {
    tables["lives"] = lives_->duties();
  }
  OrderedJson base = OrderedJson::object();
  for (const auto& [key, value] : base_)
  {
    base[key] = jsonOf(value);
  }
  if (arm_)
  {
    tables = arm_->motions();
    base = arm_->configuration();
  }
  return { { "runs", runs_ }, { "plan", jsonOf(root_) }, { "tables", tables }, { "configuration", base } };
}
}  // namespace hjt
