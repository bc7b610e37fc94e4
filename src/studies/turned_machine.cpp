// SPDX-License-Identifier: BSD-3-Clause
#include "studies/turned_machine.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "gear/angle.hpp"
#include "solver/output_balance.hpp"
#include "statics/static_solver.hpp"

namespace hjt
{
namespace
{
struct State
{
  RingShape shape;
  DrivePosition position;
};

/// x, y of every tooth turned by `angle`.
Eigen::VectorXd turned(const Eigen::VectorXd& vectors, double angle)
{
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  Eigen::VectorXd result(vectors.size());
  for (Eigen::Index k = 0; k < vectors.size(); k += 2)
  {
    result[k] = c * vectors[k] - s * vectors[k + 1];
    result[k + 1] = s * vectors[k] + c * vectors[k + 1];
  }
  return result;
}

State turned(const State& state, double angle)
{
  State result = state;
  result.shape.points = turned(state.shape.points, angle);
  result.shape.updateGeometry();
  result.position.wave_generator_angle += angle;
  result.position.output_angle += angle;
  return result;
}

using AddForces = std::function<void(const State&, RingForces&)>;

RingForces forcesOf(const AddForces& add, const State& state)
{
  RingForces forces(state.shape.teeth());
  forces.setZero(state.shape.teeth());
  add(state, forces);
  return forces;
}

TurnedElement compare(const std::string& name, const AddForces& add, const State& state,
                      const std::vector<double>& angles)
{
  const RingForces still = forcesOf(add, state);
  TurnedElement element;
  element.name = name;
  element.force_max = still.teeth.lpNorm<Eigen::Infinity>();
  element.energy = still.energy;
  for (const double angle : angles)
  {
    const RingForces forces = forcesOf(add, turned(state, angle));
    const double force = (turned(forces.teeth, -angle) - still.teeth).lpNorm<Eigen::Infinity>();
    const double torque = std::max(std::abs(forces.wave_generator_torque - still.wave_generator_torque),
                                   std::abs(forces.output_torque - still.output_torque));
    element.force_difference = std::max(element.force_difference, force);
    element.energy_difference = std::max(element.energy_difference, std::abs(forces.energy - still.energy));
    element.torque_difference = std::max(element.torque_difference, torque);
  }
  return element;
}

RimBending bendingOf(Parameters parameters, BendingLaw law, const ToothRing& rest)
{
  parameters.ring.bending_law = law;
  return RimBending(parameters, rest);
}

template <class Element>
AddForces adderOf(const Element& element)
{
  return [&](const State& state, RingForces& forces)
  { element.addForces(state.shape, state.position, forces.of<Element>(), forces); };
}

double bendingForceMax(const RimBending& bending, const RingShape& shape, const RingForces& forces)
{
  double largest = 0.0;
  for (int i = 0; i < shape.teeth(); ++i)
  {
    largest = std::max(largest, std::abs(bending.bendingForce(shape, forces.of<RimBending>(), i)));
  }
  return largest;
}
}  // namespace

TurnedMachine analyseTurnedMachine(const Parameters& parameters, double load, unsigned seed, int samples)
{
  constexpr double SCAN = 0.5;  // rad
  const RingModel model(parameters);
  RingEquilibrium ring(model, staticSolver(parameters.solver));
  TurnedMachine result;
  result.status = insertUnderLoad(ring, 0.0, load);
  const State state{ ring.shape().whole(), ring.position() };
  const RimBending curvature = bendingOf(parameters, BendingLaw::CURVATURE, model.rest);
  const RimBending absolute = bendingOf(parameters, BendingLaw::ABSOLUTE, model.rest);

  std::mt19937 random(seed);
  std::uniform_real_distribution<double> angle(-PI, PI);
  std::vector<double> angles(static_cast<std::size_t>(samples));
  std::generate(angles.begin(), angles.end(), [&] { return angle(random); });
  const auto add = [&](const std::string& name, const AddForces& forces)
  { result.elements.push_back(compare(name, forces, state, angles)); };
  add("rim_tension", adderOf(model.of<RimTension>()));
  add("rim_bending_curvature", adderOf(curvature));
  add("rim_bending_absolute", adderOf(absolute));
  add("wave_generator_contact", adderOf(model.of<WaveGeneratorContact>()));
  add("tooth_mesh", adderOf(model.of<ToothMesh>()));

  for (int i = 0; i < samples; ++i)
  {
    TurnedBending row;
    row.angle = samples > 1 ? SCAN * (2.0 * i / (samples - 1) - 1.0) : 0.0;
    const State at = turned(state, row.angle);
    const RingForces curved = forcesOf(adderOf(curvature), at);
    const RingForces absolutely = forcesOf(adderOf(absolute), at);
    row.curvature_force = bendingForceMax(curvature, at.shape, curved);
    row.absolute_force = bendingForceMax(absolute, at.shape, absolutely);
    row.curvature_energy = curved.energy;
    row.absolute_energy = absolutely.energy;
    result.bending.push_back(row);
  }
  return result;
}
}  // namespace hjt
