// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "datasets/plan_values.hpp"
#include "output/ordered_json.hpp"

#include "arm/arm_description.hpp"
#include "arm/arm_motion.hpp"
#include "twin/growing_fault.hpp"
#include "twin/options.hpp"

namespace hjt
{
/// A run of a whole arm along set points.
struct ArmSpec
{
  ArmDescription arm;
  std::vector<Parameters> drives;
  std::shared_ptr<const std::vector<ArmSetPoint>> motion;

  double motionLength() const { return motion->back().time - motion->front().time; }  ///< [s]
};

/// A fault in a drive: of the joint of this number from the base on, in a plan of one drive 0.
struct RunFault : GrowingFault
{
  std::size_t joint{};
};

/// These faults in place of any other.
void setFaults(const std::vector<RunFault>& faults, std::size_t joint, const std::string& origin, ParameterMap& map);

/// The faults that a drive's configuration holds.
std::vector<RunFault> configuredFaults(const Parameters& drive, std::size_t joint);

/// Part of a plan with the key `arm` that a plan of drives lacks. All members throw InputError that names
/// file, line, key, value, unit and range, or ParameterError.
class ArmPlan
{
public:
  /// `root`: the plan; `directory`: where it lies. `options`: configuration of all drives.
  ArmPlan(const PlanNode& root, const std::string& directory, const ConfigurationOptions& options);

  /// Number of a joint by its name or short name that the fault gives.
  std::size_t jointOf(const PlanNode& fault, const PlanValues& values) const;
  const std::string& jointName(std::size_t joint) const { return arm_.joints[joint].short_name; }

  /// `settings`: over each drive's configuration. `faults`: in place of the configured ones; none: those stay.
  ArmSpec read(const PlanNode& duty, const PlanValues& values, const ParameterMap& settings,
               const std::vector<RunFault>* faults, const std::string& faults_origin) const;

  /// Inputs of the runs besides the plan.
  OrderedJson configuration() const;
  OrderedJson motions() const;  ///< by their files, a hash each

private:
  struct Motion
  {
    std::shared_ptr<const std::vector<ArmSetPoint>> points;
    std::string hash;
  };

  ArmDescription arm_;
  std::string arm_text_;
  std::vector<ParameterMap> drives_;
  std::map<std::string, Motion> motions_;
};
}  // namespace hjt
