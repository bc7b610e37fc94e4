// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/plan.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "params/configuration_files.hpp"

namespace hjt
{
namespace
{
using Kind = PlanNode::Kind;

constexpr double MAX_RUNS = 1e9;
/// Class of all runs if the plan has no classes.
const PlanNode::Entry HEALTHY{ "healthy", PlanNode{ Kind::LIST, "classes.healthy", "", {}, {} } };
/// Class of all runs in a plan of lives.
const PlanNode::Entry LIFE{ "life", PlanNode{ Kind::LIST, "lives", "", {}, {} } };

/// Adds the overlays that the plan names. They are sought in the plan's directory, then in that of the configuration.
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

constexpr const char* NOISE_SEED = "sensors.noise_seed";
constexpr const char* LIVES_SET = "set.";  // prefix of the names of values that are drawn for each drive
constexpr const char* DRIVES_SET = "drives.set.";

void refuseGrids(const std::vector<const Variable*>& variables, const std::string& where)
{
  for (const Variable* variable : variables)
  {
    if (variable->gridSize() > 1)
    {
      variable->node().refuse("cannot be a grid " + where + ": give a distribution or one value");
    }
  }
}
}  // namespace

Plan::Plan(const std::string& path, const ConfigurationOptions& options)
  : directory_(std::filesystem::path(path).parent_path().string()), root_(readPlanFile(path))
{
  const bool of_arms = root_.find("arm") != nullptr;
  std::vector<std::string> keys{ "name",    "seed",  "duration", "overlays", "set",   "drives",
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
  for (Block& block : blocks_)
  {
    block.period = period_;
    block.size = runs_ / period_ * block.together;
  }
  try
  {
    first_ = run(0).parameters;
  }
  catch (const InputError&)
  {
    // The error is not reported here; the caller of `run` gets it.
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
  const std::uint64_t drives = root_.find("drives") != nullptr ? readDrives() : 1;
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
      double size = static_cast<double>(repeats_);
      for (const Variable* variable : block.variables)
      {
        size *= static_cast<double>(variable->gridSize());
        block.together *= variable->gridSize();
      }
      if ((static_cast<double>(period_) + size) * static_cast<double>(drives) > MAX_RUNS)
      {
        root_.refuse("has more than " + numberText(MAX_RUNS) + " runs");
      }
      period_ += block.together;
    }
  }
  runs_ = drives * period_;
}

/// Reads the mapping `drives` of the plan. @returns the number of drives.
std::uint64_t Plan::readDrives()
{
  const PlanNode& node = required(root_, "drives", Kind::MAP);
  allowOnly(node, { "number", "test", "set" });
  const auto number =
      static_cast<std::uint64_t>(PlanValues().whole(node, "number", "-", { 2, DriveSplit::MAX_DRIVES }));
  split_.emplace(node);
  const std::uint64_t tests = split_->testsOf(number);
  if (tests == 0 || tests == number)
  {
    node.refuse("with test = " + numberText(split_->share()) + " [-] leaves no drive of " + std::to_string(number) +
                (tests == 0 ? " for the test" : " to learn from") +
                ", allowed: " + numberText(1.0 / static_cast<double>(number)) + " ... below 1 [-]");
  }
  const PlanNode& settings = required(node, "set", Kind::MAP);
  const PlanNode* common = root_.find("set");
  for (const auto& [key, setting] : settings.entries)
  {
    if (common != nullptr && common->find(key) != nullptr)
    {
      setting.refuse("is also in the mapping 'set'; use only one of the two");
    }
  }
  std::vector<const Variable*> drawn;
  collect(settings, drawn);
  refuseGrids(drawn, "over drives");
  if (drawn.empty())
  {
    settings.refuse("must draw at least one parameter, because otherwise all drives are equal");
  }
  return number;
}

void Plan::addBlock(const PlanNode::Entry& fault_class, const PlanNode& duty)
{
  Block block{ &fault_class, &duty, {}, period_, repeats_ };
  if (!arm_ || root_.find("duration") != nullptr)
  {
    collect(required(root_, "duration"), block.variables);
  }
  if (root_.find("set") != nullptr)
  {
    collect(required(root_, "set", Kind::MAP), block.variables);
  }
  if (split_)
  {
    collect(*root_.find("drives")->find("set"), block.variables);
  }
  collect(duty, block.variables);
  collect(fault_class.second, block.variables);
  blocks_.push_back(block);
}

void Plan::makeLives()
{
  for (const char* other : { "classes", "repeats", "drives" })
  {
    if (root_.find(other) != nullptr)
    {
      root_.find(other)->refuse(
          "is not allowed in a plan of lives, where lives.drives gives the drives, and their wear gives the faults");
    }
  }
  // The laws of ageing use the nominal drive, which has only the settings that are common to all lives.
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
  for (const auto& [key, duty] : root_.find("duty")->entries)
  {
    addBlock(LIFE, duty);
    refuseGrids(blocks_.back().variables, "in a plan of lives");
    ++period_;
  }
  runs_ = lives_->checkUps() * period_;
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
  if (split_)
  {
    names.insert(names.end(), { DriveSplit::DRIVE, DriveSplit::SPLIT });
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

/// Values of all variables in a run. They are also stored in `spec`.
PlanValues Plan::valuesOf(const Block& block, std::uint64_t number, RunSpec& spec) const
{
  std::uint64_t rest = number % period_ - block.first;
  spec.repeat = rest % repeats_;
  rest /= repeats_;
  const std::uint64_t drive = lives_ ? lives_->driveAt(number / period_) : number / period_;
  const char* const of_drives = lives_ ? LIVES_SET : DRIVES_SET;
  PlanValues values;
  spec.variables.resize(block.variables.size());
  for (std::size_t i = block.variables.size(); i-- > 0;)
  {
    const Variable& variable = *block.variables[i];
    const bool of_drive = variable.node().path.rfind(of_drives, 0) == 0;
    const ParameterValue value = variable.value(seed_, of_drive ? drive : number, rest % variable.gridSize());
    rest /= variable.gridSize();
    values.set(variable.node(), value);
    spec.variables[i] = { variable.node().path, value };
  }
  return values;
}

/// Labels of a run's drive that are not variables of the plan.
Lives::Labels Plan::labelsOf(std::uint64_t number) const
{
  const std::uint64_t period = number / period_;
  if (lives_)
  {
    return lives_->labelsAt(period);
  }
  return split_ ? Lives::Labels{ { DriveSplit::DRIVE, { static_cast<std::int64_t>(period), "" } },
                                 { DriveSplit::SPLIT, { std::string(split_->nameOf(period)), "" } } } :
                  Lives::Labels();
}

RunSpec Plan::run(std::uint64_t number) const
{
  const auto after = std::upper_bound(blocks_.begin(), blocks_.end(), number % period_,
                                      [](std::uint64_t run, const Block& block) { return run < block.first; });
  const Block& block = *(after - 1);
  RunSpec spec;
  spec.run = number;
  spec.fault_class = block.fault_class->first;
  const PlanValues values = valuesOf(block, number, spec);
  const Lives::Labels labels = labelsOf(number);
  spec.variables.insert(spec.variables.end(), labels.begin(), labels.end());
  spec.duty_name = values.text(*block.duty, "name", "duty");
  arm_ ? takeArm(block, values, spec) : takeDrive(block, values, spec);
  constexpr Range DURATION{ 1e-3, 1e6 };
  spec.duration = values.number(root_, "duration", "s", DURATION,
                                arm_ ? std::make_optional(spec.arm->motionLength()) : std::nullopt);
  if (spec.duration <= recording_.start)
  {
    const bool given = root_.find("duration") != nullptr;
    (given ? *root_.find("duration") : *block.duty)
        .refuse((given ? "[s] must be more than record.start = " : "its motion ends before record.start = ") +
                numberText(recording_.start) + " [s]");
  }
  checkRates(spec.parameters);
  return spec;
}

std::vector<RunFault> Plan::faultsOf(const PlanNode& list, const PlanValues& values) const
{
  std::vector<RunFault> faults;
  for (const auto& [number, node] : list.entries)
  {
    const std::string joint = arm_ ? "joint: ..., " : "";
    if (node.kind != PlanNode::Kind::MAP || node.entries.empty())
    {
      node.refuse("must be {" + joint + "kind: ..., severity: ..., place: ..., onset: ..., ramp: ...}");
    }
    std::vector<std::string> keys{ "kind", "severity", "place", "onset", "ramp" };
    if (arm_)
    {
      keys.push_back("joint");
    }
    allowOnly(node, keys);
    const std::optional<FaultKind> kind = faultNamed(values.text(node, "kind"));
    if (!kind)
    {
      required(node, "kind").refuse("is not a fault; allowed: " + faultNames());
    }
    RunFault growing;
    growing.joint = arm_ ? arm_->jointOf(node, values) : 0;
    growing.fault.kind = *kind;
    growing.fault.severity = values.number(node, "severity", "-", { 0.0, 1.0 });
    growing.fault.place = static_cast<int>(values.whole(node, "place", "-", { WHOLE_MEMBER, 4000 }, firstPlace(*kind)));
    growing.fault.onset = values.number(node, "onset", "s", { 0.0, 1e9 }, 0.0);
    growing.ramp = values.number(node, "ramp", "s", { 0.0, GrowingFault::MAX_RAMP }, 0.0);
    faults.push_back(growing);
  }
  return faults;
}

/// Sets duty, faults and parameters for a run of one drive.
void Plan::takeDrive(const Block& block, const PlanValues& values, RunSpec& spec) const
{
  spec.duty = duties_.read(*block.duty, values);
  constexpr double LEAST_EASING = 0.1;  // least time of easing [s]; a shorter one excites vibration like a step
  spec.duty.easing = 0.5 * recording_.start >= LEAST_EASING ? 0.5 * recording_.start : 0.0;
  ParameterMap settings = settingsOf(values, spec.run);
  const bool given = lives_ || root_.find("classes") != nullptr;
  if (given)
  {
    if (lives_)
    {
      for (const GrowingFault& fault : lives_->faultsAt(spec.run / period_))
      {
        spec.faults.push_back({ fault, 0 });
      }
    }
    else
    {
      spec.faults = faultsOf(block.fault_class->second, values);
    }
    setFaults(spec.faults, 0, block.fault_class->second.origin, settings);
  }
  spec.parameters = parametersOf(settings, given);
  if (!given)
  {
    spec.faults = configuredFaults(spec.parameters, 0);
  }
}

/// Sets motion, faults and drives for a run of a whole arm.
void Plan::takeArm(const Block& block, const PlanValues& values, RunSpec& spec) const
{
  const bool given = root_.find("classes") != nullptr;
  const PlanNode& list = block.fault_class->second;
  if (given)
  {
    spec.faults = faultsOf(list, values);
  }
  spec.arm = arm_->read(*block.duty, values, settingsOf(values, spec.run), given ? &spec.faults : nullptr, list.origin);
  for (std::size_t joint = 0; !given && joint < spec.arm->drives.size(); ++joint)
  {
    const std::vector<RunFault> more = configuredFaults(spec.arm->drives[joint], joint);
    spec.faults.insert(spec.faults.end(), more.begin(), more.end());
  }
  spec.parameters = spec.arm->drives.front();
}

ParameterMap Plan::settingsOf(const PlanValues& values, std::uint64_t number) const
{
  ParameterMap map;
  for (const PlanNode* above : { &root_, root_.find("drives") })
  {
    const PlanNode* settings = above != nullptr ? above->find("set") : nullptr;
    for (std::size_t i = 0; settings != nullptr && i < settings->entries.size(); ++i)
    {
      const auto& [key, node] = settings->entries[i];
      map[key] = { values.value(node).value, node.origin };
    }
  }
  if (map.count(NOISE_SEED) == 0)
  {
    map[NOISE_SEED] = { static_cast<std::int64_t>(drawnWord(seed_, NOISE_SEED, number) >> 1), root_.origin };
  }
  return map;
}

/// Parameters of the first run, changed by the settings of a run; both set the same keys. After an error, all
/// parameters are read again, so that the error has its full text.
Parameters Plan::parametersOf(const ParameterMap& settings, bool faults_given) const
{
  const auto first_fault = settings.lower_bound(FAULTS);
  const bool with_faults = first_fault != settings.end() && first_fault->first.rfind(FAULTS, 0) == 0;
  if (first_ && (faults_given || !with_faults))
  {
    try
    {
      Parameters parameters = *first_;
      parameters.faults = faults_given ? std::vector<Fault>() : parameters.faults;
      changeParameters(parameters, settings);
      return parameters;
    }
    catch (const ParameterError&)
    {
    }
  }
  ParameterMap map = base_;
  if (faults_given)
  {
    eraseFaults(map);
  }
  putOver(settings, map);
  return parseParameters(map);
}

void Plan::checkRates(const Parameters& parameters) const
{
  for (const RecordingGroup& group : recording_.groups)
  {
    const double steps = parameters.solver.rate / group.rate;
    if (std::abs(steps - std::round(steps)) > 1e-9 * steps || steps < 0.5)
    {
      const PlanNode& groups = *root_.find("record")->find("groups");
      required(*groups.find(group.name), "rate")
          .refuse("[Hz] must divide solver.rate = " + numberText(parameters.solver.rate) + " [Hz]");
    }
  }
}
}  // namespace hjt
