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
/// Creep of the outer race of the wave generator's bearing in the rim, and the slip between race and rim.
///
/// The lobes press the race on the rim, and the race rolls in the rim. If the race were held, its surface would slip by
///   q_i = l psi_i' - r eps_i + f - g_i                  [m/rad, per wave generator angle]
/// where  l, psi_i'  contact.slip_lever [m]; rate of the chord's tilt at tooth i against the turning of the wave [-]
///        r, eps_i   bore radius [m]; strain of the rim at tooth i [-] (the race does not stretch)
///        f, g_i     raceFit; wear of rim and race at tooth i [m]
/// The race is free, because the friction of the balls on the race is a hundredth of the friction of the rim. The race
/// creeps at the rate c [m/rad] at which the friction forces cancel, which is the median of q_i with the normal forces
/// F_i as weights. The surfaces wear in proportion to sum F_i |q_i - c|.
class RaceCreep
{
public:
  explicit RaceCreep(const Parameters& parameters);

  /// Rates per angle of the wave generator.
  struct Rates
  {
    /// advance of the race in the rim in the direction of the wave generator; 0 without contact [m/rad]
    double advance{};
    double sliding{};  ///< sum of normal force times slip over the rim, for unit friction coefficient [N.m/rad]
  };

  /// `running`: 2 N derivatives of the ring's points by the motor angle [m/rad], while the output turns at the velocity
  /// ratio.
  Rates at(const RingEquilibrium& ring, const Eigen::VectorXd& running);

private:
  struct Slip
  {
    double rate;   // rate q_i of the slip at a tooth [m/rad]
    double force;  // normal force F_i at a tooth [N]
  };

  double lever_;        // lever of the slip [m]
  double radius_;       // bore radius [m]
  double fit_;          // fit of the race [m]
  double rest_length_;  // length of a segment at rest [m]
  std::vector<Slip> slips_;
};

/// Computes the loads of one turn of the wave generator for one drive with the tooth model.
class RevolutionLoadAnalysis
{
public:
  /// `positions`: number of wave generator angles in a tooth pitch, >= 1. @throws ParameterError if the parameters have
  /// no equilibrium.
  RevolutionLoadAnalysis(const Parameters& parameters, int positions)
    : RevolutionLoadAnalysis(startingJoint(parameters), parameters.solver, FlexsplineStress(parameters),
                             RaceCreep(parameters), positions)
  {
  }
  /// Analysis of `joint`, whose faults may differ from those in the parameters of `stress` and `creep`.
  RevolutionLoadAnalysis(const JointModel& joint, const SolverParameters& solver, const FlexsplineStress& stress,
                         const RaceCreep& creep, int positions);

  /// Loads of one turn of the wave generator under the load `load_torque` at the output [N.m].
  /// @throws ParameterError if the ring has no equilibrium.
  RevolutionLoad under(double load_torque);

private:
  int positions_;
  PitchWalk walk_;
  FlexsplineStress flexspline_stress_;
  ToothStress tooth_stress_;
  RaceCreep race_creep_;
  Eigen::VectorXd running_;  // derivatives of the tooth points by the wave generator angle [m/rad]
};

/// Loads of one turn as a function of load torque and wear. The tooth model computes the loads at STAGES stages of each
/// kind of wear. The interpolation between the stages is bilinear.
class RevolutionLoadMap
{
public:
  /// `positions`: number of wave generator angles in a tooth pitch.
  RevolutionLoadMap(const Parameters& parameters, int positions);

  /// Computes the missing loads of the duty cycle at every stage of wear, which takes some seconds.
  /// @throws ParameterError if the ring has no equilibrium.
  void cover(const DutyCycle& duty, const std::function<void(double)>& progress);

  /// Loads of one turn at a load torque [N.m] that `cover` computed, and at wear depths [m]. A depth above its limit
  /// counts as the limit.
  RevolutionLoad at(double load_torque, double flank_wear, double interface_wear) const;

  /// Largest error of the interpolated loads, compared with the tooth model halfway between stages, over the largest
  /// value of each quantity at any load [-]. The function is slow.
  double largestError() const;

private:
  static constexpr int STAGES = 4;  // stages of each kind of wear, from the new drive to the limit
  using Stages = std::array<std::array<RevolutionLoad, STAGES>, STAGES>;  // by flank wear, by interface wear

  RevolutionLoadAnalysis analysisOf(const DriveAge& age) const;

  JointFaults joint_;
  FaultList faults_at_start_;
  FaultScaleParameters fault_scale_;
  SolverParameters solver_;
  FlexsplineStress stress_;
  RaceCreep creep_;
  int positions_;
  double flank_step_;               // difference of flank wear between stages [m]
  double interface_step_;           // difference of interface wear between stages [m]
  std::map<double, Stages> nodes_;  // by load torque
};
}  // namespace hjt
