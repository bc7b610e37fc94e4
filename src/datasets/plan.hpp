// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/arm_plan.hpp"
#include "datasets/lives.hpp"
#include "datasets/plan_values.hpp"
#include "datasets/recording.hpp"
#include "datasets/run_duty.hpp"
#include "output/ordered_json.hpp"

#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "twin/options.hpp"

namespace hjt
{
/// One run of a plan, with nothing left open.
struct RunSpec
{
  std::uint64_t run{};
  std::string fault_class;
  std::string duty_name;
  std::uint64_t repeat{};
  double duration{};      ///< [s]
  Parameters parameters;  ///< growing faults are a staircase; of an arm those of its first drive
  std::vector<RunFault> faults;
  RunDuty duty;
  std::optional<ArmSpec> arm;                                     ///< of a plan of whole arms
  std::vector<std::pair<std::string, ParameterValue>> variables;  ///< path in the plan and value in this run
};

/// A plan of many runs: what is fixed, laid out on grids and drawn.
///
/// Runs are numbered class by class, within it duty cycle by duty cycle, within that grid by grid, the last one
/// fastest, then the repeats; a plan with `drives` drive by drive, all that of each. A plan of lives: life by life,
/// check-up by check-up, duty cycle by duty cycle; what `set` draws is drawn for each drive. A plan of whole arms: duty
/// cycles are motions, and `set` is that of all drives. After construction all members may be called from any thread.
class Plan
{
public:
  /// `options`: the configuration below the plan's own settings. @throws InputError naming file and line.
  Plan(const std::string& path, const ConfigurationOptions& options);
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;

  const std::string& name() const { return name_; }
  std::uint64_t runs() const { return runs_; }
  const Recording& recording() const { return recording_; }

  /// @throws InputError naming file, line, key, value, unit and range.
  RunSpec run(std::uint64_t number) const;

  /// Runs of one class and duty cycle.
  struct Block
  {
    const PlanNode::Entry* fault_class;
    const PlanNode* duty;
    std::vector<const Variable*> variables;
    std::uint64_t first;     ///< run
    std::uint64_t together;  ///< one after the other in each period
    std::uint64_t period{};  ///< that of the plan
    std::uint64_t size{};    ///< of all periods

    std::uint64_t run(std::uint64_t i) const { return first + i / together * period + i % together; }
  };
  const std::vector<Block>& blocks() const { return blocks_; }

  const Lives* lives() const { return lives_.get(); }  ///< none: a plan of other runs
  bool isOfArms() const { return arm_.has_value(); }
  std::string jointName(std::size_t joint) const { return arm_ ? arm_->jointName(joint) : std::string(); }

  /// Paths of all that varies, in the order of the plan.
  std::vector<std::string> variableNames() const;

  /// Everything the runs depend on, as one document.
  OrderedJson snapshot() const;

private:
  void collect(const PlanNode& node, std::vector<const Variable*>& into);
  void makeBlocks();
  void addBlock(const PlanNode::Entry& fault_class, const PlanNode& duty);
  std::uint64_t readDrives();
  void makeLives();
  PlanValues valuesOf(const Block& block, std::uint64_t number, RunSpec& spec) const;
  Lives::Labels labelsOf(std::uint64_t number) const;
  ParameterMap settingsOf(const PlanValues& values, std::uint64_t number) const;
  Parameters parametersOf(const ParameterMap& settings, bool faults_given) const;
  std::vector<RunFault> faultsOf(const PlanNode& list, const PlanValues& values) const;
  void takeDrive(const Block& block, const PlanValues& values, RunSpec& spec) const;
  void takeArm(const Block& block, const PlanValues& values, RunSpec& spec) const;
  void checkRates(const Parameters& parameters) const;

  std::string directory_;
  PlanNode root_;
  ParameterMap base_;
  std::string name_;
  std::uint32_t seed_{};
  std::uint64_t repeats_{};
  std::uint64_t runs_{};
  std::uint64_t period_{};  // runs of a drive, of a check-up of lives, or all
  Recording recording_;
  DutyReader duties_;
  std::unique_ptr<const Lives> lives_;
  std::optional<DriveSplit> split_;  // of a plan with drives
  std::optional<ArmPlan> arm_;
  std::vector<std::unique_ptr<const Variable>> variables_;
  std::vector<Block> blocks_;
  std::optional<Parameters> first_;  // of the first run, if there is no error in it
};
}  // namespace hjt
