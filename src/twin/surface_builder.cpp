// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/twin/surface_builder.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <vector>

#include "harmonic_joint_twin/gear/angle.hpp"
#include "harmonic_joint_twin/gear/ratio.hpp"
#include "harmonic_joint_twin/health/lobe_loads.hpp"
#include "harmonic_joint_twin/model/joint_model.hpp"
#include "harmonic_joint_twin/solver/ring_equilibrium.hpp"
#include "harmonic_joint_twin/twin/static_solver.hpp"

namespace hjt
{
namespace
{
using Node = SurfaceTable::Node;
using Line = std::vector<Node>;

constexpr double TORQUE_MARGIN = 2.0;     // the table reaches to this times the torque limits
constexpr double ANGLE_TOLERANCE = 1e-8;  // of the output at given torque [rad]; 0.002 seconds of arc
constexpr double MOTOR_TOLERANCE = 1e-4;  // of the motor's torque limit [-]
constexpr double OVERLOAD_FACTOR = 10.0;  // beyond the torque limits the tolerances are this much wider
constexpr int COARSE_LINES = 32;          // a side, before refinement, about
constexpr int MAX_HALVINGS = 9;           // of an interval between two lines
constexpr int LEAST_COLUMNS = 16;
constexpr int MOST_COLUMNS = 64;

MeshParameters unitFriction(MeshParameters parameters)
{
  parameters.friction_static = 1.0;
  parameters.friction_kinetic = 1.0;
  return parameters;
}

/// Flanks in two groups by the sense in which they slide as the drive runs and as its output twists, each again in three by
/// the size of the slip. `terms`: forces and slips by motor and output; `follow`: output speed over motor speed.
///
/// While the drive runs, and while the motor stands and the output swings, all flanks of a group slide the same way, so
/// their sum is exact. The coefficient of friction, which falls with the slip, is taken at the group's root mean square.
void groupFlanks(const std::vector<FrictionTerm>& terms, double follow, double* groups)
{
  constexpr int SIZES = RingFrictionResponse::FLANK_GROUPS / 2;
  constexpr double LOW = 0.25;   // slip, as a share of the mean, that counts to the slowest group only
  constexpr double HIGH = 1.25;  // likewise to the fastest; between them it is shared by two
  struct Sums
  {
    double force{};
    Eigen::Vector2d slip{ 0.0, 0.0 };     // running, twisting
    Eigen::Vector2d squares{ 0.0, 0.0 };  // running squared, running times twisting
  };
  std::array<Sums, RingFrictionResponse::FLANK_GROUPS> sums;
  std::array<double, 2> first{};
  std::array<double, 2> second{};
  const auto running = [&](const FrictionTerm& term) { return term.slip[0] + follow * term.slip[1]; };
  const auto sense = [&](const FrictionTerm& term) { return running(term) * term.slip[1] >= 0.0 ? 0 : 1; };
  for (const FrictionTerm& term : terms)
  {
    const double slip = std::abs(running(term));
    first[sense(term)] += term.strength * slip;
    second[sense(term)] += term.strength * slip * slip;
  }
  for (const FrictionTerm& term : terms)
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
    // From (motor speed, output speed less what follows) to (motor speed, output speed).
    groups[0] = group.slip[0] - follow * group.slip[1];
    groups[2 * SIZES] = group.slip[1];
    groups[4 * SIZES] = rms[0] - follow * rms[1];
    groups[6 * SIZES] = rms[1];
    ++groups;
  }
}

class SurfaceBuilder
{
public:
  SurfaceBuilder(const Parameters& parameters, const std::function<void(double)>& progress)
    : parameters_(parameters)
    , progress_(progress)
    , model_(parameters)
    , unit_friction_(unitFriction(parameters.mesh), parameters.gear.teeth_flexspline)
    , ring_(model_.ring, staticSolver(parameters.solver))
    , friction_(parameters.gear.teeth_flexspline)
    , running_(2 * parameters.gear.teeth_flexspline)
    , tooth_angles_(Eigen::VectorXd::LinSpaced(parameters.gear.teeth_flexspline, 0.0,
                                               (parameters.gear.teeth_flexspline - 1) * model_.ring.rest.pitchAngle()))
    , torque_limit_(
          std::max(parameters.output.load_torque_limit, parameters.motor.torque_limit * nominalRatio(parameters.gear)))
  {
    table_.pitch = model_.ring.rest.pitchAngle();
    table_.ratio = nominalRatio(parameters.gear);
  }

  /// See surfaceObstacle.
  const std::string& obstacle()
  {
    insert();
    if (good() && !repeatsEveryPitch())
    {
      obstacle_ = "the gear is not the same again after every tooth pitch";
    }
    return obstacle_;
  }

  SurfaceBuild build()
  {
    SurfaceBuild result;
    obstacle();
    if (good())
    {
      coverRange();
    }
    if (good())
    {
      refine();
    }
    result.obstacle = obstacle_;
    result.solves = solves_;
    for (const auto& [v, line] : lines_)
    {
      table_.lines.push_back(v);
      table_.nodes.insert(table_.nodes.end(), line.begin(), line.end());
    }
    result.table = std::move(table_);
    return result;
  }

private:
  bool good() const { return obstacle_.empty(); }

  void insert()
  {
    if (!ring_.insert({ 0.0, 0.0, parameters_.gear.wave_amplitude }).ok())
    {
      obstacle_ = "the insertion of the wave generator did not converge";
    }
  }

  /// False: the ring found no equilibrium there.
  bool moveTo(double motor_angle, double v)
  {
    ++solves_;
    return ring_.moveTo({ motor_angle, v + motor_angle / table_.ratio, parameters_.gear.wave_amplitude }).ok();
  }

  /// Whether the torques under load come back after each tooth pitch of a turn.
  bool repeatsEveryPitch()
  {
    constexpr double SAME = 1e-6;  // of the torque limit [-]
    const double v = -0.25 * torque_limit_ / parameters_.cup.torsion_stiffness[0];
    double output = 0.0;
    double motor = 0.0;
    for (int pitch = 0; pitch < parameters_.gear.teeth_flexspline; ++pitch)
    {
      if (!moveTo(pitch * table_.pitch, v))
      {
        return false;
      }
      const RingForces& forces = ring_.forces();
      if (pitch > 0 && (std::abs(forces.output_torque - output) > SAME * torque_limit_ ||
                        std::abs(forces.wave_generator_torque - motor) > SAME * torque_limit_ / table_.ratio))
      {
        return false;
      }
      output = forces.output_torque;
      motor = forces.wave_generator_torque;
    }
    insert();
    return true;
  }

  Node measure()
  {
    Node node{};
    const RingForces& forces = ring_.forces();
    const Eigen::Matrix2d& k = ring_.stiffness();
    const double follow = ring_.follow();
    const RingRates rates{ ring_.byWaveGenerator(), ring_.byOutput() };
    node[SurfaceTable::ENERGY] = forces.energy;
    node[SurfaceTable::ENERGY_BY_U] =
        -table_.pitch * (forces.wave_generator_torque + forces.output_torque / table_.ratio);
    node[SurfaceTable::ENERGY_BY_V] = -forces.output_torque;
    node[SurfaceTable::ENERGY_BY_UV] = table_.pitch * (k(0, 1) + k(1, 1) / table_.ratio);
    node[SurfaceTable::FOLLOW] = follow;
    node[SurfaceTable::OUTPUT_STIFFNESS] = k(1, 1);
    node[SurfaceTable::CONTACT_FORCE] = forces.contact_force.sum();
    running_ = rates.by_motor + follow * rates.by_output;
    node[SurfaceTable::INTERFACE_TORQUE] = model_.interface_friction.torque(ring_.shape(), forces, running_);
    friction_.setZero();
    model_.damping.add(ring_.shape(), forces, rates, friction_);
    node[SurfaceTable::VISCOUS] = friction_.viscous(0, 0);
    node[SurfaceTable::VISCOUS + 1] = friction_.viscous(0, 1);
    node[SurfaceTable::VISCOUS + 2] = friction_.viscous(1, 1);
    unit_friction_.addTerms(model_.ring.mesh, ring_.shape(), forces, rates, { 0.0, 0.0 }, friction_);
    groupFlanks(friction_.terms, follow, &node[SurfaceTable::FLANKS]);
    const LobeLoads lobes =
        lobeLoads({ forces.flank_force, forces.contact_force, tooth_angles_, ring_.position().wave_generator_angle });
    node[SurfaceTable::TEETH_LOADED] = lobes.teeth_loaded;
    node[SurfaceTable::LOBE_FORCE] = lobes.mesh_force[0];
    node[SurfaceTable::LOBE_FORCE + 1] = lobes.mesh_force[1];
    return node;
  }

  /// The nodes at one v, to and fro so that the ring never moves far. Empty: no equilibrium.
  Line measureLine(double v, int columns)
  {
    Line line(static_cast<std::size_t>(columns) + 1);
    const bool backwards = ring_.position().wave_generator_angle > 0.5 * table_.pitch;
    for (int i = 0; i < columns; ++i)
    {
      const int column = backwards ? columns - 1 - i : i;
      if (!moveTo(table_.pitch * column / columns, v))
      {
        return {};
      }
      line[static_cast<std::size_t>(column)] = measure();
    }
    line.back() = line.front();
    return line;
  }

  double outputTolerance(const Node& node) const
  {
    return ANGLE_TOLERANCE * std::max(node[SurfaceTable::OUTPUT_STIFFNESS], parameters_.cup.torsion_stiffness[0]) *
           overload(node);
  }

  double motorTolerance(const Node& node) const
  {
    return MOTOR_TOLERANCE * parameters_.motor.torque_limit * overload(node);
  }

  double overload(const Node& node) const
  {
    return std::abs(node[SurfaceTable::ENERGY_BY_V]) > torque_limit_ ? OVERLOAD_FACTOR : 1.0;
  }

  /// Friction of ring and bearing at the motor as the drive runs, per speed and with static flanks [N.m].
  double frictionTorque(const RingFrictionResponse& friction, double follow) const
  {
    return model_.bearing.torque(0.0, friction.contact_force, parameters_.input.temperature) +
           friction.interface_torque +
           parameters_.mesh.friction_static * (friction.flank_by_motor + follow * friction.flank_by_output).abs().sum();
  }

  /// Whether the surface over two lines gives the torques of a node that lies between them.
  bool agrees(const ResponseSurface& surface, double motor_angle, double v, const Node& node) const
  {
    ResponseSurface::Place place;
    if (!surface.locate(motor_angle, v + motor_angle / table_.ratio, place))
    {
      return false;
    }
    const RingResponse response = surface.response(place);
    const double output_torque = -node[SurfaceTable::ENERGY_BY_V];
    const double motor_torque = -node[SurfaceTable::ENERGY_BY_U] / table_.pitch - output_torque / table_.ratio;
    RingFrictionResponse interpolated;
    surface.friction(place, interpolated);
    RingFrictionResponse exact;
    const ResponseSurface::Place at_node{ &node, &node, 0.0, 0.0, 1.0, 0.0 };
    surface.friction(at_node, exact);
    const double follow = node[SurfaceTable::FOLLOW];
    return std::abs(response.output_torque - output_torque) <= outputTolerance(node) &&
           std::abs(response.wave_generator_torque - motor_torque) <= motorTolerance(node) &&
           std::abs(frictionTorque(interpolated, follow) - frictionTorque(exact, follow)) <= motorTolerance(node);
  }

  ResponseSurface between(double v_below, const Line& below, double v_above, const Line& above, int columns) const
  {
    SurfaceTable table;
    table.pitch = table_.pitch;
    table.ratio = table_.ratio;
    table.columns = columns;
    table.lines = { v_below, v_above };
    table.nodes = below;
    table.nodes.insert(table.nodes.end(), above.begin(), above.end());
    return ResponseSurface(std::move(table));
  }

  /// Fewest columns that give a line's torques half way between them.
  int columnsFor(double v)
  {
    const Line finest = measureLine(v, 2 * MOST_COLUMNS);
    if (finest.empty())
    {
      return MOST_COLUMNS;
    }
    for (int columns = LEAST_COLUMNS; columns < MOST_COLUMNS; columns *= 2)
    {
      const int stride = 2 * MOST_COLUMNS / columns;
      Line line;
      for (int i = 0; i <= columns; ++i)
      {
        line.push_back(finest[static_cast<std::size_t>(i) * static_cast<std::size_t>(stride)]);
      }
      const ResponseSurface surface = between(v, line, v + 1.0, line, columns);
      bool fine = true;
      for (int i = 0; i < 2 * MOST_COLUMNS; ++i)
      {
        // With the same line twice the slope by v is flattened away: the part along u is what is tried here.
        ResponseSurface::Place place;
        const double motor_angle = table_.pitch * i / (2 * MOST_COLUMNS);
        if (surface.locate(motor_angle, v + motor_angle / table_.ratio, place))
        {
          const RingResponse response = surface.response(place);
          const Node& node = finest[static_cast<std::size_t>(i)];
          const double slope = response.wave_generator_torque + response.output_torque / table_.ratio;
          fine = fine && std::abs(slope + node[SurfaceTable::ENERGY_BY_U] / table_.pitch) <= motorTolerance(node) &&
                 std::abs(response.output_torque + node[SurfaceTable::ENERGY_BY_V]) <= outputTolerance(node);
        }
      }
      if (fine)
      {
        return columns;
      }
    }
    return MOST_COLUMNS;
  }

  /// Coarse lines from no load outwards, until the torque limits with margin are reached both ways.
  void coverRange()
  {
    const double step = TORQUE_MARGIN * torque_limit_ / parameters_.cup.torsion_stiffness[0] / COARSE_LINES;
    table_.columns = LEAST_COLUMNS;
    for (const double load : { 0.1, 0.3, 1.0 })
    {
      table_.columns =
          std::max(table_.columns, columnsFor(-load * torque_limit_ / parameters_.cup.torsion_stiffness[0]));
    }
    for (const double direction : { 1.0, -1.0 })
    {
      insert();
      double reached = 0.0;
      for (int i = 0; i <= 2 * COARSE_LINES && reached < TORQUE_MARGIN * torque_limit_; ++i)
      {
        const double v = direction * i * step;
        Line line = measureLine(v, table_.columns);
        if (line.empty())
        {
          break;
        }
        reached = std::abs(line.front()[SurfaceTable::ENERGY_BY_V]);
        lines_[v] = std::move(line);
        report(0.2 * (direction < 0.0 ? 1.0 : 0.0) + 0.2 * std::min(1.0, reached / (TORQUE_MARGIN * torque_limit_)));
      }
      if (reached < torque_limit_)
      {
        std::ostringstream text;
        text << "the ring finds no equilibrium beyond " << reached << " N.m at the output, less than the "
             << torque_limit_ << " N.m that load or motor can bring";
        obstacle_ = text.str();
      }
    }
  }

  void refine()
  {
    std::vector<double> coarse;
    for (const auto& [v, line] : lines_)
    {
      coarse.push_back(v);
    }
    // Down to the lowest line by way of all others, so that the ring stays on the branch of the coarse lines.
    for (auto v = coarse.rbegin(); v != coarse.rend(); ++v)
    {
      if (!moveTo(0.0, *v))
      {
        obstacle_ = "the ring did not come back to an equilibrium that it had been in";
        return;
      }
    }
    for (std::size_t i = 0; i + 1 < coarse.size() && good(); ++i)
    {
      refine(coarse[i], coarse[i + 1], 0);
      report(0.4 + 0.6 * static_cast<double>(i + 1) / static_cast<double>(coarse.size() - 1));
    }
  }

  void refine(double below, double above, int halvings)
  {
    const double middle = 0.5 * (below + above);
    Line line = measureLine(middle, table_.columns);
    if (line.empty())
    {
      obstacle_ = "the ring found no equilibrium between two that it had been in";
      return;
    }
    const ResponseSurface surface = between(below, lines_[below], above, lines_[above], table_.columns);
    bool fine = halvings >= MAX_HALVINGS;
    if (!fine)
    {
      fine = true;
      for (int column = 0; column < table_.columns && fine; ++column)
      {
        fine = agrees(surface, table_.pitch * column / table_.columns, middle, line[static_cast<std::size_t>(column)]);
      }
    }
    lines_[middle] = std::move(line);
    if (!fine)
    {
      refine(below, middle, halvings + 1);
      refine(middle, above, halvings + 1);
    }
  }

  void report(double done) const
  {
    if (progress_)
    {
      progress_(done);
    }
  }

  const Parameters& parameters_;
  std::function<void(double)> progress_;
  JointModel model_;
  MeshFriction unit_friction_;
  RingEquilibrium ring_;
  JointFriction friction_;
  Eigen::VectorXd running_;  // scratch
  Eigen::VectorXd tooth_angles_;
  double torque_limit_;  // of load or motor, at the output [N.m]
  SurfaceTable table_;
  std::map<double, Line> lines_;
  std::string obstacle_;
  int solves_{};
};
}  // namespace

std::string surfaceObstacle(const Parameters& parameters)
{
  return SurfaceBuilder(parameters, {}).obstacle();
}

SurfaceBuild buildSurface(const Parameters& parameters, const std::function<void(double)>& progress)
{
  return SurfaceBuilder(parameters, progress).build();
}
}  // namespace hjt
