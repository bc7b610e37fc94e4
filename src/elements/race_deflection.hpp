// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Radius of the bearing's outer race over that of the rim's bore, both free and round: the fit and what the wave
/// generator's excess of temperature adds to it. > 0 interference [m].
inline double raceFit(const Parameters& parameters) noexcept
{
  constexpr double EXPANSION = 11.5e-6;  // of steel [1/K]
  return parameters.contact.fit +
         EXPANSION * parameters.gear.flexspline_inner_radius * parameters.contact.temperature_difference;
}

/// By how much the outer race of the wave generator's bearing sags under the rim because balls do not carry.
///
/// Ball k:   psi_k = 2 pi k / Z + (1 - s) (1 - d/D)/2 theta     its place in the housing, the outer race standing [rad]
///           phi_k = k GOLDEN - (1 - s) (D/d - d/D)/2 theta     its own turn against the cage; 0 where a spot on it
///                                                              meets the outer race, pi the inner race [rad]
/// Sag:      g_i = sum_k h_k(theta) (1 + cos(Z (psi_i - psi_k) / 2)) / 2  within one ball pitch of psi_i, the place of
///                 tooth i at rest: all balls lower by h lower the whole race by h                            [m]
/// where     h_k  how far ball k drops: over a spall of depth h the raised cosine h (1 + cos(pi x / b)) / 2, x from its
///                middle, b half its length over the radius it lies on; into it as far as it fits, l^2 / (4 d)  [m]
///           Z, d, D  number and diameter of the balls, their pitch diameter
///           s    share of slip: balls roll on the outer race and slip on the inner one, which drives them
///
/// A sound bearing is the rigid ellipse that the contact knows.
class RaceDeflection
{
public:
  explicit RaceDeflection(const BearingParameters& bearing);

  bool sound() const noexcept { return size_ == 0; }

  /// A spall `depth` deep and `length` long [m]; `place`: angle along the inner race from the wave generator's angle,
  /// along the outer race from tooth 0 [rad]; ball from 0 on. No more than MAX_FAULTS in all.
  void addInnerSpall(double place, double depth, double length) noexcept;
  void addOuterSpall(double place, double depth, double length) noexcept;
  void addBallSpall(int ball, double depth, double length) noexcept;
  /// A ball that carries nothing: the race over it sags by `depth` [m].
  void addIdleBall(int ball, double depth) noexcept;

  /// Sag over each tooth, N [m], and its first and second derivative by the wave generator's angle.
  void at(double wave_generator_angle, Eigen::VectorXd& sag, Eigen::VectorXd& rate,
          Eigen::VectorXd& second) const noexcept;

  /// A value with its derivatives by the wave generator's angle.
  struct Drop
  {
    double value{};   ///< [m]
    double rate{};    ///< [m/rad]
    double second{};  ///< [m/rad^2]
  };
  /// How far a ball drops through all its spalls.
  Drop drop(int ball, double wave_generator_angle) const noexcept;

  /// Share of a ball's drop that the race sags by, at an angle from the ball [-].
  static double shareAt(double angle, double ball_pitch) noexcept;

  /// No ball drops deeper [m].
  double deepest() const noexcept;
  /// Whether no two balls ever drop at once: one defect, shorter than from ball to ball.
  bool dropsOneBall() const noexcept;
  /// If so or the bearing is sound: no ball but this one drops at the wave generator's angle [rad].
  int ballThatMayDrop(double wave_generator_angle) const noexcept;

  int balls() const noexcept { return balls_; }
  /// Of a ball in the housing [rad], not within a turn.
  double ballPlace(int ball, double wave_generator_angle) const noexcept;
  double cageRate() const noexcept { return cage_rate_; }  ///< turns of the cage per turn of the wave generator [-]

private:
  enum class Where
  {
    INNER_RACE,
    OUTER_RACE,
    BALL,
    UNDER_BALL
  };
  struct Spall
  {
    Where where;
    int ball;
    double place;  // [rad]
    double depth;  // [m]
    double half;   // half its length, as an angle [rad]
  };
  void add(const Spall& spall) noexcept;
  double dropInto(double depth, double length) const noexcept;
  Drop drop(const Spall& spall, int ball, double angle) const noexcept;

  int balls_;
  double ball_diameter_;
  double pitch_diameter_;
  double cage_rate_;
  double spin_rate_;
  std::array<Spall, MAX_FAULTS> spalls_{};
  std::size_t size_{};
};
}  // namespace hjt
