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
/// Specification of a run of a whole arm along set points.
struct ArmSpec
{
  ArmDescription arm;
  std::vector<Parameters> drives;
  std::shared_ptr<const std::vector<ArmSetPoint>> motion;

  double motionLength() const { return motion->back().time - motion->front().time; }  ///< [s]
};

/// A fault in a drive. `joint`: number of the joint from the base; 0 in a plan of one drive.
struct RunFault : GrowingFault
{
  std::size_t joint{};
};

/// Replaces all faults of a drive's configuration by these.
void setFaults(const std::vector<RunFault>& faults, std::size_t joint, const std::string& origin, ParameterMap& map);

/// Faults of a drive's configuration.
std::vector<RunFault> configuredFaults(const Parameters& drive, std::size_t joint);

/// Additional part of a plan with the key `arm`. All members throw ParameterError, or InputError with file, line, key,
/// value, unit and range.
class ArmPlan
{
public:
  /// `root`: the plan; `directory`: its directory; `options`: configuration of all drives.
  ArmPlan(const PlanNode& root, const std::string& directory, const ConfigurationOptions& options);

  /// Number of the joint whose name or short name the fault gives.
  std::size_t jointOf(const PlanNode& fault, const PlanValues& values) const;
  const std::string& jointName(std::size_t joint) const { return arm_.joints[joint].short_name; }

  /// `settings`: changes of each drive's configuration. `faults` replace the configured ones; null: those stay.
  ArmSpec read(const PlanNode& duty, const PlanValues& values, const ParameterMap& settings,
               const std::vector<RunFault>* faults, const std::string& faults_origin) const;

  /// Inputs of the runs that are not in the plan.
  OrderedJson configuration() const;
  OrderedJson motions() const;  ///< hash of each motion by its file

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
