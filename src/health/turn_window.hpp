// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "harmonic_joint_twin/health/indicator.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// The torsion over the last turn of the motor: transmission ratio and kinematic error.
///
/// The torsion is kept at marks evenly spaced in the motor angle, 16 to a tooth of the flexspline (the error of a sound
/// gear repeats every tooth pitch), interpolated linearly between the two samples around each mark. The store holds
/// one turn, whatever the speed.
///
/// Coming back to the mark before the last one is a reversal and empties the store; less (up to 2 mrad with 200 teeth)
/// is a tremor about the same place and is not. Both indicators are valid once the store is full: after one turn and
/// one or two marks of travel in one direction since start or reversal.
class TurnWindow
{
public:
  explicit TurnWindow(const GearParameters& gear);

  void reset() noexcept;

  /// `torsion`: motor angle / nominal ratio - output angle [rad]. An angle beyond 1e15 marks, or none, empties the
  /// store.
  void update(double motor_angle, double torsion) noexcept;

  /// Motor travel over output travel, from the instant the motor stood exactly one turn behind until now [-].
  /// Also not valid if the output made no way: less than a millionth of the nominal.
  Indicator transmissionRatio() const noexcept;

  /// Peak to peak of the torsion at the marks of the last turn, after subtracting the straight line through the two
  /// ends of that turn [rad]. The line takes out a torsion that grows with a changing load, and, as the turn's ends
  /// are alike, leaves every error of a whole number of cycles a turn untouched; a line by least squares would not.
  Indicator kinematicError() const noexcept;

private:
  bool full() const noexcept { return count_ == torsions_.size(); }
  void keep(double place, double slope, std::int64_t marks) noexcept;
  double torsionAt(Eigen::Index marks_back) const noexcept;

  double nominal_ratio_;
  std::int64_t marks_per_turn_;
  double marks_per_radian_;

  // Places are motor angles in marks, mirrored so that they grow in the direction of travel.
  bool started_{};
  int direction_{ 1 };
  double place_{};              // of the last sample
  double torsion_{};            // of the last sample
  std::int64_t newest_mark_{};  // last mark reached
  Eigen::VectorXd torsions_;    // ring of one turn and one mark, both ends included
  Eigen::Index newest_{};
  Eigen::Index count_{};
};
}  // namespace hjt
