// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

#include "solver/ring_vectors.hpp"
#include "surface/surface_ring.hpp"

namespace hjt
{
/// Nodes of one tooth pitch on one line, with both its ends.
using Strip = std::vector<SurfaceNode>;

/// Deviations from the gear of equal teeth on one line.
struct DeviationLine
{
  std::vector<Strip> strips;                                ///< one a pitch; none where the line is not needed
  Eigen::Array2d largest{ Eigen::Array2d::Zero() };         ///< torques on output and motor [N.m]
  double overload{};                                        ///< by how much its tolerances are wider [-]
  Eigen::Array2d of_the_surface{ Eigen::Array2d::Zero() };  ///< tolerances of the gear of equal teeth [N.m]
};

/// A ring of equal teeth and the gear's own, side by side. The guess of the latter's shape departs from the former's at
/// the same angles as it did at the node before: that changes less than either shape.
struct DeviationRings
{
  DeviationRings(const SurfaceParameters& parameters, const JointModel& equal_model, const JointModel& actual_model)
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
    departure_known_ = false;
    return good;
  }

  /// The gear of equal teeth at these columns. Empty: no equilibrium.
  Strip measureEqual(int columns)
  {
    Strip nodes;
    shapes_.clear();
    for (int column = 0; column < columns; ++column)
    {
      if (!equal.moveTo(equal.pitch() * column / columns, v))
      {
        return {};
      }
      nodes.push_back(equal.measure());
      shapes_.push_back({ equal.points(), equal.rates() });
    }
    return nodes;
  }

  /// The gear's own at a column of those that `measureEqual` was at last. False: no equilibrium.
  bool measureActual(std::size_t pitch, std::size_t column, SurfaceNode& node)
  {
    constexpr double NEAR = 0.6;  // share of a pitch
    const double turned = equal.pitch() * static_cast<double>(pitch);
    const int places = static_cast<int>(pitch) % static_cast<int>(shapes_[column].points.size() / 2);
    const double angle = turned + equal.pitch() * static_cast<double>(column) / static_cast<double>(shapes_.size());
    ring_vectors::turn(shapes_[column].points, places, std::cos(turned), std::sin(turned), base_.points);
    ring_vectors::turn(shapes_[column].rates, places, std::cos(turned), std::sin(turned), base_.rates);
    const double way = angle - actual.motorAngle();
    const bool near = departure_known_ && std::abs(way) < NEAR * equal.pitch();
    const bool good = near ? actual.moveTo(angle, v, base_.points + departure_.points + way * departure_.rates) :
                             actual.moveTo(angle, v);
    if (good)
    {
      node = actual.measure();
      departure_ = { actual.points() - base_.points, actual.rates() - base_.rates };
      departure_known_ = true;
    }
    return good;
  }

  SurfaceRing equal;
  SurfaceRing actual;
  double v{};  // where they are [rad]

private:
  struct Shape
  {
    Eigen::VectorXd points;  // [m]
    Eigen::VectorXd rates;   // by the motor's angle, at the same v [m/rad]
  };
  std::vector<Shape> shapes_;  // of the ring of equal teeth, a column each
  Shape base_{ equal.points(), equal.points() };
  Shape departure_;
  bool departure_known_{ false };
};
}  // namespace hjt
