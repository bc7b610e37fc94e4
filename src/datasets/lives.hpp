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
/// Which drives of a plan are for the test of what others taught, evenly among their numbers: more drives leave it to
/// the first ones what they were.
class DriveSplit
{
public:
  static constexpr double MAX_DRIVES = 1e6;  ///< of a plan

  // Columns of the index.
  static constexpr const char* DRIVE = "drive";  ///< number
  static constexpr const char* SPLIT = "split";  ///< name

  /// `drives`: mapping of the plan that may have the key `test`, their share. @throws InputError.
  explicit DriveSplit(const PlanNode& drives) : test_(PlanValues().number(drives, "test", "-", { 0.0, 1.0 }, SHARE)) {}

  double share() const { return test_; }
  std::uint64_t testsOf(std::uint64_t drives) const  ///< among the first so many
  {
    constexpr double ROUNDING = 1e-9;  // of the product
    return static_cast<std::uint64_t>(std::floor(static_cast<double>(drives) * test_ + ROUNDING));
  }
  const char* nameOf(std::uint64_t drive) const { return testsOf(drive + 1) > testsOf(drive) ? "test" : "train"; }

private:
  static constexpr double SHARE = 0.25;  // where none is given [-]

  double test_;
};

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
