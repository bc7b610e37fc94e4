// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

#include "datasets/plan_node.hpp"
#include "datasets/plan_values.hpp"

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
}  // namespace hjt
