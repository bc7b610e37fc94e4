// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>

#include <Eigen/Core>

#include "elements/joint_friction.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Dry friction beside the cup's spring: microscopic slip where the cup is clamped to the housing, and in its steel. It
/// acts on the mean rotation Phi of the rim, so it costs nothing while the drive runs at constant load; it opens the
/// torsion loop and damps the output when the motor stands.
///
/// cup.friction_angle 0: one rigid-plastic element, a dry term of cup.friction_torque F.
/// Above: ELEMENTS springs side by side, each with a slider in series (Maxwell slip, Masing's model)
///
///   torque   sum_j k z_j,   z_j' = Phi' while |z_j| < w_j or Phi' leads back, else 0
///   stored   sum_j k z_j^2 / 2;   dissipated where an element slips: k w_j per rad
/// where      w_j = (a / 2) 3^-j, j = 0 ... 5; a the friction angle [rad]; k = F / sum_j w_j [N.m/rad]
///
/// Equal springs over widths that treble lose about the same share of the stored energy at amplitudes from w_5 to w_0,
/// a range of 1 to 243, as structural damping does. Rate-independent. After a reversal all of it has turned round when
/// the rim has turned by a.
class CupFriction
{
public:
  static constexpr int ELEMENTS = 6;

  explicit CupFriction(const CupParameters& parameters)
    : torque_(parameters.friction_torque), width_(0.5 * parameters.friction_angle)
  {
    scale(1.0);
  }

  void scale(double factor) noexcept
  {
    torque_ *= factor;
    double widths = 0.0;
    for (int j = 0; j < ELEMENTS; ++j)
    {
      widths = widths / RATIO + width_;
    }
    stiffness_ = hasState() ? ELEMENTS * torque_ / widths : 0.0;
  }

  /// Springs with sliders, which have a state; else one dry term.
  bool hasState() const noexcept { return torque_ > 0.0 && width_ > 0.0; }

  /// State of springs and sliders, and the torque that follows from it at `rotation`.
  struct State
  {
    std::array<double, ELEMENTS> twist{};  ///< z [rad]
    double rotation{};                     ///< Phi [rad]
    double torque{};                       ///< against positive rotation [N.m]
    double stiffness{};                    ///< of the elements that do not slip [N.m/rad]
    double energy{};                       ///< stored [J]
    double slipped{};                      ///< energy dissipated on the way to `rotation` from the state before [J]
  };

  /// The state without torque at a rotation [rad].
  State relaxed(double rotation) const noexcept
  {
    State state;
    state.rotation = rotation;
    state.stiffness = stiffness();
    return state;
  }

  /// After a monotone turn to `rotation` [rad]. `from`: its twist and rotation count.
  inline __attribute__((always_inline)) State turned(const State& from, double rotation) const noexcept
  {
    using Elements = Eigen::Array<double, ELEMENTS, 1>;
    const double spring = stiffness() / ELEMENTS;
    const Elements width = width_ * Eigen::Map<const Elements>(SHARES.data());
    const Elements free = Eigen::Map<const Elements>(from.twist.data()) + (rotation - from.rotation);
    const Elements twist = free.min(width).max(-width);
    State state;
    state.rotation = rotation;
    Eigen::Map<Elements>(state.twist.data()) = twist;
    state.torque = spring * twist.sum();
    state.energy = 0.5 * spring * twist.square().sum();
    state.slipped = spring * (width * (free - twist).abs()).sum();
    state.stiffness = spring * static_cast<double>((free == twist).count());
    return state;
  }

  /// Of all elements together, before any slips: the largest [N.m/rad].
  double stiffness() const noexcept { return stiffness_; }

  /// The rigid-plastic element's term, by the mean rotation's rates by motor and output angle [-]; none where there is
  /// no friction or it has a state.
  void addTerm(const Eigen::Vector2d& rates, JointFriction& friction) const noexcept
  {
    if (isTerm())
    {
      friction.terms.push_back({ torque_, rates });
    }
  }
  bool isTerm() const noexcept { return torque_ > 0.0 && !hasState(); }

private:
  static constexpr double RATIO = 3.0;  // width of an element over that of the next
  // Of an element's width to the widest.
  static constexpr std::array<double, ELEMENTS> SHARES{
    1.0, 1.0 / 3.0, 1.0 / 9.0, 1.0 / 27.0, 1.0 / 81.0, 1.0 / 243.0
  };

  double torque_;  // sum of what the elements slip at [N.m]
  double width_;   // of the widest element [rad]
  double stiffness_{};
};
}  // namespace hjt
