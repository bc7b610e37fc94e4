// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <map>
#include <vector>

#include <Eigen/Core>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "life/ageing_laws.hpp"
#include "life/duty_cycle.hpp"
#include "model/faults/joint_faults.hpp"
#include "solver/ring_equilibrium.hpp"
#include "statics/flexspline_stress.hpp"
#include "statics/static_solver.hpp"

namespace hjt
{
/// How the outer race of the wave generator's bearing creeps round in the rim, and how far the two slip as it does.
///
/// The race rolls in the rim, pressed on at the lobes. Held, its surface would slip there at
///   q_i = l psi_i' - r eps_i + f - g_i                  [m/rad, by the wave generator's angle]
/// where  l      contact.slip_lever; psi_i' rate at which the chord at tooth i tilts, against the wave's turning [-]
///        r, eps_i  bore radius [m]; strain of the rim there [-]: the race does not stretch
///        f, g_i  raceFit; worn off rim and race [m]
/// Nothing holds it: the friction of the balls on it is a hundredth of that on the rim. It creeps at the rate c at
/// which friction loses least, where the forces of friction cancel: the median of q_i weighted by the normal forces.
/// Two surfaces that roll wear by sum F_i |q_i - c|, whatever c is.
class RaceCreep
{
public:
  explicit RaceCreep(const Parameters& parameters);

  /// By the wave generator's angle.
  struct Rates
  {
    double advance{};  ///< of the race's surface in the rim, the wave generator's way; 0 without contact [m/rad]
    double sliding{};  ///< normal force times slip, of the whole rim; friction coefficient left out [N.m/rad]
  };

  /// `running`: 2 N, rates of the ring's points by the motor angle, the output following [m/rad].
  Rates at(const RingEquilibrium& ring, const Eigen::VectorXd& running);

private:
  struct Slip
  {
    double rate;   // [m/rad]
    double force;  // [N]
  };

  double lever_;        // [m]
  double radius_;       // [m]
  double fit_;          // [m]
  double rest_length_;  // of a segment [m]
  std::vector<Slip> slips_;
};

/// Measures on the tooth model what turning does to the drive. One drive, any number of loads.
class RevolutionLoadAnalysis
{
public:
  /// `positions`: wave generator angles per tooth pitch, >= 1. @throws ParameterError if the parameters have no
  /// equilibrium.
  RevolutionLoadAnalysis(const Parameters& parameters, int positions)
    : RevolutionLoadAnalysis(startingJoint(parameters), parameters.solver, FlexsplineStress(parameters),
                             RaceCreep(parameters), positions)
  {
  }
  /// The same of a joint of that drive with other faults.
  RevolutionLoadAnalysis(const JointModel& joint, const SolverParameters& solver, const FlexsplineStress& stress,
                         const RaceCreep& creep, int positions);

  /// One turn of the wave generator under `load_torque` [N.m].
  /// @throws ParameterError if the ring finds no equilibrium under it.
  RevolutionLoad under(double load_torque);

private:
  int positions_;
  PitchWalk walk_;
  FlexsplineStress flexspline_stress_;
  ToothStress tooth_stress_;
  RaceCreep race_creep_;
  Eigen::VectorXd running_;  // of the teeth, by the wave generator's angle
};

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
