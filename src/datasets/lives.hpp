// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "datasets/drive_split.hpp"
#include "datasets/plan_node.hpp"
#include "output/ordered_json.hpp"

#include "life/drive_ageing.hpp"
#include "twin/growing_fault.hpp"

namespace hjt
{
/// Lives of drives of different nature, from new to the end of their use, with a check-up every so many hours: the
/// plan's mapping `lives`. A check-up is numbered life by life. After construction all members may be called from any
/// thread.
class Lives
{
public:
  using Labels = std::vector<std::pair<std::string, ParameterValue>>;

  /// `nominal`: the drive whose tooth model the laws of ageing use; `directory`: where the plan lies. Takes seconds.
  /// @throws InputError, ParameterError.
  Lives(const PlanNode& node, const Parameters& nominal, const std::string& directory, std::uint32_t seed);

  std::uint64_t checkUps() const { return check_ups_.size(); }
  std::uint64_t driveAt(std::uint64_t check_up) const { return check_ups_[check_up].drive; }

  /// The wear that the drive has then.
  std::vector<GrowingFault> faultsAt(std::uint64_t check_up) const;

  /// True state of the drive at that time.
  Labels labelsAt(std::uint64_t check_up) const;
  static std::vector<std::string> labelNames();

  /// The duty cycles, for the plan's document.
  OrderedJson duties() const;

private:
  struct Drive
  {
    UnitVariation variation;
    std::size_t duty{};
    Fault spall;  // kind and place of its bearing's
    int crack_place{};
    DriveAgeing::Life life;
  };
  struct CheckUp
  {
    std::uint64_t drive{};
    double hours{};
    DriveAge age;
    double stress{};  // largest amplitude of the duty cycle, at the notch, without mean [Pa]
  };
  void readDuties(const PlanNode& files, const std::string& directory);
  double stressAt(const RevolutionLoadMap& load_map, const DutyCycle& duty, const DriveAge& age) const;

  DriveSplit split_;
  FatigueLaw fatigue_law_;
  FaultScaleParameters fault_scale_;
  double rim_thickness_;  // [m]
  double grease_severity_{};
  std::vector<std::pair<std::string, DutyCycle>> duties_;
  std::vector<Drive> drives_;
  std::vector<CheckUp> check_ups_;
};
}  // namespace hjt
