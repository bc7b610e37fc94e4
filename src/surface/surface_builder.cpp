// SPDX-License-Identifier: BSD-3-Clause
#include "surface/surface_builder.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <vector>

namespace hjt
{
namespace
{
using Node = SurfaceTable::Node;
using Line = std::vector<Node>;

constexpr double TORQUE_MARGIN = 2.0;  // the table reaches to this times the torque limits
constexpr int COARSE_LINES = 32;       // a side, before refinement, about
constexpr int MAX_HALVINGS = 9;        // of an interval between two lines
constexpr int MIN_COLUMNS = 16;
constexpr int MAX_COLUMNS = 64;

class SurfaceBuilder
{
public:
  SurfaceBuilder(const Parameters& parameters, const JointModel& model, const std::function<void(double)>& progress,
                 std::size_t max_points)
    : parameters_(parameters), progress_(progress), max_points_(max_points), ring_(parameters, model)
  {
    table_.pitch = ring_.pitch();
    table_.ratio = ring_.ratio();
  }

  SurfaceBuild build()
  {
    SurfaceBuild result;
    if (ring_.torqueLimit() > 0.0)
    {
      insert();
    }
    else
    {
      failure_reason_ = "motor.torque_limit and output.load_torque_limit are both 0: there is no range to tabulate";
    }
    if (good())
    {
      coverRange();
    }
    if (good())
    {
      refine();
    }
    result.failure_reason = failure_reason_;
    result.solves = ring_.solves();
    for (const auto& [v, line] : lines_)
    {
      table_.lines.push_back(v);
      table_.nodes.insert(table_.nodes.end(), line.begin(), line.end());
    }
    result.table = std::move(table_);
    return result;
  }

private:
  bool good() const { return failure_reason_.empty(); }

  void insert()
  {
    if (!ring_.insert())
    {
      failure_reason_ = "the insertion of the wave generator did not converge";
    }
  }

  /// The nodes at one v, to and fro so that the ring never moves far. Empty: no equilibrium.
  Line measureLine(double v, int columns)
  {
    Line line(static_cast<std::size_t>(columns) + 1);
    const bool backwards = ring_.motorAngle() > 0.5 * table_.pitch;
    for (int i = 0; i < columns; ++i)
    {
      const int column = backwards ? columns - 1 - i : i;
      if (!ring_.moveTo(table_.pitch * column / columns, v))
      {
        return {};
      }
      line[static_cast<std::size_t>(column)] = ring_.measure();
    }
    line.back() = line.front();
    return line;
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
    Node interpolated;
    for (std::size_t i = 0; i < interpolated.size(); ++i)
    {
      interpolated[i] = ResponseSurface::value(place, static_cast<int>(i));
    }
    return std::abs(response.output_torque - output_torque) <= ring_.outputTolerance(node) &&
           std::abs(response.wave_generator_torque - motor_torque) <= ring_.motorTolerance(node) &&
           std::abs(ring_.frictionTorque(interpolated) - ring_.frictionTorque(node)) <= ring_.frictionTolerance(node);
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
    const Line finest = measureLine(v, 2 * MAX_COLUMNS);
    if (finest.empty())
    {
      return MAX_COLUMNS;
    }
    for (int columns = MIN_COLUMNS; columns < MAX_COLUMNS; columns *= 2)
    {
      const int stride = 2 * MAX_COLUMNS / columns;
      Line line;
      for (int i = 0; i <= columns; ++i)
      {
        line.push_back(finest[static_cast<std::size_t>(i) * static_cast<std::size_t>(stride)]);
      }
      const ResponseSurface surface = between(v, line, v + 1.0, line, columns);
      bool fine = true;
      for (int i = 0; i < 2 * MAX_COLUMNS; ++i)
      {
        // With the same line twice the slope by v is flattened away: the part along u is what is tried here.
        ResponseSurface::Place place;
        const double motor_angle = table_.pitch * i / (2 * MAX_COLUMNS);
        if (surface.locate(motor_angle, v + motor_angle / table_.ratio, place))
        {
          const RingResponse response = surface.response(place);
          const Node& node = finest[static_cast<std::size_t>(i)];
          const double slope = response.wave_generator_torque + response.output_torque / table_.ratio;
          fine = fine &&
                 std::abs(slope + node[SurfaceTable::ENERGY_BY_U] / table_.pitch) <= ring_.motorTolerance(node) &&
                 std::abs(response.output_torque + node[SurfaceTable::ENERGY_BY_V]) <= ring_.outputTolerance(node);
        }
      }
      if (fine)
      {
        return columns;
      }
    }
    return MAX_COLUMNS;
  }

  /// Coarse lines from no load outwards, until the torque limits with margin are reached both ways.
  void coverRange()
  {
    const double step = ring_.twist(TORQUE_MARGIN * ring_.torqueLimit()) / COARSE_LINES;
    table_.columns = MIN_COLUMNS;
    for (const double load : { 0.1, 0.3, 1.0 })
    {
      table_.columns = std::max(table_.columns, columnsFor(-ring_.twist(load * ring_.torqueLimit())));
    }
    for (const double direction : { 1.0, -1.0 })
    {
      insert();
      double reached = 0.0;
      for (int i = 0; i <= 2 * COARSE_LINES && reached < TORQUE_MARGIN * ring_.torqueLimit(); ++i)
      {
        const double v = direction * i * step;
        Line line = measureLine(v, table_.columns);
        if (line.empty())
        {
          break;
        }
        reached = std::abs(line.front()[SurfaceTable::ENERGY_BY_V]);
        lines_[v] = std::move(line);
        report(0.2 * (direction < 0.0 ? 1.0 : 0.0) +
               0.2 * std::min(1.0, reached / (TORQUE_MARGIN * ring_.torqueLimit())));
      }
      if (reached < ring_.torqueLimit())
      {
        std::ostringstream text;
        text << "the ring finds no equilibrium beyond " << reached << " N.m at the output, less than the "
             << ring_.torqueLimit() << " N.m that load or motor can bring";
        failure_reason_ = text.str();
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
      if (!ring_.moveTo(0.0, *v))
      {
        failure_reason_ = "the ring did not come back to an equilibrium that it had been in";
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
    if (lines_.size() * (static_cast<std::size_t>(table_.columns) + 1) >= max_points_)
    {
      failure_reason_ = tooManyPoints(parameters_, max_points_);
      return;
    }
    const double middle = 0.5 * (below + above);
    Line line = measureLine(middle, table_.columns);
    if (line.empty())
    {
      failure_reason_ = "the ring found no equilibrium between two that it had been in";
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
    }
    if (!fine && good())
    {
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
  std::size_t max_points_;
  SurfaceRing ring_;
  SurfaceTable table_;
  std::map<double, Line> lines_;
  std::string failure_reason_;
};
}  // namespace

SurfaceBuild buildSurface(const Parameters& parameters, const JointModel& model,
                          const std::function<void(double)>& progress, std::size_t max_points)
{
  return SurfaceBuilder(parameters, model, progress, max_points).build();
}
}  // namespace hjt
