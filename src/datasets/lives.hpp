// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "datasets/plan_values.hpp"
#include "life/drive_ageing.hpp"
#include "output/ordered_json.hpp"
#include "twin/growing_fault.hpp"

namespace hjt
{
/// Divides the drives of a plan into drives for training and drives for the test, which are spread evenly over the
/// numbers of the drives. Whether a drive is for the test does not depend on how many drives the plan has.
class DriveSplit
{
public:
  static constexpr double MAX_DRIVES = 1e6;  ///< largest number of drives in a plan

  // Names of the columns in index.csv.
  static constexpr const char* DRIVE = "drive";  ///< column with the number of the drive
  static constexpr const char* SPLIT = "split";  ///< column with "train" or "test"

  /// `drives`: node of the plan that may have the key `test`, the share of test drives. @throws InputError.
  explicit DriveSplit(const PlanNode& drives) : test_(PlanValues().number(drives, "test", "-", { 0.0, 1.0 }, SHARE)) {}

  double share() const { return test_; }
  std::uint64_t testsOf(std::uint64_t drives) const  ///< number of test drives among the first `drives`
  {
    constexpr double ROUNDING = 1e-9;  // tolerance for the rounding of the product
    return static_cast<std::uint64_t>(std::floor(static_cast<double>(drives) * test_ + ROUNDING));
  }
  const char* nameOf(std::uint64_t drive) const { return testsOf(drive + 1) > testsOf(drive) ? "test" : "train"; }

private:
  static constexpr double SHARE = 0.25;  // default share of test drives [-]

  double test_;
};

/// Lives of different drives from new to the end of their use, with check-ups at equal intervals of use, as the plan's
/// mapping `lives` describes them. Check-ups are numbered life by life. All const members are thread-safe.
class Lives
{
public:
  using Labels = std::vector<std::pair<std::string, ParameterValue>>;

  /// `nominal`: drive whose tooth model the laws of ageing use; `directory`: directory of the plan. The construction
  /// takes several seconds. @throws InputError, ParameterError.
  Lives(const PlanNode& node, const Parameters& nominal, const std::string& directory, std::uint32_t seed);

  std::uint64_t checkUps() const { return check_ups_.size(); }
  std::uint64_t driveAt(std::uint64_t check_up) const { return check_ups_[check_up].drive; }

  /// Faults that stand for the wear of the drive at a check-up.
  std::vector<GrowingFault> faultsAt(std::uint64_t check_up) const;

  /// True state of the drive at a check-up, as labels for the index.
  Labels labelsAt(std::uint64_t check_up) const;
  static std::vector<std::string> labelNames();

  /// The phases of all duty cycles, for the document of the plan.
  OrderedJson duties() const;

private:
  struct Drive
  {
    UnitVariation variation;
    std::size_t duty{};
    Fault spall;  // kind and place of the bearing's first spall
    int crack_place{};
    DriveAgeing::Life life;
  };
  struct CheckUp
  {
    std::uint64_t drive{};
    double hours{};
    DriveAge age;
    double stress{};  // largest stress amplitude during the duty cycle at the notch, converted to zero mean stress [Pa]
  };
  void readDuties(const PlanNode& files, const std::string& directory);
  double stressAt(const RevolutionLoadMap& load_map, const DutyCycle& duty, const DriveAge& age) const;

  DriveSplit split_;
  FatigueLaw fatigue_law_;
  FaultScaleParameters fault_scale_;
  double rim_thickness_;  // thickness of the rim [m]
  double grease_severity_{};
  std::vector<std::pair<std::string, DutyCycle>> duties_;
  std::vector<Drive> drives_;
  std::vector<CheckUp> check_ups_;
};
}  // namespace hjt
