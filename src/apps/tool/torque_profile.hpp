// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harmonic_joint_twin/twin/twin.hpp"

namespace hjt
{
/// Inputs of a simulation: motor torque, load and brake over time, each held until the next entry.
class TorqueProfile
{
public:
  /// A constant torque from t = 0 on [N.m].
  static TorqueProfile constant(double motor_torque);

  /// CSV with columns time [s, from 0 on, ascending], motor_torque [N.m] and, if wanted, load_torque [N.m] and brake (0
  /// or 1). @throws InputError naming line and column.
  static TorqueProfile fromFile(const std::string& path);

  bool hasLoad() const { return has_load_; }
  void setLoad(double load_torque);  ///< at t = 0 [N.m]

  Stamp duration() const;  ///< up to the last entry [ns]

  /// Gives the twin, standing at its instant, what acts in its next step. `begin`: the instant of t = 0.
  void feed(Twin& twin, Stamp begin);

private:
  std::vector<Input> inputs_;  ///< stamps from t = 0 on
  std::size_t next_{};
  bool has_load_{};
  double motor_torque_{};
};
}  // namespace hjt
