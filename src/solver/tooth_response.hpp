// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "solver/shared_values.hpp"

namespace hjt
{
/// How a table was tried against the ring, up to the torque limit, where its grid was not refined any further: half way
/// between columns, and half way between lines. A miss is the largest difference over its tolerance [-]. Plain data.
struct GridChecks
{
  int made{};      ///< checks
  int missed{};    ///< of these with a miss above 1: the grid is as fine there as it may be
  double worst{};  ///< largest miss

  void add(double miss) noexcept
  {
    ++made;
    missed += miss > 1.0 ? 1 : 0;
    worst = miss > worst ? miss : worst;
  }
};

/// Forces and places of all teeth of the ring in equilibrium, for a gear of equal teeth: over u and v, as SurfaceTable.
/// A pitch further on, each tooth is as the one before it was. Plain data: what is built, cached and read.
struct ToothResponse
{
  /// Of a tooth, in the order in which they lie.
  enum Quantity : unsigned char
  {
    WAVE_GENERATOR_FORCE,  ///< [N]
    RIM_TENSION,           ///< to the next tooth [N]
    BENDING_FORCE,         ///< of the segment to the next tooth [N]
    MESH_FORCE,            ///< > 0 leading, < 0 trailing flank [N]
    X,                     ///< of the tooth point, with the wave generator within the first pitch [m]
    Y,                     ///< [m]
    QUANTITIES
  };

  int teeth{};                 ///< of the flexspline
  int stored{};                ///< of these; half, if half a turn changes nothing but the sign of the places
  int columns{};               ///< intervals of u over a pitch, equal
  double pitch{};              ///< [rad]
  double ratio{};              ///< nominal [-]
  std::vector<double> lines;   ///< v of the lines, ascending [rad]; empty: there is no table
  SharedValues<float> values;  ///< a quantity's stored teeth, a node's quantities, columns + 1 nodes a line
  GridChecks checks{};

  std::size_t nodeSize() const noexcept { return static_cast<std::size_t>(QUANTITIES) * static_cast<unsigned>(stored); }

  /// `out`: by quantity, as long as there are teeth. False, and nothing done, outside the table.
  bool at(double motor_angle, double output_angle, double* const* out) const noexcept;
};
}  // namespace hjt
