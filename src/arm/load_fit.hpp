// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "arm/arm_description.hpp"
#include "arm/found_load.hpp"
#include "arm/load_problem.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// Payload and mounting of an arm from the currents of all joints while they move, by least squares.
///
///   residual_i = (Y_i . x + e_i (load_i + Y_i . x)) / gain_i + s a_i + b_i v + o_i
/// with x mass and moments of a payload, or the change of gravity, Y_i the torque of their units at joint i (rigid-body
/// dynamics), and for each joint nuisances (LoadProblem). Each row of the fit is the mean over 0.1 s of one joint that
/// moves one way. The interval of the mass holds the fit's and 2 % of the links' own masses. The payload is of rows in
/// which nothing touches the arm, where it does not change; the mounting of all, since another one looks like contact.
///
/// A payload that is picked up or put down: where two parts of the time, each with terms of its own, show masses whose
/// difference is one that would be named, and leave clearly less, the time is parted there, and each part likewise.
class LoadFit
{
public:
  static constexpr double MOST_TIME = 600.0;  ///< of motion; what comes later does not count [s]

  /// @param gains of each joint, from the base on [N.m/A]
  LoadFit(const ArmDescription& arm, std::vector<double> gains);
  ~LoadFit();
  LoadFit(const LoadFit&) = delete;
  LoadFit& operator=(const LoadFit&) = delete;

  /// Samples of one time, and the current that each joint's twin predicts [A]. `touched`: something touches the arm.
  void add(const std::vector<MotionSample>& samples, const std::vector<double>& predicted, bool touched = false);

  /// Of the time, where the payload changes in it.
  enum class Part
  {
    LONGEST,
    LAST
  };
  /// `counts`: whether the current of a joint, by its number, is measured: else it is left out.
  FoundLoad solve(const std::vector<bool>& counts, Part part);
  /// How well the arm explains the currents of the joints that count, with its best payload, or the best mounting too.
  /// @param size of all currents, as a multiple of what they are taken for [-]
  LoadProblem::Fit explained(const std::vector<bool>& counts, double size = 1.0);
  double moved() const;  ///< time in which a joint moved [s]

private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// The same of whole recordings.
/// @param samples of each joint, from the base on, of the same times. @param predicted current of each [A]
/// @param gains [N.m/A]
IdentifiedPayload identifyPayload(const ArmDescription& arm, const std::vector<std::vector<MotionSample>>& samples,
                                  const std::vector<std::vector<double>>& predicted, const std::vector<double>& gains);
}  // namespace hjt
