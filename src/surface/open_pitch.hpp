// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

#include "surface/surface_ring.hpp"

namespace hjt
{
/// A pitch whose edges are yet to be joined.
struct OpenPitch
{
  int columns{};
  std::vector<double> lines;
  std::vector<SurfaceNode> nodes;
};

inline void levelEdge(OpenPitch& pitch, std::size_t column, const std::vector<double>& common)
{
  const std::size_t stride = static_cast<std::size_t>(pitch.columns) + 1;
  std::size_t kept = 0;  // the last line in common
  for (std::size_t i = 0, in_common = 0; i < pitch.lines.size(); ++i)
  {
    if (in_common == common.size() || pitch.lines[i] != common[in_common])
    {
      continue;
    }
    const std::array<SurfaceNode, 2> low{ pitch.nodes[kept * stride + column], {} };
    const std::array<SurfaceNode, 2> high{ pitch.nodes[i * stride + column], {} };
    const double height = pitch.lines[i] - pitch.lines[kept];
    for (std::size_t between = kept + 1; between < i; ++between)
    {
      const SurfaceCell cell(low.data(), high.data(), 0.0, (pitch.lines[between] - pitch.lines[kept]) / height,
                             static_cast<double>(pitch.columns), 1.0 / height);
      const SurfaceEnergy energy = cell.energy();
      SurfaceNode& node = pitch.nodes[between * stride + column];
      for (int value = SurfaceNode::BILINEAR; value < SurfaceNode::VALUES; ++value)
      {
        node.set(value, cell.value(value));
      }
      node.set(SurfaceNode::ENERGY, energy.value);
      node.set(SurfaceNode::ENERGY_BY_U, energy.by_u);
      node.set(SurfaceNode::ENERGY_BY_V, energy.by_v);
      node.set(SurfaceNode::ENERGY_BY_UV, energy.by_uv);
    }
    kept = i;
    ++in_common;
  }
}

/// Makes the end of a pitch and the start of the next one the same function of v: on lines that only one of them has,
/// what lies between those that both have.
inline void joinPitches(OpenPitch& before, OpenPitch& after)
{
  std::vector<double> common;
  std::set_intersection(before.lines.begin(), before.lines.end(), after.lines.begin(), after.lines.end(),
                        std::back_inserter(common));
  if (common.empty())
  {
    return;
  }
  levelEdge(before, static_cast<std::size_t>(before.columns), common);
  levelEdge(after, 0, common);
}

/// The table of all pitches, the last one joined to the first.
inline DeviationTable tableOf(std::vector<OpenPitch> pitches, bool swaps_lobes)
{
  for (std::size_t number = 0; number < pitches.size(); ++number)
  {
    joinPitches(pitches[number], pitches[number + 1 < pitches.size() ? number + 1 : 0]);
  }
  DeviationTable table;
  table.swaps_lobes = swaps_lobes;
  for (OpenPitch& pitch : pitches)
  {
    table.pitches.push_back({ pitch.columns, std::move(pitch.lines), SurfaceNodes(std::move(pitch.nodes)) });
  }
  return table;
}
}  // namespace hjt
