// SPDX-License-Identifier: BSD-3-Clause
#include "surface/surface_ring.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "base/number_text.hpp"
#include "gear/ratio.hpp"
#include "model/lobe_loads.hpp"
#include "params/variants.hpp"

namespace hjt
{
namespace
{
using Node = SurfaceNode;

constexpr double ANGLE_TOLERANCE = 1e-8;   // tolerance of the output torque, as output angle: 0.002 arc seconds [rad]
constexpr double MOTOR_TOLERANCE = 1e-4;   // tolerance of the motor torque, as a share of the motor's torque limit [-]
constexpr double SAME_TORQUE = 1e-6;       // largest difference of equal torques, as a share of the torque limit [-]
constexpr double OVERLOAD_FACTOR = 10.0;   // factor on the tolerances above the torque limit [-]
constexpr double COLLISION_MARGIN = 1.25;  // largest torque of the motor in a table, over the momentary peak torque [-]

/// Divides the flanks into groups with common friction. In half of the groups the slip of a running drive and that of
/// an output that turns with the motor at rest have equal signs, in the other half opposite signs. The size of the slip
/// makes three groups of each half. `terms`: friction of flanks; `velocity_ratio`: output over motor speed.
///
/// If the drive runs, or if the output turns with the motor at rest, all flanks of a group slide in one direction, so
/// that the sum of their friction is exact. The coefficient of friction, which decreases with the slip, is that of the
/// group's root mean square slip.
void groupFlanks(const FrictionTerms& terms, double velocity_ratio, double* groups)
{
  constexpr int SIZES = RingFrictionResponse::FLANK_GROUPS / 2;
  // A flank belongs to the slowest group alone if its slip over the mean slip is below LOW, and to the fastest group
  // alone if it is above HIGH. Between LOW and HIGH two groups share the flank.
  constexpr double LOW = 0.25;
  constexpr double HIGH = 1.25;
  struct Sums
  {
    double force{};
    Eigen::Vector2d slip{ 0.0, 0.0 };     // sum of force times slip: of the running drive, of the output alone
    Eigen::Vector2d squares{ 0.0, 0.0 };  // sum of the terms of `slip` times the slip of the running drive
  };
  std::array<Sums, RingFrictionResponse::FLANK_GROUPS> sums;
  std::array<double, 2> first{};
  std::array<double, 2> second{};
  const auto running = [&](const FrictionTerm& term) { return term.slip[0] + velocity_ratio * term.slip[1]; };
  const auto sense = [&](const FrictionTerm& term) { return running(term) * term.slip[1] >= 0.0 ? 0 : 1; };
  for (const FrictionTerm term : terms)
  {
    const double slip = std::abs(running(term));
    first[sense(term)] += term.strength * slip;
    second[sense(term)] += term.strength * slip * slip;
  }
  for (const FrictionTerm term : terms)
  {
    const int half = sense(term);
    const double mean = first[half] > 0.0 ? second[half] / first[half] : 1.0;
    const double sign = running(term) >= 0.0 ? 1.0 : -1.0;
    const Eigen::Vector2d slip(sign * running(term), sign * term.slip[1]);
    const double size = std::clamp((slip[0] / mean - LOW) / (HIGH - LOW), 0.0, 1.0) * (SIZES - 1);
    for (int i = 0; i < SIZES; ++i)
    {
      const double force = term.strength * std::max(0.0, 1.0 - std::abs(size - i));
      Sums& group = sums[SIZES * half + i];
      group.force += force;
      group.slip += force * slip;
      group.squares += force * slip[0] * slip;
    }
  }
  for (const Sums& group : sums)
  {
    const double size = group.force > 0.0 ? std::sqrt(group.squares[0] / group.force) : 0.0;
    const Eigen::Vector2d rms =
        size > 0.0 ? Eigen::Vector2d(group.squares / (group.force * size)) : Eigen::Vector2d(0.0, 0.0);
    // Converts slips of the running drive and of the output alone to slips per motor speed and per output speed.
    groups[0] = group.slip[0] - velocity_ratio * group.slip[1];
    groups[2 * SIZES] = group.slip[1];
    groups[4 * SIZES] = rms[0] - velocity_ratio * rms[1];
    groups[6 * SIZES] = rms[1];
    ++groups;
  }
}

/// Solver parameters for the tables of all drives. They are fixed, because the key of a table does not contain the
/// solver parameters of a twin. RingEquilibrium::torques corrects the torques for the forces that remain.
SolverParameters solverOfTables()
{
  SolverParameters solver;
  solver.force_tolerance = 1e-4;  // largest out-of-balance force [N]
  solver.max_iterations = 20;
  solver.max_step_cuts = 8;
  return solver;
}

/// Torque limit of a table at the output [N.m]. The torque of the motor is limited, because the motor of a blocked
/// wrist could apply 2.6 times the gear's momentary peak torque, more than a table can hold.
double tabulatedTorque(const SurfaceParameters& parameters)
{
  const double of_motor = parameters.motor.torque_limit * nominalRatio(parameters.gear);
  return std::max(parameters.output.load_torque_limit,
                  std::min(of_motor, COLLISION_MARGIN * parameters.momentary_peak_torque));
}
}  // namespace

SurfaceParameters::SurfaceParameters(const Parameters& of)
  : gear(of.gear)
  , mesh(of.mesh)
  , unit_friction(withUnitFriction(of).mesh)
  , cup(of.cup)
  , motor(of.motor)
  , output(of.output)
  , input(of.input)
  , momentary_peak_torque(of.life.momentary_peak_torque)
{
}

std::string tooManyPoints(const SurfaceParameters& parameters, std::size_t most)
{
  const auto named = [](const char* key, double value) { return std::string(key) + " = " + numberText(value); };
  return "a table that meets its tolerances would have more than " + std::to_string(most) +
         " points. Fewer points are enough for fewer teeth, a smaller wave, smaller torque limits or, if teeth differ, "
         "smaller errors of manufacture and faults (" +
         named("gear.teeth_flexspline", parameters.gear.teeth_flexspline) + ", " +
         named("gear.wave_amplitude", parameters.gear.wave_amplitude) + ", " +
         named("motor.torque_limit", parameters.motor.torque_limit) + ", " +
         named("output.load_torque_limit", parameters.output.load_torque_limit) + ")";
}

SurfaceRing::SurfaceRing(const SurfaceParameters& parameters, JointModel model)
  : model_(std::move(model))
  , unit_friction_(parameters.unit_friction, parameters.gear.teeth_flexspline)
  , ring_(model_.ring, solverOfTables())
  , friction_(parameters.gear.teeth_flexspline)
  , tooth_angles_(Eigen::VectorXd::LinSpaced(parameters.gear.teeth_flexspline, 0.0,
                                             (parameters.gear.teeth_flexspline - 1) * model_.ring.rest.pitchAngle()))
  , pitch_(model_.ring.rest.pitchAngle())
  , ratio_(nominalRatio(parameters.gear))
  , wave_amplitude_(model_.ring.gear.wave_amplitude)
  , torque_limit_(tabulatedTorque(parameters))
  , motor_limit_(parameters.motor.torque_limit > 0.0 ? parameters.motor.torque_limit : torque_limit_ / ratio_)
  , softest_(parameters.cup.torsion_stiffness[0])
  , static_friction_(parameters.mesh.friction_static)
  , temperature_(parameters.input.temperature)
{
  unit_friction_.toothFactor() = model_.mesh_friction.toothFactor();
}

bool SurfaceRing::insert()
{
  return ring_.insert({ 0.0, 0.0, wave_amplitude_ }).ok();
}

bool SurfaceRing::moveTo(double motor_angle, double v)
{
  ++solves_;
  return ring_.reach({ motor_angle, v + motor_angle / ratio_, wave_amplitude_ }).ok();
}

bool SurfaceRing::moveTo(double motor_angle, double v, const Eigen::VectorXd& guess)
{
  ++solves_;
  return ring_.moveTo({ motor_angle, v + motor_angle / ratio_, wave_amplitude_ }, guess).ok() || moveTo(motor_angle, v);
}

Node SurfaceRing::measure()
{
  if (!model_.ring.of<WaveGeneratorContact>().hasKinks())
  {
    ring_.refreshSensitivities();
  }
  std::array<double, SurfaceNode::VALUES> node{};
  const RingForces& forces = ring_.forces();
  const auto& contact = forces.of<WaveGeneratorContact>();
  const auto& mesh = forces.of<ToothMesh>();
  const Eigen::Matrix2d& k = ring_.stiffness();
  const double velocity_ratio = ring_.velocityRatio();
  const RingRates rates{ ring_.shape(), ring_.byWaveGenerator(), ring_.byOutput() };
  const Eigen::Vector2d torque = ring_.torques();
  node[SurfaceNode::ENERGY] = forces.energy;
  node[SurfaceNode::ENERGY_BY_U] = -pitch_ * (torque[0] + torque[1] / ratio_);
  node[SurfaceNode::ENERGY_BY_V] = -torque[1];
  node[SurfaceNode::ENERGY_BY_UV] = pitch_ * (k(0, 1) + k(1, 1) / ratio_);
  node[SurfaceNode::VELOCITY_RATIO] = velocity_ratio;
  node[SurfaceNode::OUTPUT_STIFFNESS] = k(1, 1);
  node[SurfaceNode::CONTACT_FORCE] = contact.force.sum();
  friction_.running = rates.by_motor + velocity_ratio * rates.by_output;
  node[SurfaceNode::RING_TORQUE] = model_.ringTorque(ring_.shape(), forces, friction_.running);
  friction_.setZero();
  model_.damping.add(contact, rates, friction_);
  node[SurfaceNode::VISCOUS] = friction_.viscous(0, 0);
  node[SurfaceNode::VISCOUS + 1] = friction_.viscous(0, 1);
  node[SurfaceNode::VISCOUS + 2] = friction_.viscous(1, 1);
  unit_friction_.addTerms(model_.ring.of<ToothMesh>(), mesh, rates, { 0.0, 0.0 }, friction_);
  groupFlanks(friction_.terms, velocity_ratio, &node[SurfaceNode::FLANKS]);
  const LobeLoads lobes =
      lobeLoads({ mesh.flank_force, contact.force, tooth_angles_, ring_.position().wave_generator_angle });
  node[SurfaceNode::TEETH_LOADED] = lobes.teeth_loaded;
  node[SurfaceNode::LOBE_FORCE] = lobes.mesh_force[0];
  node[SurfaceNode::LOBE_FORCE + 1] = lobes.mesh_force[1];
  return SurfaceNode(node);
}

void SurfaceRing::measureTeeth(float* values) const noexcept
{
  const RingForces& forces = ring_.forces();
  const RingShape& shape = ring_.shape();
  const int stored = shape.solved;
  const auto set = [&](int quantity, int tooth, double value)
  { values[quantity * stored + tooth] = static_cast<float>(value); };
  for (int i = 0; i < stored; ++i)
  {
    set(ToothResponse::WAVE_GENERATOR_FORCE, i, forces.of<WaveGeneratorContact>().force[i]);
    set(ToothResponse::RIM_TENSION, i, model_.ring.of<RimTension>().tension(shape, i));
    set(ToothResponse::BENDING_FORCE, i, model_.ring.of<RimBending>().bendingForce(shape, forces.of<RimBending>(), i));
    set(ToothResponse::MESH_FORCE, i, forces.of<ToothMesh>().flank_force[i]);
    set(ToothResponse::X, i, shape.points[2 * i]);
    set(ToothResponse::Y, i, shape.points[2 * i + 1]);
  }
}

double SurfaceRing::overload(const Node& node) const noexcept
{
  return std::abs(node[SurfaceNode::ENERGY_BY_V]) > torque_limit_ ? OVERLOAD_FACTOR : 1.0;
}

double SurfaceRing::outputTolerance(const Node& node) const noexcept
{
  return ANGLE_TOLERANCE * std::max(node[SurfaceNode::OUTPUT_STIFFNESS], softest_) * overload(node);
}

double SurfaceRing::motorTolerance(const Node& node) const noexcept
{
  return MOTOR_TOLERANCE * motor_limit_ * overload(node);
}

double SurfaceRing::frictionTolerance(const Node& node) const noexcept
{
  constexpr double SHARE = 0.01;
  return model_.ring.of<WaveGeneratorContact>().hasKinks() ?
             motorTolerance(node) :
             std::max(motorTolerance(node), SHARE * frictionTorque(node));
}

double SurfaceRing::flankFriction(const Node& node) noexcept
{
  double flanks = 0.0;
  for (int i = SurfaceNode::FLANKS; i < SurfaceNode::FLANKS + RingFrictionResponse::FLANK_GROUPS; ++i)
  {
    flanks += std::abs(node[i] + node[SurfaceNode::VELOCITY_RATIO] * node[i + RingFrictionResponse::FLANK_GROUPS]);
  }
  return flanks;
}

double SurfaceRing::frictionTorque(const Node& node) const noexcept
{
  return model_.bearing.torque(0.0, node[SurfaceNode::CONTACT_FORCE], temperature_) + node[SurfaceNode::RING_TORQUE] +
         static_friction_ * flankFriction(node);
}

bool SurfaceRing::isMirrored()
{
  constexpr double SAME_FRICTION = 1e-5;  // largest relative difference of equal friction [-]
  constexpr int PLACES = 8;               // number of compared angles in a pitch
  std::vector<Node> nodes;
  bool mirrored = true;
  for (const double direction : { 1.0, -1.0 })
  {
    mirrored = mirrored && insert();
    std::size_t number = 0;
    for (const double load : { 0.1, 0.4, 1.0 })
    {
      for (int i = 0; i < PLACES && mirrored; ++i)
      {
        // The 0.3 avoids middle and start of a pitch, which are their own mirror images at no load.
        const double angle = pitch_ * (i + 0.3) / PLACES;
        mirrored = moveTo(direction * angle, direction * twist(load * torque_limit_));
        const Node node = mirrored ? measure() : Node{};
        if (direction > 0.0)
        {
          nodes.push_back(node);
          continue;
        }
        const Node& image = nodes[number++];
        const double friction = frictionTorque(node);
        const double by_v = node[SurfaceNode::ENERGY_BY_V] + image[SurfaceNode::ENERGY_BY_V];
        const double by_u = node[SurfaceNode::ENERGY_BY_U] + image[SurfaceNode::ENERGY_BY_U];
        mirrored = mirrored && std::abs(by_v) <= SAME_TORQUE * torque_limit_ &&
                   std::abs(by_u) / pitch_ * ratio_ <= SAME_TORQUE * torque_limit_ &&
                   std::abs(friction - frictionTorque(image)) <= SAME_FRICTION * friction;
      }
    }
  }
  return mirrored;
}

int SurfaceRing::repetition()
{
  constexpr double LOAD = 0.25;  // load of the samples, as a share of the torque limit [-]
  const int teeth = model_.ring.rest.teeth();
  // After half a turn of the wave generator the lobes are at the same teeth of the flexspline. After half a turn and a
  // pitch they are at the same teeth of the circular spline. If the lobes differ, the period is doubled.
  const std::array<int, 5> candidates{ 1, teeth / 2, teeth / 2 + 1, teeth, teeth + 2 };
  std::array<bool, candidates.size()> repeats;
  repeats.fill(true);
  std::vector<Eigen::Vector2d> sampled(2 * static_cast<std::size_t>(teeth) + 2);  // both torques, at the output [N.m]
  for (const double direction : { -1.0, 1.0 })
  {
    if (!insert())
    {
      return 0;
    }
    for (std::size_t i = 0; i < sampled.size(); ++i)
    {
      if (!moveTo(static_cast<double>(i) * pitch_, direction * twist(LOAD * torque_limit_)))
      {
        return 0;
      }
      sampled[i] = ring_.torques().cwiseProduct(Eigen::Vector2d(ratio_, 1.0));
    }
    for (std::size_t c = 0; c < candidates.size(); ++c)
    {
      const auto period = static_cast<std::size_t>(candidates[c]);
      for (std::size_t i = period; i < sampled.size() && repeats[c]; ++i)
      {
        repeats[c] = (sampled[i] - sampled[i - period]).cwiseAbs().maxCoeff() <= SAME_TORQUE * torque_limit_;
      }
    }
  }
  const auto first = std::find(repeats.begin(), repeats.end(), true);
  return first == repeats.end() ? 0 : candidates[static_cast<std::size_t>(first - repeats.begin())];
}
}  // namespace hjt
