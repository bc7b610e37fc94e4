// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <map>

#include "life/ageing_laws.hpp"
#include "life/drive_age.hpp"
#include "life/duty_cycle.hpp"
#include "life/revolution_load_analysis.hpp"
#include "model/faults/joint_faults.hpp"

namespace hjt
{
/// The bridge between seconds and years: what turning under a load does to the drive, measured on the tooth model at
/// some stages of wear, bilinear between them.
class RevolutionLoadMap
{
public:
  /// `positions`: wave generator angles per tooth pitch.
  RevolutionLoadMap(const Parameters& parameters, int positions);

  /// Solves the tooth model at every stage for the loads it does not know yet (some seconds).
  /// @throws ParameterError where the ring has no equilibrium.
  void cover(const DutyCycle& duty, const std::function<void(double)>& progress);

  /// Under a load that is covered [N.m], at a stage of wear [m]. Wear beyond its limits counts as wear at the limits.
  RevolutionLoad at(double load_torque, double flank_wear, double interface_wear) const;

  /// Largest difference to the tooth model itself in the middle of all cells, over the largest value of the same
  /// quantity under any load [-]. Slow.
  double largestError() const;

private:
  static constexpr int STAGES = 4;  // of each kind of wear, the new drive and the limit included
  using Stages = std::array<std::array<RevolutionLoad, STAGES>, STAGES>;  // by flank, by interface

  RevolutionLoadAnalysis analysisOf(const DriveAge& age) const;

  JointFaults joint_;
  FaultList faults_at_start_;
  FaultScaleParameters fault_scale_;
  SolverParameters solver_;
  FlexsplineStress stress_;
  RaceCreep creep_;
  int positions_;
  double flank_step_;               // [m]
  double interface_step_;           // [m]
  std::map<double, Stages> nodes_;  // by load
};
}  // namespace hjt
