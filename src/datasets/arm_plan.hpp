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
/// Specification of a run in which a whole arm moves along set points.
struct ArmSpec
{
  ArmDescription arm;
  std::vector<Parameters> drives;
  std::shared_ptr<const std::vector<ArmSetPoint>> motion;

  double motionLength() const { return motion->back().time - motion->front().time; }  ///< length of the motion [s]
};

/// A fault in the drive of a joint. `joint`: number of the joint from the base on; 0 in a plan of one drive.
struct RunFault : GrowingFault
{
  std::size_t joint{};
};

/// Replaces all faults in a drive's configuration by those of `faults` that belong to the drive of this joint.
void setFaults(const std::vector<RunFault>& faults, std::size_t joint, const std::string& origin, ParameterMap& map);

/// Faults in a drive's configuration, as faults of this joint.
std::vector<RunFault> configuredFaults(const Parameters& drive, std::size_t joint);

/// The part of a plan that a whole arm needs, under the key `arm`. All members throw ParameterError, or InputError with
/// file, line, key, value, unit and range.
class ArmPlan
{
public:
  /// `root`: root node of the plan; `directory`: the plan's directory; `options`: configuration of all drives.
  ArmPlan(const PlanNode& root, const std::string& directory, const ConfigurationOptions& options);

  /// Number of the joint that the fault names by its name or short name.
  std::size_t jointOf(const PlanNode& fault, const PlanValues& values) const;
  const std::string& jointName(std::size_t joint) const { return arm_.joints[joint].short_name; }

  /// `settings`: changes of each drive's configuration. `faults` replace the configured faults, unless null.
  ArmSpec read(const PlanNode& duty, const PlanValues& values, const ParameterMap& settings,
               const std::vector<RunFault>* faults, const std::string& faults_origin) const;

  /// Arm and configuration of its drives. The runs depend on both and on the plan.
  OrderedJson configuration() const;
  OrderedJson motions() const;  ///< hash of each motion, by the name of its file

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
