// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/statics/static_analysis.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <numeric>

#include "base/range.hpp"
#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "model/faults/joint_faults.hpp"
#include "solver/ring_equilibrium.hpp"
#include "statics/flexspline_stress.hpp"
#include "statics/static_solver.hpp"

namespace hjt
{
namespace
{
ToothTable tabulateTeeth(const RingEquilibrium& ring, const ToothStress& stress)
{
  ToothTable table;
  table.stress_tooth_space = stress.normal[0];
  table.stress_transition = stress.normal[1];
  table.stress_flange = stress.normal[2];
  const RingModel& model = ring.model();
  const RingShape& shape = ring.shape();
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const Eigen::Vector2d point = shape.points.segment<2>(2 * i);
    const Eigen::Vector2d rest = model.rest.radial().segment<2>(2 * i);
    table.tooth_x.push_back(point.x());
    table.tooth_y.push_back(point.y());
    table.radius.push_back(point.norm());
    table.angle_deviation.push_back(smallAngle(rest.x() * point.y() - rest.y() * point.x(), rest.dot(point)));
    table.wave_generator_force.push_back(ring.forces().of<WaveGeneratorContact>().force[i]);
    table.rim_tension.push_back(model.of<RimTension>().tension(shape, i));
    table.bending_force.push_back(model.of<RimBending>().bendingForce(shape, ring.forces().of<RimBending>(), i));
    table.mesh_force.push_back(ring.forces().of<ToothMesh>().flank_force[i]);
    const ToothPlace place = model.of<ToothMesh>().place(shape, ring.position(), i);
    table.across.push_back(place.across);
    table.depth.push_back(place.depth);
    table.tilt.push_back(place.tilt);
    table.gap.push_back(place.gap);
  }
  return table;
}

ToothStress stressOf(const RingEquilibrium& ring, const Parameters& parameters)
{
  ToothStress stress(parameters.gear.teeth_flexspline);
  FlexsplineStress(parameters).at(ring, 0, stress);
  return stress;
}

/// Force on each ball [N]; empty if the model has no single balls.
std::vector<double> ballForces(const RingEquilibrium& ring, const Parameters& parameters)
{
  std::vector<double> forces;
  if (parameters.contact.support == SupportKind::SINGLE_BALLS)
  {
    const auto& balls = ring.forces().of<WaveGeneratorContact>().balls;
    std::transform(balls.begin(), balls.begin() + parameters.bearing.balls, std::back_inserter(forces),
                   [](const SingleBalls::Ball& ball) { return ball.force; });
  }
  return forces;
}

/// Torque of the housing on the flexspline [N.m].
double housingTorque(const RingEquilibrium& ring)
{
  return -ring.model().of<CupTorsion>().torque(ring.forces().of<CupTorsion>().rotation);
}
}  // namespace

InsertionResult analyseInsertion(const Parameters& parameters)
{
  RingModel model = startingJoint(parameters).ring;
  model.setMeshed(false);
  InsertionResult result;
  const auto start = std::chrono::steady_clock::now();
  RingEquilibrium ring(model, staticSolver(parameters.solver));
  result.status = ring.insert({ 0.0, 0.0, parameters.gear.wave_amplitude });
  result.solve_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.teeth = tabulateTeeth(ring, stressOf(ring, parameters));
  const ToothTable& teeth = result.teeth;
  const auto force = std::minmax_element(teeth.wave_generator_force.begin(), teeth.wave_generator_force.end());
  const auto tension = std::minmax_element(teeth.rim_tension.begin(), teeth.rim_tension.end());
  result.wave_generator_force_min = *force.first;
  result.wave_generator_force_max = *force.second;
  result.wave_generator_force_sum =
      std::accumulate(teeth.wave_generator_force.begin(), teeth.wave_generator_force.end(), 0.0);
  result.teeth_in_contact = static_cast<int>(std::count_if(
      teeth.wave_generator_force.begin(), teeth.wave_generator_force.end(), [](double f) { return f > 0.0; }));
  result.tension_min = *tension.first;
  result.tension_max = *tension.second;
  result.radius_major_axis = teeth.radius.front();
  result.radius_minor_axis = teeth.radius[teeth.radius.size() / 4];
  for (const double force_of_tooth : teeth.bending_force)
  {
    result.bending_force_max = std::max(result.bending_force_max, std::abs(force_of_tooth));
  }
  return result;
}

FitCheck checkFit(const Parameters& parameters)
{
  FitCheck check;
  for (const bool meshed : { false, true })
  {
    RingModel model = startingJoint(parameters).ring;
    model.setMeshed(meshed);
    RingEquilibrium ring(model, staticSolver(parameters.solver));
    check.status = meshed ? insertUnderLoad(ring, 0.0, 0.0) : ring.insert({ 0.0, 0.0, parameters.gear.wave_amplitude });
    if (!check.status.ok())
    {
      break;
    }
    (meshed ? check.wave_generator_force : check.wave_generator_force_insertion) =
        ring.forces().of<WaveGeneratorContact>().force.sum();
    check.teeth_loaded = static_cast<int>((ring.forces().of<ToothMesh>().flank_force.array() != 0.0).count());
  }
  return check;
}

std::vector<StiffnessRow> analyseStiffness(const Parameters& parameters, double wave_generator_angle,
                                           const std::vector<double>& torques)
{
  const RingModel model = startingJoint(parameters).ring;
  RingEquilibrium unloaded(model, staticSolver(parameters.solver));
  const SolveStatus status = insertUnderLoad(unloaded, wave_generator_angle, 0.0);
  std::vector<StiffnessRow> rows;
  for (const double torque : torques)
  {
    RingEquilibrium ring = unloaded;
    StiffnessRow row;
    row.status = status.ok() ? balanceOutput(ring, wave_generator_angle, torque) : status;
    row.torque = torque;
    row.output_angle = ring.position().output_angle - unloaded.position().output_angle;
    row.wave_generator_torque = ring.forces().wave_generator_torque;
    row.housing_torque = housingTorque(ring);
    row.cup_rotation = ring.forces().of<CupTorsion>().rotation;
    row.ball_force = ballForces(ring, parameters);
    row.stress = stressOf(ring, parameters);
    row.teeth = tabulateTeeth(ring, row.stress);
    for (int i = 0; i < model.rest.teeth(); ++i)
    {
      const double mesh = std::abs(ring.forces().of<ToothMesh>().flank_force[i]);
      row.teeth_loaded += mesh > 0.0 ? 1 : 0;
      row.mesh_force_max = std::max(row.mesh_force_max, mesh);
      row.wave_generator_force_sum += ring.forces().of<WaveGeneratorContact>().force[i];
    }
    rows.push_back(row);
  }
  return rows;
}

std::vector<TurnRow> analyseTurn(const Parameters& parameters, double load_torque, double angle_range, int steps,
                                 const std::function<void(int)>& progress)
{
  requireAtLeast("steps", steps, 1);
  const RingModel model = startingJoint(parameters).ring;
  RingEquilibrium ring(model, staticSolver(parameters.solver));
  SolveStatus status = ring.insert({ 0.0, 0.0, parameters.gear.wave_amplitude });
  std::vector<TurnRow> rows;
  for (int i = 0; i <= steps; ++i)
  {
    const double angle = angle_range * i / steps;
    if (status.ok())
    {
      status = balanceOutput(ring, angle, load_torque);
    }
    const double output_angle = ring.position().output_angle;
    rows.push_back({ status, angle, output_angle, output_angle - angle / nominalRatio(parameters.gear),
                     ring.forces().wave_generator_torque, housingTorque(ring) });
    if (progress)
    {
      progress(i);
    }
  }
  return rows;
}
}  // namespace hjt
