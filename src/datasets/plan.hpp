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
/// Complete specification of a run, one simulation of a plan.
struct RunSpec
{
  std::uint64_t run{};
  std::string fault_class;
  std::string duty_name;
  std::uint64_t repeat{};
  double duration{};      ///< simulated time of the run [s]
  Parameters parameters;  ///< parameters of the drive, or of an arm's first drive; steps approximate growing faults
  std::vector<RunFault> faults;
  RunDuty duty;
  std::optional<ArmSpec> arm;  ///< arm and its motion, only in a plan of whole arms
  /// Path of each variable in the plan, and its value in this run.
  std::vector<std::pair<std::string, ParameterValue>> variables;
};

/// A plan of simulations with constant values, grids and random draws.
///
/// Runs are numbered by class, then by duty cycle, then by grid with the last grid fastest, then by repeat. In a plan
/// with `drives`, they are numbered by drive first. In a plan of lives, they are numbered by life, check-up and duty
/// cycle, and `set` is drawn for each drive. In a plan of whole arms, the duty cycles are motions, and `set` applies to
/// all drives. All const members are thread-safe.
class Plan
{
public:
  /// `options`: configuration that the plan's settings change. @throws InputError that names file and line.
  Plan(const std::string& path, const ConfigurationOptions& options);
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;

  const std::string& name() const { return name_; }
  std::uint64_t runs() const { return runs_; }
  const Recording& recording() const { return recording_; }

  /// Specification of a run. @throws InputError with file, line, key, value, unit and range.
  RunSpec run(std::uint64_t number) const;

  /// The runs of a plan that have the same class and duty cycle. Each period, of period_ runs, has some of these runs.
  struct Block
  {
    const PlanNode::Entry* fault_class;
    const PlanNode* duty;
    std::vector<const Variable*> variables;
    std::uint64_t first;     ///< number of the block's first run
    std::uint64_t together;  ///< number of successive runs of the block in each period
    std::uint64_t period{};  ///< number of runs from one period of the plan to the next
    std::uint64_t size{};    ///< number of runs of the block in all periods

    std::uint64_t run(std::uint64_t i) const { return first + i / together * period + i % together; }
  };
  const std::vector<Block>& blocks() const { return blocks_; }

  const Lives* lives() const { return lives_.get(); }  ///< null unless the plan is one of lives
  bool isOfArms() const { return arm_.has_value(); }
  std::string jointName(std::size_t joint) const { return arm_ ? arm_->jointName(joint) : std::string(); }

  /// Paths of all variables, in the order of the plan's file.
  std::vector<std::string> variableNames() const;

  /// JSON document with all data that the runs depend on.
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
  std::uint64_t period_{};  // number of runs of each drive, of each check-up of a life, or of the plan
  Recording recording_;
  DutyReader duties_;
  std::unique_ptr<const Lives> lives_;
  std::optional<DriveSplit> split_;  // only in a plan with drives
  std::optional<ArmPlan> arm_;
  std::vector<std::unique_ptr<const Variable>> variables_;
  std::vector<Block> blocks_;
  std::optional<Parameters> first_;  // parameters of the first run, if they are valid
};
}  // namespace hjt
