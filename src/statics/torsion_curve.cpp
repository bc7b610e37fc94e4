// SPDX-License-Identifier: BSD-3-Clause
#include "statics/torsion_curve.hpp"

#include <algorithm>
#include <cmath>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"

namespace hjt
{
namespace
{
/// Within the first slope of the cup, up to its end; then up to the end of the second and beyond.
std::vector<double> torquesOf(const CupParameters& cup)
{
  std::vector<double> torques{ 0.0 };
  const auto add = [&](double breakpoint, double share, double of)
  {
    const double torque = breakpoint * share / of;
    if (torque > torques.back())
    {
      torques.push_back(torque);
    }
  };
  add(cup.torsion_breakpoints[0], 5.0, 14.0);
  add(cup.torsion_breakpoints[0], 1.0, 1.0);
  for (const double share : { 25.0, 48.0, 75.0, 110.0, 150.0, 200.0, 300.0 })
  {
    add(cup.torsion_breakpoints[1], share, 48.0);
  }
  if (torques.size() == 1)
  {
    torques.push_back(1.0);  // no slope but the last
  }
  return torques;
}
}  // namespace

TorsionCurve::TorsionCurve(const Parameters& parameters)
{
  for (const StiffnessRow& row : analyseStiffness(parameters, 0.0, torquesOf(parameters.cup)))
  {
    if (!row.status.ok())
    {
      throw ParameterError("the ring finds no equilibrium under a load of " + numberText(row.torque) +
                           " N.m at the output: " + explanationOf(row.status));
    }
    if (!pieces_.empty())
    {
      Piece& last = pieces_.back();
      last.stiffness = (row.torque - last.torque) / (-row.output_angle - last.torsion);
    }
    pieces_.push_back({ row.torque, -row.output_angle, 0.0 });
  }
  pieces_.pop_back();
}

std::size_t TorsionCurve::pieceAt(double torsion) const noexcept
{
  std::size_t piece = 0;
  while (piece + 1 < pieces_.size() && pieces_[piece + 1].torsion < std::abs(torsion))
  {
    ++piece;
  }
  return piece;
}

double TorsionCurve::torque(double torsion) const noexcept
{
  const Piece& piece = pieces_[pieceAt(torsion)];
  return std::copysign(piece.torque + piece.stiffness * (std::abs(torsion) - piece.torsion), torsion);
}

double TorsionCurve::torsion(double torque) const noexcept
{
  std::size_t number = 0;
  while (number + 1 < pieces_.size() && pieces_[number + 1].torque < std::abs(torque))
  {
    ++number;
  }
  const Piece& piece = pieces_[number];
  return std::copysign(piece.torsion + (std::abs(torque) - piece.torque) / piece.stiffness, torque);
}
}  // namespace hjt
