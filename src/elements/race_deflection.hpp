// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Radius of the bearing's outer race minus radius of the rim's bore, when both are free and round [m]. The difference
/// is the fit plus the thermal expansion by contact.temperature_difference. > 0: the bearing is tight in the rim.
inline double raceFit(const Parameters& parameters) noexcept
{
  constexpr double EXPANSION = 11.5e-6;  // coefficient of thermal expansion of steel [1/K]
  return parameters.contact.fit +
         EXPANSION * parameters.gear.flexspline_inner_radius * parameters.contact.temperature_difference;
}

/// Deflection (sag) of the outer race of the wave generator's bearing under the rim, where a ball carries no load.
///
/// Ball k:   psi_k = 2 pi k / Z + (1 - s) (1 - d/D)/2 theta     angle of the ball, with the outer race at rest [rad]
///           phi_k = k GOLDEN - (1 - s) (D/d - d/D)/2 theta     rotation of the ball in the cage [rad]; a spot on the
///                                                              ball meets the outer race at 0, the inner race at pi
/// Sag:      g_i = sum_k h_k(theta) (1 + cos(Z (psi_i - psi_k) / 2)) / 2, over the balls k within one ball pitch of
///                 psi_i, the angle of tooth i at rest; if all balls drop by h, the whole race drops by h          [m]
/// where     theta  wave generator angle [rad]; Z, d  number and diameter of the balls; D  pitch diameter [m]
///           h_k  drop of ball k: for a spall of depth h the raised cosine h (1 + cos(pi x / b)) / 2, x = angle of the
///                ball from the middle of the spall, b = half the length of the spall as an angle; h is at most
///                l^2 / (4 d), l = length of the spall                                                             [m]
///           s    slip: balls roll on the outer race and slip on the inner race, which drives them                 [-]
///
/// In a sound bearing the sag is zero and the wave generator is a rigid ellipse.
class RaceDeflection
{
public:
  explicit RaceDeflection(const BearingParameters& bearing);

  bool sound() const noexcept { return size_ == 0; }

  /// Adds a spall of `depth` and `length` [m]. `place`: angle of the spall on the inner race from the major axis, or on
  /// the outer race from tooth 0 [rad]. `ball`: number of the ball from 0. A bearing has at most MAX_FAULTS faults.
  void addInnerSpall(double place, double depth, double length) noexcept;
  void addOuterSpall(double place, double depth, double length) noexcept;
  void addBallSpall(int ball, double depth, double length) noexcept;
  /// Adds a ball that carries no load. The race sags by `depth` over this ball [m].
  void addIdleBall(int ball, double depth) noexcept;

  /// Sag at each tooth [m], with its first and second derivative by the wave generator's angle.
  void at(double wave_generator_angle, Eigen::VectorXd& sag, Eigen::VectorXd& rate,
          Eigen::VectorXd& second) const noexcept;

  /// Drop of a ball with its derivatives by the wave generator's angle.
  struct Drop
  {
    double value{};   ///< drop [m]
    double rate{};    ///< derivative of the drop by the wave generator's angle [m/rad]
    double second{};  ///< second derivative of the drop [m/rad^2]
  };
  /// Sum of the drops of a ball by all faults of the bearing.
  Drop drop(int ball, double wave_generator_angle) const noexcept;

  /// Sag of the race at `angle` from a ball, divided by the drop of this ball [-].
  static double shareAt(double angle, double ball_pitch) noexcept;

  /// Upper bound of the drop of any ball [m].
  double deepest() const noexcept;
  /// Whether at most one ball drops at a time, because there is one fault and it is shorter than a ball pitch.
  bool dropsOneBall() const noexcept;
  /// Index of the ball that may drop at a wave generator angle [rad], if dropsOneBall(); no other ball drops. If the
  /// bearing is sound, the drop of every ball is 0.
  int ballThatMayDrop(double wave_generator_angle) const noexcept;

  int balls() const noexcept { return balls_; }
  /// Angle of a ball in the housing, not reduced to one turn [rad].
  double ballPlace(int ball, double wave_generator_angle) const noexcept;
  double cageRate() const noexcept { return cage_rate_; }  ///< speed of the cage over that of the wave generator [-]

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
    double place;  // angle of the spall [rad]
    double depth;  // depth of the spall [m]
    double half;   // half the length of the spall as an angle [rad]
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
