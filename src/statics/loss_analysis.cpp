// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/statics/loss_analysis.hpp"

#include <algorithm>
#include <cmath>

#include "base/range.hpp"
#include "gear/ratio.hpp"
#include "statics/static_solver.hpp"

namespace hjt
{
namespace
{
/// Computes the friction of the joint over one tooth pitch of the wave generator.
class LossMeter
{
public:
  LossMeter(const Parameters& parameters, int positions)
    : walk_(parameters, positions)
    , friction_(parameters.gear.teeth_flexspline)
    , temperature_(parameters.input.temperature)
  {
  }

  PitchWalk& walk() { return walk_; }
  const SolveStatus& status() const { return walk_.status(); }

  /// Each kind of friction at the current position of the walk, as a torque at the motor [N.m].
  LossShares shares(double speed, double velocity_ratio)
  {
    const Eigen::Vector2d rates(1.0, velocity_ratio);  // speeds of motor and output over the motor's speed
    const JointModel& model = walk_.model();
    const RingEquilibrium& ring = walk_.ring();
    const RingRates by_angle{ ring.shape(), ring.byWaveGenerator(), ring.byOutput() };
    const auto& contact = ring.forces().of<WaveGeneratorContact>();
    friction_.running = by_angle.by_motor + velocity_ratio * by_angle.by_output;
    LossShares shares;
    shares.bearing = model.bearing.torque(speed, contact.force.sum(), temperature_);
    shares.interface = model.interface_friction.torque(ring.shape(), contact, friction_.running);
    shares.flexing = model.flexing_loss.torque(ring.shape(), ring.forces().of<RimBending>(), friction_.running);
    shares.output = model.load.dryFriction() * std::abs(velocity_ratio);
    shares.motor = model.motor.dryTorque(speed) + model.motor.viscousFriction() * std::abs(speed) +
                   model.load.viscousFriction() * velocity_ratio * velocity_ratio * std::abs(speed);
    friction_.setZero();
    model.mesh_friction.addTerms(model.ring.of<ToothMesh>(), ring.forces().of<ToothMesh>(), by_angle, speed * rates,
                                 friction_);
    shares.mesh = friction_.dryPower(rates);
    friction_.setZero();
    model.cup_friction.addTerm(by_angle.meanRotation(), friction_);
    shares.cup = friction_.dryPower(rates);
    model.damping.add(contact, by_angle, friction_);
    shares.damping = rates.dot(friction_.viscous * rates) * std::abs(speed);
    return shares;
  }

private:
  PitchWalk walk_;
  JointFriction friction_;
  double temperature_;
};

/// Largest friction of the gear over a tooth pitch at the start of motion, as a torque at the wave generator [N.m].
double breakaway(LossMeter& meter, double load)
{
  double largest = 0.0;
  meter.walk().under(
      load, [&](double velocity_ratio) { largest = std::max(largest, meter.shares(0.0, velocity_ratio).gear()); });
  return largest;
}
}  // namespace

std::vector<LossRow> analyseLosses(const Parameters& parameters, const std::vector<double>& speeds,
                                   const std::vector<double>& loads, int positions,
                                   const std::function<void(int)>& progress)
{
  requireAtLeast("positions", positions, 1);
  LossMeter meter(parameters, positions);
  std::vector<LossRow> rows;
  int done = 0;
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
    meter.walk().under(load,
                       [&](double velocity_ratio)
                       {
                         for (std::size_t i = first; i < rows.size(); ++i)
                         {
                           const LossShares at = meter.shares(rows[i].motor_speed, velocity_ratio);
                           LossShares& mean = rows[i].loss;
                           mean.bearing += part * at.bearing;
                           mean.interface += part * at.interface;
                           mean.flexing += part * at.flexing;
                           mean.mesh += part * at.mesh;
                           mean.cup += part * at.cup;
                           mean.damping += part * at.damping;
                           mean.output += part * at.output;
                           mean.motor += part * at.motor;
                           rows[i].load_reduced += part * load * velocity_ratio;
                         }
                       });
    for (std::size_t i = first; i < rows.size(); ++i)
    {
      rows[i].status = meter.status();
      const double asked = std::abs(rows[i].load_reduced);
      rows[i].gear_efficiency = asked > 0.0 ? asked / (asked + rows[i].loss.gear()) : 0.0;
    }
    if (progress)
    {
      progress(++done);
    }
  }
  return rows;
}

Breakaway analyseBreakaway(const Parameters& parameters, int positions)
{
  requireAtLeast("positions", positions, 1);
  constexpr int MAX_ITERATIONS = 30;
  constexpr double ENOUGH = 1e-6;  // relative change of the load below which the iteration ends
  LossMeter meter(parameters, positions);
  Breakaway result;
  result.starting = breakaway(meter, 0.0);
  // Iterates to the largest load that the friction holds, and converges, because friction grows slowly with the load.
  const double ratio = nominalRatio(parameters.gear);
  double load = ratio * result.starting;
  double change = load;
  for (int i = 0; i < MAX_ITERATIONS && meter.status().ok() && std::abs(change) > ENOUGH * load; ++i)
  {
    change = ratio * breakaway(meter, load) - load;
    load += change;
  }
  result.back_driving = load;
  result.status = meter.status();
  if (result.status.ok() && std::abs(change) > ENOUGH * load)
  {
    result.status.code = SolveCode::UNBALANCED;
    result.status.stage = SolveStage::BALANCE;
    result.status.unbalanced_torque = change;
  }
  return result;
}
}  // namespace hjt
