// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/statics/torsion_loop.hpp"

#include "base/range.hpp"
#include "model/faults/joint_faults.hpp"
#include "solver/ring_equilibrium.hpp"
#include "statics/static_solver.hpp"

namespace hjt
{
namespace
{
/// @throws InputError if the value is not positive.
void requirePositive(const char* name, double value)
{
  if (!(value > 0.0))
  {
    throw InputError(std::string(name) + " = " + numberText(value) + " [N.m] is out of range, allowed: > 0");
  }
}

/// Angle at which a polyline, with points in ascending order of torque, has the torque `torque` [rad].
double angleAt(const std::vector<TorsionPoint>& sweep, double torque)
{
  for (std::size_t i = 1; i < sweep.size(); ++i)
  {
    const TorsionPoint& a = sweep[i - 1];
    const TorsionPoint& b = sweep[i];
    if (torque <= b.torque)
    {
      return a.output_angle + (b.output_angle - a.output_angle) * (torque - a.torque) / (b.torque - a.torque);
    }
  }
  return sweep.back().output_angle;
}
/// Adds the friction of the cup's springs and sliders to the torques of the loop. The course begins at rest without
/// load. `rotations`: by point, rotation of the rim [rad] and derivative of this rotation by the output angle [-].
void addCupFriction(const CupFriction& friction, double unloaded_rotation,
                    const std::vector<Eigen::Vector2d>& rotations, std::vector<TorsionPoint>& up,
                    std::vector<TorsionPoint>& down)
{
  if (!friction.hasState())
  {
    return;
  }
  CupFriction::State cup = friction.relaxed(unloaded_rotation);
  const auto add = [&](std::size_t i, TorsionPoint& point)
  {
    cup = friction.turned(cup, rotations[i][0]);
    point.torque -= cup.torque * rotations[i][1];
  };
  for (std::size_t i = 0; i < up.size(); ++i)
  {
    add(i, up[i]);
  }
  for (std::size_t i = down.size(); i-- > 0;)
  {
    add(i, down[i]);
  }
}
}  // namespace

TorsionLoop analyseTorsionLoop(const Parameters& parameters, double amplitude, double lost_motion_torque, int steps)
{
  requirePositive("amplitude", amplitude);
  requirePositive("lost_motion_torque", lost_motion_torque);
  if (lost_motion_torque > amplitude)
  {
    throw InputError("lost_motion_torque = " + numberText(lost_motion_torque) +
                     " [N.m] is out of range, allowed: 0 ... " + numberText(amplitude) + " (amplitude)");
  }
  requireAtLeast("steps", steps, 2);
  const JointModel model = startingJoint(parameters);
  RingEquilibrium ring(model.ring, staticSolver(parameters.solver));
  JointFriction friction(parameters.gear.teeth_flexspline);
  TorsionLoop loop;
  loop.status = insertUnderLoad(ring, 0.0, 0.0);
  const double unloaded = ring.position().output_angle;
  const double unloaded_rotation = ring.forces().of<CupTorsion>().rotation;
  std::vector<TorsionPoint> up;    // points with increasing load
  std::vector<TorsionPoint> down;  // points with decreasing load
  std::vector<Eigen::Vector2d> rotations;
  for (int i = 0; i <= steps && loop.status.ok(); ++i)
  {
    const double elastic = amplitude * (2.0 * i / steps - 1.0);
    loop.status = balanceOutput(ring, 0.0, elastic);
    friction.setZero();
    const RingRates rates{ ring.shape(), ring.byWaveGenerator(), ring.byOutput() };
    model.mesh_friction.addTerms(model.ring.of<ToothMesh>(), ring.forces().of<ToothMesh>(), rates, { 0.0, 0.0 },
                                 friction);
    model.cup_friction.addTerm(rates.meanRotation(), friction);
    model.addOutput(friction);
    const double drag = friction.dryPower(Eigen::Vector2d::UnitY());
    const double angle = unloaded - ring.position().output_angle;
    up.push_back({ elastic + drag, angle });
    down.push_back({ elastic - drag, angle });
    rotations.push_back({ ring.forces().of<CupTorsion>().rotation, rates.meanRotation()[1] });
  }
  addCupFriction(model.cup_friction, unloaded_rotation, rotations, up, down);
  if (loop.status.ok())
  {
    loop.points.assign(down.rbegin(), down.rend());
    loop.points.insert(loop.points.end(), up.begin(), up.end());
    loop.hysteresis = angleAt(down, 0.0) - angleAt(up, 0.0);
    const auto middle = [&](double torque) { return 0.5 * (angleAt(up, torque) + angleAt(down, torque)); };
    loop.lost_motion = middle(lost_motion_torque) - middle(-lost_motion_torque);
  }
  return loop;
}
}  // namespace hjt
