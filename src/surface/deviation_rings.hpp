// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "surface/surface_ring.hpp"

namespace hjt
{
/// Nodes of one tooth pitch on one line, with both its ends.
using Strip = std::vector<SurfaceNode>;

/// Deviations from the gear of equal teeth on one line.
struct DeviationLine
{
  std::vector<Strip> strips;                         ///< one a pitch; none where the line is not needed
  Eigen::Array2d largest{ Eigen::Array2d::Zero() };  ///< torques on output and motor [N.m]
  double overload{};                                 ///< by how much its tolerances are wider [-]
};

/// A ring of equal teeth and the gear's own, side by side.
struct DeviationRings
{
  DeviationRings(const Parameters& parameters, const JointModel& equal_model, const JointModel& actual_model)
    : equal(parameters, equal_model), actual(parameters, actual_model)
  {
  }

  bool insert() { return equal.insert() && actual.insert(); }

  /// Both to another line at the angles where they are, in pieces no longer than a `longest` way.
  bool leadTo(double target, double longest)
  {
    const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(target - v) / longest)));
    bool good = true;
    for (int i = 1; i <= pieces && good; ++i)
    {
      const double between = v + (target - v) * i / pieces;
      good = equal.moveTo(equal.motorAngle(), between) && actual.moveTo(actual.motorAngle(), between);
    }
    v = target;
    return good;
  }

  /// The gear of equal teeth at these columns. Empty: no equilibrium.
  Strip measureEqual(int columns)
  {
    Strip nodes;
    for (int column = 0; column < columns; ++column)
    {
      if (!equal.moveTo(equal.pitch() * column / columns, v))
      {
        return {};
      }
      nodes.push_back(equal.measure());
    }
    return nodes;
  }

  SurfaceRing equal;
  SurfaceRing actual;
  double v{};  // where they are [rad]
};
}  // namespace hjt
