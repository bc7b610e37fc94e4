// SPDX-License-Identifier: BSD-3-Clause
#include "studies/state_invariants.hpp"

#include <algorithm>
#include <cmath>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "solver/cyclic_solver.hpp"
#include "solver/output_balance.hpp"
#include "statics/static_solver.hpp"

namespace hjt
{
namespace
{
/// `there` against `here` turned by `pitches` tooth pitches, tooth i taking the place of tooth i + pitches.
RingDifference renumberedDifference(const RingEquilibrium& here, const RingEquilibrium& there, int pitches)
{
  const int teeth = here.shape().teeth();
  const double angle = pitches * here.model().rest.pitchAngle();
  Eigen::Matrix2d turn;
  turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  RingDifference difference;
  for (int i = 0; i < teeth; ++i)
  {
    const int j = ((i + pitches) % teeth + teeth) % teeth;
    const Eigen::Vector2d expected = turn * here.shape().points.segment<2>(2 * i);
    const auto off = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) { return std::abs(a[i] - b[j]); };
    difference.position = std::max(difference.position, (expected - there.shape().points.segment<2>(2 * j)).norm());
    difference.contact_force = std::max(difference.contact_force, off(here.forces().of<WaveGeneratorContact>().force,
                                                                      there.forces().of<WaveGeneratorContact>().force));
    difference.flank_force = std::max(difference.flank_force, off(here.forces().of<ToothMesh>().flank_force,
                                                                  there.forces().of<ToothMesh>().flank_force));
  }
  return difference;
}

/// Smallest eigenvalue of the tangent, by inverse iteration [N/m].
double softestStiffness(const RingEquilibrium& ring)
{
  constexpr int ITERATIONS = 100;
  const RingShape shape = ring.shape().whole();
  const int teeth = shape.teeth();
  RingForces forces(teeth);
  ring.model().forces(shape, ring.position(), forces);
  RingTangent tangent(teeth);
  ring.model().tangent(shape, forces, tangent);
  CyclicSolver solver(teeth);
  if (!solver.factor(tangent))
  {
    return 0.0;
  }
  // No eigenvector of a ring of equal teeth stands across a start without its symmetries.
  Eigen::VectorXd vector = Eigen::VectorXd::LinSpaced(2 * teeth, 1.0, 2.0);
  double compliance = 0.0;
  for (int i = 0; i < ITERATIONS; ++i)
  {
    vector.normalize();
    solver.solve<1>(vector);
    compliance = vector.norm();
  }
  return 1.0 / compliance;
}
}  // namespace

StateInvariants analyseState(const Parameters& parameters, double angle, double load, int pitches)
{
  const RingModel model(parameters);
  StateInvariants state;
  RingEquilibrium ring(model, staticSolver(parameters.solver));
  const SolveStatus status = insertUnderLoad(ring, angle, load);
  const DrivePosition& position = ring.position();
  const double pitch = model.rest.pitchAngle();
  const double output_shift = pitches * (pitch - TWO_PI / model.gear.teeth_circular_spline);
  RingEquilibrium shifted(model, staticSolver(parameters.solver));
  DrivePosition there = position;
  there.wave_generator_angle += pitches * pitch;
  there.output_angle += output_shift;
  // A way of its own: inserted without load, then the output alone turned.
  SolveStatus shifted_status = shifted.insert(
      { there.wave_generator_angle, there.wave_generator_angle / nominalRatio(model.gear), there.wave_amplitude });
  if (shifted_status.ok())
  {
    shifted_status = shifted.moveTo(there);
  }
  state.status = status.ok() ? shifted_status : status;
  state.load = load;
  state.wave_generator_angle = position.wave_generator_angle;
  state.output_angle = position.output_angle;
  state.energy = ring.forces().energy;
  state.residual =
      std::max(ring.forces().teeth.lpNorm<Eigen::Infinity>(), shifted.forces().teeth.lpNorm<Eigen::Infinity>());
  state.softest_stiffness = softestStiffness(ring);
  state.contact_force_max = ring.forces().of<WaveGeneratorContact>().force.maxCoeff();
  state.flank_force_max = ring.forces().of<ToothMesh>().flank_force.lpNorm<Eigen::Infinity>();
  state.half_turn = renumberedDifference(ring, ring, model.rest.teeth() / 2);
  state.pitch_shift = renumberedDifference(ring, shifted, pitches);
  state.pitch_shift_energy = shifted.forces().energy / ring.forces().energy - 1.0;
  state.wave_generator_torque = ring.forces().wave_generator_torque;
  state.output_torque = ring.forces().output_torque;
  state.cup_torque = model.of<CupTorsion>().torque(ring.forces().of<CupTorsion>().rotation);
  return state;
}

std::vector<PotentialRow> analysePotential(const Parameters& parameters, double angle, double load,
                                           const std::vector<double>& steps)
{
  const RingModel model(parameters);
  RingEquilibrium ring(model, staticSolver(parameters.solver));
  SolveStatus status = insertUnderLoad(ring, angle, load);
  const DrivePosition centre = ring.position();
  const Eigen::Vector2d torque(ring.forces().wave_generator_torque, ring.forces().output_torque);
  const double stiffness = ring.stiffness()(0, 1);

  struct Point
  {
    double energy;
    Eigen::Vector2d torque;  // on wave generator and output
  };
  const auto at = [&](double wave_generator_step, double output_step)
  {
    if (status.ok())
    {
      status = ring.moveTo({ centre.wave_generator_angle + wave_generator_step, centre.output_angle + output_step,
                             centre.wave_amplitude });
    }
    return Point{ ring.forces().energy, { ring.forces().wave_generator_torque, ring.forces().output_torque } };
  };
  std::vector<PotentialRow> rows;
  for (const double step : steps)
  {
    PotentialRow row;
    row.wave_generator_step = step;
    row.output_step = step / nominalRatio(model.gear);
    row.wave_generator_torque = torque[0];
    row.output_torque = torque[1];
    row.condensed_stiffness = stiffness;
    const Point ahead = at(step, 0.0);
    const Point behind = at(-step, 0.0);
    const Point output_ahead = at(0.0, row.output_step);
    const Point output_behind = at(0.0, -row.output_step);
    row.wave_generator_difference = (behind.energy - ahead.energy) / (2.0 * step) - torque[0];
    row.output_difference = (output_behind.energy - output_ahead.energy) / (2.0 * row.output_step) - torque[1];
    row.wave_generator_by_output = (output_ahead.torque[0] - output_behind.torque[0]) / (2.0 * row.output_step);
    row.output_by_wave_generator = (ahead.torque[1] - behind.torque[1]) / (2.0 * step);
    row.status = status;
    rows.push_back(row);
  }
  return rows;
}
}  // namespace hjt
