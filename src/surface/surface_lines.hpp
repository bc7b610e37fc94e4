// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "solver/response_surface.hpp"
#include "surface/surface_ring.hpp"

namespace hjt
{
/// Nodes of a SurfaceTable at one v.
using SurfaceLine = std::vector<SurfaceNode>;

/// Ring that measures lines of a SurfaceTable.
class LineRing
{
public:
  LineRing(const SurfaceParameters& parameters, const JointModel& model) : ring_(parameters, model) {}

  const SurfaceRing& ring() const noexcept { return ring_; }
  SurfaceRing& ring() noexcept { return ring_; }

  /// Inserts the ring anew and moves it to `v` at the motor angle 0. It moves by `step`, the distance of coarse lines,
  /// so that the ring reaches the equilibria of these lines. @returns false if the ring has no equilibrium.
  bool leadTo(double v, double step)
  {
    const int steps = static_cast<int>(std::lround(std::abs(v) / step));
    bool good = ring_.insert();
    for (int i = 0; i <= steps && good; ++i)
    {
      good = ring_.moveTo(0.0, std::copysign(i * step, v));
    }
    return good;
  }

  /// Measures the nodes of the line at `v`. Successive lines are measured in alternating directions of the motor, so
  /// that all moves are short. Empty if the ring has no equilibrium.
  SurfaceLine measure(double v, int columns)
  {
    SurfaceLine line(static_cast<std::size_t>(columns) + 1);
    const bool backwards = ring_.motorAngle() > 0.5 * ring_.pitch();
    for (int i = 0; i < columns; ++i)
    {
      const int column = backwards ? columns - 1 - i : i;
      if (!ring_.moveTo(ring_.pitch() * column / columns, v))
      {
        return {};
      }
      line[static_cast<std::size_t>(column)] = ring_.measure();
    }
    line.back() = line.front();
    return line;
  }

private:
  SurfaceRing ring_;
};

/// Errors of the interpolation in a table, divided by the tolerances ("misses") [-].
class LineCheck
{
public:
  LineCheck(const SurfaceRing& ring, int columns) : ring_(ring), columns_(columns) {}

  /// Largest miss of the torques, or miss of the mean friction if it is larger, at a measured `line` between two lines.
  /// Single values of friction do not count. They jump where a tooth begins to touch. The places of the jumps differ
  /// from line to line, so that no grid resolves them.
  double miss(double v_below, const SurfaceLine& below, double v_above, const SurfaceLine& above, double v,
              const SurfaceLine& line) const
  {
    const ResponseSurface surface = between(v_below, below, v_above, above);
    double largest = 0.0;
    double friction_misses = 0.0;
    for (int column = 0; column < columns_; ++column)
    {
      const double motor_angle = ring_.pitch() * column / columns_;
      const SurfaceNode& node = line[static_cast<std::size_t>(column)];
      ResponseSurface::Place place;
      if (!surface.locate(motor_angle, v + motor_angle / ring_.ratio(), place))
      {
        return HUGE_VAL;
      }
      largest = std::max(largest, missOfTorques(surface.response(place), node));
      friction_misses += std::abs(ring_.frictionTorque(ResponseSurface::bilinear(place)) - ring_.frictionTorque(node)) /
                         ring_.frictionTolerance(node);
    }
    return std::max(largest, friction_misses / columns_);
  }

  /// Largest miss of the torques between the columns of a line. `finer`: this line with a multiple of the columns.
  double missOfColumns(double v, const SurfaceLine& finer) const
  {
    const std::size_t stride = (finer.size() - 1) / static_cast<std::size_t>(columns_);
    SurfaceLine line;
    for (std::size_t i = 0; i < finer.size(); i += stride)
    {
      line.push_back(finer[i]);
    }
    const ResponseSurface surface = between(v, line, v + 1.0, line);
    double largest = 0.0;
    for (std::size_t i = 0; i + 1 < finer.size(); ++i)
    {
      // The two lines are equal and have no slope by v, so that the check concerns the interpolation along u only.
      ResponseSurface::Place place;
      const double motor_angle = ring_.pitch() * static_cast<double>(i) / static_cast<double>(finer.size() - 1);
      if (surface.locate(motor_angle, v + motor_angle / ring_.ratio(), place))
      {
        const RingResponse response = surface.response(place);
        const SurfaceNode& node = finer[i];
        const double slope = response.wave_generator_torque + response.output_torque / ring_.ratio();
        const double missed = std::abs(slope + node[SurfaceNode::ENERGY_BY_U] / ring_.pitch());
        largest = std::max({ largest, missed / ring_.motorTolerance(node), missOfOutput(response, node) });
      }
    }
    return largest;
  }

private:
  ResponseSurface between(double v_below, const SurfaceLine& below, double v_above, const SurfaceLine& above) const
  {
    SurfaceTable table;
    table.pitch = ring_.pitch();
    table.ratio = ring_.ratio();
    table.columns = columns_;
    table.lines = { v_below, v_above };
    SurfaceLine nodes = below;
    nodes.insert(nodes.end(), above.begin(), above.end());
    table.nodes = SurfaceNodes(std::move(nodes));
    return ResponseSurface(std::move(table));
  }

  double missOfOutput(const RingResponse& response, const SurfaceNode& node) const
  {
    return std::abs(response.output_torque + node[SurfaceNode::ENERGY_BY_V]) / ring_.outputTolerance(node);
  }

  double missOfTorques(const RingResponse& response, const SurfaceNode& node) const
  {
    const double motor_torque =
        -node[SurfaceNode::ENERGY_BY_U] / ring_.pitch() + node[SurfaceNode::ENERGY_BY_V] / ring_.ratio();
    return std::max(missOfOutput(response, node),
                    std::abs(response.wave_generator_torque - motor_torque) / ring_.motorTolerance(node));
  }

  const SurfaceRing& ring_;
  int columns_;
};
}  // namespace hjt
