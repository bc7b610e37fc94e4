// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Torsion of the gear under load, wave generator locked, friction left out: an odd function, linear between the
/// solutions of the ring at torques in proportion to cup.torsion_breakpoints; the last slope goes on beyond them.
class TorsionCurve
{
public:
  struct Piece
  {
    double torque{};     ///< at its beginning [N.m]
    double torsion{};    ///< at its beginning [rad]
    double stiffness{};  ///< [N.m/rad]
  };

  /// Solves the ring at some ten torques. @throws ParameterError if it finds no equilibrium under one of them.
  explicit TorsionCurve(const Parameters& parameters);

  const std::vector<Piece>& pieces() const noexcept { return pieces_; }  ///< for torques >= 0, ascending
  std::size_t pieceAt(double torsion) const noexcept;  ///< number of the piece that holds a torsion [rad]
  double torque(double torsion) const noexcept;        ///< [N.m]
  double torsion(double torque) const noexcept;        ///< [rad]

private:
  std::vector<Piece> pieces_;
};
}  // namespace hjt
