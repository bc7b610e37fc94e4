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
/// Nodes of one tooth pitch on one line, both ends included.
using Strip = std::vector<SurfaceNode>;

/// Deviations from the gear with equal teeth on one line.
struct DeviationLine
{
  std::vector<Strip> strips;                         ///< one for each pitch; empty where the line is not needed
  Eigen::Array2d largest{ Eigen::Array2d::Zero() };  ///< largest deviations of the torques on output and motor [N.m]
  double overload{};                                 ///< factor by which the tolerances are wider [-]
  Eigen::Array2d of_the_surface{ Eigen::Array2d::Zero() };  ///< tolerances of the gear with equal teeth [N.m]
};

/// A ring with equal teeth and the gear's own ring. The guess of the latter's shape is the former's shape at the
/// present angles plus their difference at the preceding node, because the difference changes less than either shape.
struct DeviationRings
{
  DeviationRings(const SurfaceParameters& parameters, const JointModel& equal_model, const JointModel& actual_model)
    : equal(parameters, equal_model), actual(parameters, actual_model)
  {
  }

  bool insert() { return equal.insert() && actual.insert(); }

  /// Moves both rings to another line at constant motor angle, in steps of at most `longest`.
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

  /// Measures the gear with equal teeth at these columns. Empty: no equilibrium.
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

  /// Measures the gear's own ring at one of the last columns of `measureEqual`. @returns false without an equilibrium.
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
  double v{};  // present v [rad]

private:
  struct Shape
  {
    Eigen::VectorXd points;  // tooth points [m]
    Eigen::VectorXd rates;   // derivatives by the motor's angle at constant v [m/rad]
  };
  std::vector<Shape> shapes_;  // shapes of the ring with equal teeth, one for each column
  Shape base_{ equal.points(), equal.points() };
  Shape departure_;
  bool departure_known_{ false };
};

/// Symmetry of deviations: the energy at x pitches and v equals that at (centre - x) and -v. It exists for a fault with
/// mirror symmetry in a gear of equal teeth with mirror symmetry.
class DeviationMirror
{
public:
  /// Torques that count as equal, as slopes of the energy by u and v [J], [J/rad].
  struct Same
  {
    double by_u, by_v;
  };

  /// Finds the symmetry from two lines at opposite v, measured at all pitches with equal columns. `swaps_lobes`: after
  /// the last pitch the lobes have exchanged their places.
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

  /// The pitch of which a pitch is the mirror image.
  std::size_t imageOf(std::size_t pitch) const noexcept { return (centre_ + 2 * pitches_ - 1 - pitch) % pitches_; }

  /// The line at the opposite v, by the symmetry.
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

  /// Compares the torques at every node, and means of friction and lobe forces, whose rates jump where a tooth begins
  /// to touch.
  bool gives(const DeviationLine& line, const DeviationLine& opposite, const Same& same) const
  {
    // largest difference of equal friction, as a share of the mean deviation [-]
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
