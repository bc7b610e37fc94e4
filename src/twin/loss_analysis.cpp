// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/twin/loss_analysis.hpp"

#include <algorithm>
#include <cmath>

#include "harmonic_joint_twin/gear/angle.hpp"
#include "harmonic_joint_twin/gear/ratio.hpp"
#include "harmonic_joint_twin/model/joint_model.hpp"
#include "harmonic_joint_twin/solver/output_balance.hpp"
#include "harmonic_joint_twin/solver/ring_equilibrium.hpp"
#include "harmonic_joint_twin/twin/static_solver.hpp"

namespace hjt
{
namespace
{
/// The joint led through one tooth pitch at constant load, its friction asked for at every position.
class LossMeter
{
public:
  LossMeter(const Parameters& parameters, int positions)
    : model_(parameters)
    , ring_(model_.ring, staticSolver(parameters.solver))
    , friction_(parameters.gear.teeth_flexspline)
    , running_(2 * parameters.gear.teeth_flexspline)
    , temperature_(parameters.input.temperature)
    , pitch_(TWO_PI / parameters.gear.teeth_flexspline)
    , positions_(positions)
    , status_(ring_.insert({ 0.0, 0.0, parameters.gear.wave_amplitude }))
  {
  }

  /// Calls `visit(output speed over motor speed)` with the ring in equilibrium at each position. On failure it stops.
  template <class Visit>
  void overPitch(double load, Visit&& visit)
  {
    for (int i = 0; i < positions_ && status_.ok(); ++i)
    {
      status_ = balanceOutput(ring_, pitch_ * i / positions_, load);
      if (status_.ok())
      {
        visit(ring_.follow());
      }
    }
  }

  /// What each friction takes at this position, per motor speed [N.m].
  LossShares shares(double speed, double follow)
  {
    const Eigen::Vector2d rates(1.0, follow);  // of both angles by the motor's
    const RingRates by_angle{ ring_.byWaveGenerator(), ring_.byOutput() };
    running_ = by_angle.by_motor + follow * by_angle.by_output;
    LossShares shares;
    shares.bearing = model_.bearing.torque(speed, ring_.forces().contact_force.sum(), temperature_);
    shares.interface = model_.interface_friction.torque(ring_.shape(), ring_.forces(), running_);
    shares.motor = model_.motor.coulombTorque() + model_.motor.viscousFriction() * std::abs(speed) +
                   model_.load.viscousFriction() * follow * follow * std::abs(speed);
    friction_.setZero();
    model_.mesh_friction.addTerms(model_.ring.mesh, ring_.shape(), ring_.forces(), by_angle, speed * rates, friction_);
    shares.mesh = friction_.dryPower(rates);
    friction_.setZero();
    model_.cup_friction.addTerm(ring_.shape(), by_angle, friction_);
    shares.cup = friction_.dryPower(rates);
    model_.damping.add(ring_.shape(), ring_.forces(), by_angle, friction_);
    shares.damping = rates.dot(friction_.viscous * rates) * std::abs(speed);
    return shares;
  }

  const SolveStatus& status() const { return status_; }

private:
  JointModel model_;
  RingEquilibrium ring_;
  JointFriction friction_;
  Eigen::VectorXd running_;
  double temperature_;
  double pitch_;
  int positions_;
  SolveStatus status_;
};

/// Friction of the gear at the wave generator as motion begins: the largest over a tooth pitch [N.m].
double breakaway(LossMeter& meter, double load)
{
  double largest = 0.0;
  meter.overPitch(load, [&](double follow) { largest = std::max(largest, meter.shares(0.0, follow).gear()); });
  return largest;
}
}  // namespace

std::vector<LossRow> analyseLosses(const Parameters& parameters, const std::vector<double>& speeds,
                                   const std::vector<double>& loads, int positions,
                                   const std::function<void(int)>& progress)
{
  LossMeter meter(parameters, positions);
  std::vector<LossRow> rows;
  for (const double load : loads)
  {
    const std::size_t first = rows.size();
    for (const double speed : speeds)
    {
      rows.emplace_back();
      rows.back().motor_speed = speed;
      rows.back().load_torque = load;
    }
    const double part = 1.0 / positions;
    meter.overPitch(load,
                    [&](double follow)
                    {
                      for (std::size_t i = first; i < rows.size(); ++i)
                      {
                        const LossShares at = meter.shares(rows[i].motor_speed, follow);
                        LossShares& mean = rows[i].loss;
                        mean.bearing += part * at.bearing;
                        mean.interface += part * at.interface;
                        mean.mesh += part * at.mesh;
                        mean.cup += part * at.cup;
                        mean.damping += part * at.damping;
                        mean.motor += part * at.motor;
                        rows[i].load_reduced += part * load * follow;
                      }
                    });
    for (std::size_t i = first; i < rows.size(); ++i)
    {
      rows[i].converged = meter.status().ok();
      rows[i].residual = meter.status().residual;
      const double asked = std::abs(rows[i].load_reduced);
      rows[i].gear_efficiency = asked > 0.0 ? asked / (asked + rows[i].loss.gear()) : 0.0;
    }
    if (progress)
    {
      progress(static_cast<int>(rows.size() / speeds.size()));
    }
  }
  return rows;
}

Breakaway analyseBreakaway(const Parameters& parameters, int positions)
{
  constexpr int MAX_ITERATIONS = 30;
  constexpr double ENOUGH = 1e-6;  // relative change of the load
  LossMeter meter(parameters, positions);
  Breakaway result;
  result.starting = breakaway(meter, 0.0);
  // The load that the friction just holds: friction grows slowly with the load, so repeating converges.
  const double ratio = nominalRatio(parameters.gear);
  double load = ratio * result.starting;
  for (int i = 0; i < MAX_ITERATIONS && !result.converged && meter.status().ok(); ++i)
  {
    const double next = ratio * breakaway(meter, load);
    result.converged = std::abs(next - load) <= ENOUGH * next;
    load = next;
  }
  result.back_driving = load;
  result.converged = result.converged && meter.status().ok();
  result.residual = meter.status().residual;
  return result;
}
}  // namespace hjt
