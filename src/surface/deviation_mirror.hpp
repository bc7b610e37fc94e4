// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "surface/deviation_rings.hpp"

namespace hjt
{
/// Deviations that are their own mirror image: the energy's at x pitches and v is that at (centre - x) and -v. So it is
/// for a fault that looks the same from both sides, of a gear of equal teeth that does.
class DeviationMirror
{
public:
  /// Torques that count as equal, as slopes of the energy by u and v [J], [J/rad].
  struct Same
  {
    double by_u, by_v;
  };

  /// As two lines at opposite v tell, measured at all pitches with the same columns. `swaps_lobes`: beyond the last
  /// pitch the lobes have changed places.
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

  /// Which pitch a pitch is the image of.
  std::size_t imageOf(std::size_t pitch) const noexcept { return (centre_ + 2 * pitches_ - 1 - pitch) % pitches_; }

  /// The line at the opposite v.
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

  /// Torques at every node; what friction and lobes need in the mean: where a tooth begins to touch, rates jump.
  bool gives(const DeviationLine& line, const DeviationLine& opposite, const Same& same) const
  {
    constexpr double SAME_FRICTION = 0.01;  // difference of equal friction, as a share of the mean deviation [-]
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
