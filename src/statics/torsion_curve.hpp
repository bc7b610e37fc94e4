// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "base/number_text.hpp"
#include "elements/cup_torsion.hpp"
#include "elements/friction_laws.hpp"
#include "gear/ratio.hpp"
#include "gear/ring_shape.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"

namespace hjt
{
/// Torsion of the gear under load with the wave generator locked and without friction. The curve is odd, and linear
/// between solutions of the ring at multiples of cup.torsion_breakpoints. Beyond the last solution its slope continues.
class TorsionCurve
{
public:
  struct Piece
  {
    double torque{};     ///< torque at the start of the piece [N.m]
    double torsion{};    ///< torsion at the start of the piece [rad]
    double stiffness{};  ///< slope of torque over torsion in the piece [N.m/rad]
  };

  /// Solves the ring at about ten torques. @throws ParameterError if the ring has no equilibrium at one of the torques.
  explicit TorsionCurve(const Parameters& parameters)
  {
    for (const StiffnessRow& row : analyseStiffness(parameters, 0.0, torquesOf(parameters.cup)))
    {
      if (!row.status.ok())
      {
        throw ParameterError("the ring has no equilibrium under a load of " + numberText(row.torque) +
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

  const std::vector<Piece>& pieces() const noexcept { return pieces_; }  ///< pieces for torques >= 0, ascending

  std::size_t pieceAt(double torsion) const noexcept  ///< index of the piece that contains a torsion [rad]
  {
    std::size_t piece = 0;
    while (piece + 1 < pieces_.size() && pieces_[piece + 1].torsion < std::abs(torsion))
    {
      ++piece;
    }
    return piece;
  }

  double torque(double torsion) const noexcept  ///< torque [N.m] for a torsion [rad]
  {
    const Piece& piece = pieces_[pieceAt(torsion)];
    return std::copysign(piece.torque + piece.stiffness * (std::abs(torsion) - piece.torsion), torsion);
  }

  double torsion(double torque) const noexcept  ///< torsion [rad] for a torque [N.m]
  {
    std::size_t number = 0;
    while (number + 1 < pieces_.size() && pieces_[number + 1].torque < std::abs(torque))
    {
      ++number;
    }
    const Piece& piece = pieces_[number];
    return std::copysign(piece.torsion + (std::abs(torque) - piece.torque) / piece.stiffness, torque);
  }

private:
  /// Torques at which the ring is solved [N.m]: below the cup's first breakpoint, up to the second one, and beyond.
  static std::vector<double> torquesOf(const CupParameters& cup)
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
      torques.push_back(1.0);  // any torque, because the curve has only one slope
    }
    return torques;
  }

  std::vector<Piece> pieces_;
};

/// Torsion of the gear over a course of loads with the wave generator locked. The course begins at rest without load.
/// If the friction of the cup has a state (CupFriction::hasState), the torsion is that of the curve at the load minus
/// the torque of this friction.
class TorsionCourse
{
public:
  /// @throws ParameterError if the ring has no equilibrium under load.
  explicit TorsionCourse(const Parameters& parameters)
    : curve_(parameters)
    , cup_(parameters, ToothRing(parameters.gear))
    , friction_(parameters.cup)
    , cup_share_(1.0 - 1.0 / nominalRatio(parameters.gear))
    , friction_torque_(parameters.cup.friction_torque)
  {
  }

  /// Puts the joint at rest without load.
  void reset() noexcept { state_ = CupFriction::State(); }

  /// Changes the load steadily to `torque` [N.m]. @returns the torsion [rad].
  double to(double torque)
  {
    if (!friction_.hasState())
    {
      return curve_.torsion(torque);
    }
    const double cup_torque = cup_share_ * torque;
    double low = cup_.rotationAtTorque(cup_torque - friction_torque_);
    double high = cup_.rotationAtTorque(cup_torque + friction_torque_);
    constexpr int BISECTIONS = 50;
    for (int i = 0; i < BISECTIONS; ++i)
    {
      const double rotation = 0.5 * (low + high);
      const bool beyond = cup_.torque(rotation) + friction_.turned(state_, rotation).torque > cup_torque;
      (beyond ? high : low) = rotation;
    }
    state_ = friction_.turned(state_, 0.5 * (low + high));
    return curve_.torsion(torque - state_.torque / cup_share_);
  }

private:
  TorsionCurve curve_;
  CupTorsion cup_;
  CupFriction friction_;
  double cup_share_;  // share of a load at the output that the cup carries; the wave generator carries the rest [-]
  double friction_torque_;
  CupFriction::State state_;
};
}  // namespace hjt
