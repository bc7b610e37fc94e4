// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "solver/ring_state.hpp"
#include "surface/surface_ring.hpp"

namespace hjt
{
/// Nodes of one tooth pitch on one line, with those at both ends of the pitch.
using Strip = std::vector<SurfaceNode>;

/// Deviations of a gear from the gear with equal teeth, on one line.
struct DeviationLine
{
  std::vector<Strip> strips;                         ///< strip of each pitch; empty if the pitch does not need the line
  Eigen::Array2d largest{ Eigen::Array2d::Zero() };  ///< largest deviations of the torques on output and motor [N.m]
  double overload{};                                 ///< factor on the tolerances, see SurfaceRing::overload [-]
  Eigen::Array2d of_the_surface{ Eigen::Array2d::Zero() };  ///< tolerances of the surface's torques [N.m]
};

/// A ring with equal teeth (`equal`) and the ring of the gear (`actual`). The guess of the shape of `actual` is the
/// shape of `equal` at the same angles plus the difference of the two shapes at the preceding node, because this
/// difference changes less from node to node than each shape.
struct DeviationRings
{
  DeviationRings(const SurfaceParameters& parameters, const JointModel& equal_model, const JointModel& actual_model)
    : equal(parameters, equal_model), actual(parameters, actual_model)
  {
  }

  bool insert() { return equal.insert() && actual.insert(); }

  /// Moves both rings to the line at `target` at constant motor angle, in steps of at most `longest` [rad].
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

  /// Measures the ring with equal teeth at `columns` nodes of a pitch. Empty: the ring has no equilibrium.
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

  /// Measures the ring of the gear at a column of the last `measureEqual`. @returns false if it has no equilibrium.
  bool measureActual(std::size_t pitch, std::size_t column, SurfaceNode& node)
  {
    constexpr double NEAR = 0.6;  // largest turn over which a difference of shapes serves as a guess [pitches]
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
  double v{};  // present v, see SurfaceTable [rad]

private:
  struct Shape
  {
    Eigen::VectorXd points;  // tooth points [m]
    Eigen::VectorXd rates;   // derivatives of the tooth points by the motor angle at constant v [m/rad]
  };
  std::vector<Shape> shapes_;  // shapes of the ring with equal teeth, one for each column
  Shape base_{ equal.points(), equal.points() };
  Shape departure_;
  bool departure_known_{ false };
};

/// Mirror symmetry of deviations: the energy at motor angle x [pitches] and v equals that at c - x and -v, c constant.
/// The symmetry exists for a fault with mirror symmetry in a gear that has mirror symmetry and, else, equal teeth.
class DeviationMirror
{
public:
  /// Largest differences of slopes of the energy that count as equal, by u [J] and by v [J/rad].
  struct Same
  {
    double by_u, by_v;
  };

  /// Finds the symmetry from two lines at opposite v with all pitches, which have equal numbers of columns.
  /// `swaps_lobes`: whether the lobes have exchanged their places after the last pitch.
  static std::optional<DeviationMirror> find(const DeviationLine& line, const DeviationLine& opposite, bool swaps_lobes,
                                             const Same& same)
  {
    for (std::size_t centre = 0; centre < line.strips.size(); ++centre)
    {
      const DeviationMirror mirror(centre, line.strips.size(), swaps_lobes);
      if (mirror.gives(line, opposite, same))
      {
        return mirror;
      }
    }
    return std::nullopt;
  }

  /// Pitch whose mirror image is `pitch`.
  std::size_t imageOf(std::size_t pitch) const noexcept { return (centre_ + 2 * pitches_ - 1 - pitch) % pitches_; }

  /// Mirror image of a line of nodes: the line at -v, where v is output angle - motor angle / ratio.
  DeviationLine image(const DeviationLine& line) const
  {
    DeviationLine image = line;
    for (std::size_t pitch = 0; pitch < pitches_; ++pitch)
    {
      const Strip& strip = line.strips[imageOf(pitch)];
      image.strips[pitch].assign(strip.rbegin(), strip.rend());
      for (SurfaceNode& node : image.strips[pitch])
      {
        node = imageOf(node, swaps_lobes_ && pitch >= centre_);
      }
    }
    return image;
  }

private:
  DeviationMirror(std::size_t centre, std::size_t pitches, bool swaps_lobes)
    : centre_(centre), pitches_(pitches), swaps_lobes_(swaps_lobes)
  {
  }

  static SurfaceNode imageOf(SurfaceNode node, bool swaps_lobes) noexcept
  {
    node.set(SurfaceNode::ENERGY_BY_U, -node[SurfaceNode::ENERGY_BY_U]);
    node.set(SurfaceNode::ENERGY_BY_V, -node[SurfaceNode::ENERGY_BY_V]);
    if (swaps_lobes)
    {
      const double first = node[SurfaceNode::LOBE_FORCE];
      node.set(SurfaceNode::LOBE_FORCE, node[SurfaceNode::LOBE_FORCE + 1]);
      node.set(SurfaceNode::LOBE_FORCE + 1, first);
    }
    return node;
  }

  /// Whether the mirror image of `line` is `opposite`. Compares the torques at every node, but only the means of
  /// friction and lobe forces, whose slopes jump where a tooth begins to touch.
  bool gives(const DeviationLine& line, const DeviationLine& opposite, const Same& same) const
  {
    // largest mean difference of equal values, as a share of their mean [-]
    constexpr double SAME_FRICTION = 0.01;
    constexpr std::array VALUES{ SurfaceNode::CONTACT_FORCE, SurfaceNode::RING_TORQUE, SurfaceNode::VISCOUS,
                                 SurfaceNode::OUTPUT_STIFFNESS, SurfaceNode::LOBE_FORCE };
    std::array<double, VALUES.size()> misses{};
    std::array<double, VALUES.size()> sizes{};
    for (std::size_t pitch = 0; pitch < pitches_; ++pitch)
    {
      const Strip& measured = opposite.strips[pitch];
      const Strip& source = line.strips[imageOf(pitch)];
      for (std::size_t i = 0; i < measured.size(); ++i)
      {
        const SurfaceNode node = imageOf(source[source.size() - 1 - i], swaps_lobes_ && pitch >= centre_);
        const auto miss = [&](int value) { return std::abs(node[value] - measured[i][value]); };
        if (miss(SurfaceNode::ENERGY_BY_U) > same.by_u || miss(SurfaceNode::ENERGY_BY_V) > same.by_v)
        {
          return false;
        }
        for (std::size_t k = 0; k < VALUES.size(); ++k)
        {
          misses[k] += miss(VALUES[k]);
          sizes[k] += std::abs(measured[i][VALUES[k]]);
        }
      }
    }
    for (std::size_t k = 0; k < VALUES.size(); ++k)
    {
      if (misses[k] > SAME_FRICTION * sizes[k])
      {
        return false;
      }
    }
    return true;
  }

  std::size_t centre_;
  std::size_t pitches_;
  bool swaps_lobes_;
};
}  // namespace hjt
