// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "surface/deviation_rings.hpp"

namespace hjt
{
/// Whether a grid of deviations gives what the ring has between its nodes.
class DeviationCheck
{
public:
  using Torques = Eigen::Array2d;  ///< on output and motor [N.m]

  /// `ring` knows its limits and is not solved.
  explicit DeviationCheck(const SurfaceRing& ring) : ring_(ring) {}

  Torques torques(const SurfaceNode& deviation) const
  {
    return torques(deviation[SurfaceNode::ENERGY_BY_U], deviation[SurfaceNode::ENERGY_BY_V]);
  }

  bool departs(const SurfaceNode& node) const
  {
    constexpr double ROUNDING = 1e-8;  // of the torque limit; the rings are solved to a tenth of that
    const Torques torque = torques(node).abs();
    return std::max(torque[0], torque[1] * ring_.ratio()) > ROUNDING * ring_.torqueLimit();
  }

  /// By how much every so manyth node of a strip misses those between, root mean square over the tolerance [-].
  double missOfColumns(const Strip& strip, int columns, const Torques& tolerance) const
  {
    const std::size_t stride = (strip.size() - 1) / static_cast<std::size_t>(columns);
    Torques squares = Torques::Zero();
    for (std::size_t first = 0; first + 1 < strip.size(); first += stride)
    {
      const std::array<SurfaceNode, 2> ends{ strip[first], strip[first + stride] };
      for (std::size_t i = 1; i < stride; ++i)
      {
        const double part = static_cast<double>(i) / static_cast<double>(stride);
        squares +=
            miss({ ends.data(), ends.data(), part, 0.0, static_cast<double>(columns), 1.0 }, strip[first + i]).square();
      }
    }
    return largest(squares / (static_cast<double>(columns) * (static_cast<double>(stride) - 1.0)), tolerance);
  }

  /// By how much two lines' strips of a pitch, `height` apart [rad], miss that of the line half way between them, root
  /// mean square over the tolerance [-]. Single kinks, where a tooth begins to touch, no grid has.
  double missBetween(const Strip& below, const Strip& above, double height, const Strip& middle,
                     const Torques& tolerance) const
  {
    const std::size_t columns = middle.size() - 1;
    Torques squares = Torques::Zero();
    for (std::size_t i = 0; i < columns; ++i)
    {
      squares +=
          miss({ &below[i], &above[i], 0.0, 0.5, static_cast<double>(columns), 1.0 / height }, middle[i]).square();
    }
    return largest(squares / static_cast<double>(columns), tolerance);
  }

private:
  static double largest(const Torques& squares, const Torques& tolerance)
  {
    return (squares > 0.0).select(squares.sqrt() / tolerance, 0.0).maxCoeff();
  }

  Torques torques(double by_u, double by_v) const { return { -by_v, by_v / ring_.ratio() - by_u / ring_.pitch() }; }

  /// By how much what lies in a cell misses the deviation measured there.
  Torques miss(const SurfaceCell& cell, const SurfaceNode& measured) const
  {
    const SurfaceEnergy energy = cell.energy();
    return torques(energy.by_u, energy.by_v) - torques(measured);
  }

  const SurfaceRing& ring_;
};
}  // namespace hjt
