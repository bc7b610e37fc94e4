// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "elements/race_deflection.hpp"
#include "solver/surface_energy.hpp"

namespace hjt
{
/// By how much the ring in equilibrium changes where one ball of the wave generator's bearing drops by h, as a table
/// over
///
///   u    wave generator angle [tooth pitches], period 1
///   v    output angle - wave generator angle / ratio [rad]
///   chi  place of the ball less the wave generator's angle [rad]
///
/// Each value is a polynomial in x = h / deepest without a constant, its coefficients cubic B-splines of u, chi and
/// w = asinh(v / scale) on even grids.
struct BallTable
{
  enum Value
  {
    ENERGY,             // of x, x^2, x^3, x^4 [J]
    CONTACT_FORCE = 4,  // of x, x^2 [N]
    FLANKS = 6,         // of x, x^2: friction of the flanks as the drive runs, to that of the sound gear [-]
    VALUES = 8
  };
  using Coefficients = Eigen::Array<double, VALUES, 1>;

  double pitch{};    ///< of the flexspline's teeth [rad]
  double ratio{};    ///< nominal [-]
  double deepest{};  ///< drop up to which it holds [m]
  double turn{};     ///< period of chi [rad]
  double scale{};    ///< of v [rad]
  double lowest{};   ///< w of the first line [-]
  double step{};     ///< of w between lines [-]
  int lines{};       ///< intervals of w; there are lines + 3 coefficients
  int columns{};     ///< intervals of u over a pitch
  int places{};      ///< intervals of chi over a turn
  /// Coefficients of line i (-1 ... lines + 1), column j, place k have the index ((i + 1) columns + j) places + k.
  std::vector<Coefficients> coefficients;
};

/// A gear's table with the faults of its bearing.
class BallDrops
{
public:
  /// `bearing`: of a gear with the table; its balls drop no deeper than that says, and one at a time.
  BallDrops(std::shared_ptr<const BallTable> table, const RaceDeflection& bearing)
    : table_(std::move(table)), bearing_(bearing)
  {
  }

  const std::shared_ptr<const BallTable>& table() const noexcept { return table_; }

  /// Change of the gear by the ball that has dropped. The wave generator takes the balls along: derivatives by u are
  /// at the same v. The friction of the outer race, a hundredth of the flanks', is left as it is.
  struct Change
  {
    SurfaceEnergy energy;
    double contact_force{};  ///< [N]
    double flanks{};         ///< part of their friction [-]
  };
  /// `v` on the table.
  Change at(double motor_angle, double v) const noexcept;

private:
  Change ofBall(double motor_angle, double v, double place, const RaceDeflection::Drop& drop) const noexcept;

  std::shared_ptr<const BallTable> table_;
  RaceDeflection bearing_;
};
}  // namespace hjt
