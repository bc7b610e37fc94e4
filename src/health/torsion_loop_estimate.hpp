// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "harmonic_joint_twin/health/motion_indicators.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "health/running_regression.hpp"

namespace hjt
{
/// Inputs of the drive's torsion at one instant.
struct TorsionSample
{
  double torsion;       ///< motor angle / ratio - output angle [rad]
  double torque;        ///< through the gear, > 0 resists positive motion [N.m]
  double motor_angle;   ///< [rad]
  double output_angle;  ///< [rad]
};

/// Torsion and the torque through the gear that twists it, inertia's share in it, smoothed alike.
///
/// Law:   x = F x_0,   T = F T_0 + J F d^2(phi) / dt^2,   F = 1 / (1 + s t)^2
/// where  x_0, T_0  torsion [rad] and angles as read; torque at one end of the gear [N.m]
///        J, phi    inertia between that end and the gear [kg.m^2], its angle [rad];  t  TIME [s]
/// All lag by the same 2 t, so that torsion and torque of one instant belong together in any motion.
class SmoothedTorsion
{
public:
  void reset() noexcept { age_ = -1.0; }

  /// `given`: as read, the torque without inertia's; `speed`: of phi [rad/s]; `seconds`: since the last sample.
  void update(const TorsionSample& given, double speed, double inertia, double seconds) noexcept
  {
    Values values;
    values << given.torsion, given.torque, given.motor_angle, given.output_angle, speed;
    if (age_ < 0.0)
    {
      age_ = 0.0;
      first_ = values;
      second_ = values;
    }
    const double last_speed = second_[SPEED];
    const double kept = std::exp(-seconds / TIME);
    first_ = kept * first_ + (1.0 - kept) * values;
    second_ = kept * second_ + (1.0 - kept) * first_;
    age_ += seconds;
    const double acceleration = (second_[SPEED] - last_speed) / seconds;
    sample_ = { second_[0], second_[1] + inertia * acceleration, second_[2], second_[3] };
  }

  /// Whether what was before the first sample is forgotten.
  bool settled() const noexcept { return age_ > 12.0 * TIME; }

  const TorsionSample& sample() const noexcept { return sample_; }

private:
  static constexpr double TIME = 0.02;  // [s]
  static constexpr int SPEED = 4;
  using Values = Eigen::Matrix<double, SPEED + 1, 1>;  // those of a sample, and the speed

  Values first_{ Values::Zero() };
  Values second_{ Values::Zero() };
  TorsionSample sample_{};
  double age_{ -1.0 };  // [s]; < 0: nothing came
};

/// Play of a quantity (Prandtl and Ishlinskii's operator): which way it went last.
class Play
{
public:
  explicit Play(double width) : half_(0.5 * width) {}

  /// -1 while the quantity falls, +1 while it rises, between them where it has just turned round.
  double follow(double quantity) noexcept
  {
    centre_ = std::clamp(centre_, quantity - half_, quantity + half_);
    return (quantity - centre_) / half_;
  }

private:
  double half_;
  double centre_{};
};

/// Torsion under a swinging load, over one window.
///
/// Law:   x = a - h p(T) + q p(theta) + T / K1 + c clamp(T, -T0, T0) + (1 / K2 - 1 / K1) sign(T) max(|T| - T1, 0)
///            + e_c cos(phi) + e_s sin(phi),  least squares over the samples
/// where  x, T         torsion [rad], torque through the gear [N.m]
///        theta, phi   motor angle, output angle [rad]
///        p            play: of T as wide as indicators.lost_motion_torque, of theta as DIRECTION_PLAY
///        2 h, 2 q     width of the loop by dry friction in the cup, by that of the teeth: the one turns round with the
///                     torque, the other with the motion [rad]
///        T0, T1       indicators.lost_motion_torque, indicators.stiffness_torque
///        c            softness about no load: clearance, worn teeth
///        e            eccentricity of the output encoder [rad]. A weight twists the drive as sin(phi) too: inertia
///                     tells them apart. With q the mean square of a column of e that the others leave, e comes out at
///                     q^2 / (q^2 + ECCENTRICITY_LEFT^2) of it: all of it, or none. What is left of it is the same in
///                     1 / K1 and 1 / K2 of all windows of a motion, so that their changes have nothing of it
/// Lost motion  angle between the middles of the loop at T0 and -T0: 2 T0 (1 / K1 + c) [rad]
/// Loop area    integral of T over the torsion from one maximum of T to the next, mean of the loops that closed [J]
/// K1 needs T to span health.stiffness_torque_span within T1 on either side of no load, K2 beyond T1 on one side, lost
/// motion 2 T0 on both sides.
class TorsionLoopEstimate
{
public:
  TorsionLoopEstimate(const HealthParameters& health, const IndicatorParameters& parameters)
    : first_torque_(parameters.stiffness_torque)
    , torque_span_(health.stiffness_torque_span)
    , play_(parameters.lost_motion_torque)
    , torque_play_(parameters.lost_motion_torque)
    , direction_play_(DIRECTION_PLAY)
    , regression_(COLUMNS, 1)
  {
    reset();
  }

  void restart() noexcept
  {
    torque_play_ = Play(play_);
    direction_play_ = Play(DIRECTION_PLAY);
    reset();
  }

  /// The next window.
  void reset() noexcept
  {
    regression_.reset();
    lowest_ = 0.0;
    highest_ = 0.0;
    stiffness_ = {};
    second_stiffness_ = {};
    lost_motion_ = {};
    hysteresis_ = {};
    started_ = false;
    area_ = 0.0;
    loops_ = 0;
  }

  /// Every sample in its turn.
  void add(const TorsionSample& sample) noexcept
  {
    const double torque = sample.torque;
    followTorque(sample.torsion, torque);
    const bool first = regression_.rows() == 0.0;
    lowest_ = first ? torque : std::min(lowest_, torque);
    highest_ = first ? torque : std::max(highest_, torque);
    const double beyond = std::copysign(std::max(std::abs(torque) - first_torque_, 0.0), torque);
    Row row;
    row << 1.0, torque, torque_play_.follow(torque), beyond, std::clamp(torque, -play_, play_),
        direction_play_.follow(sample.motor_angle), std::cos(sample.output_angle), std::sin(sample.output_angle);
    regression_.add(row, Eigen::Matrix<double, 1, 1>(sample.torsion));
  }

  void fit() noexcept
  {
    if (!holdEccentricity() || !regression_.fit(COLUMNS))
    {
      return;
    }
    const double slope = regression_.coefficient(SLOPE, 0);
    if (!(slope > 0.0) || regression_.standardError(SLOPE, 0) > MAX_ERROR * slope)
    {
      return;
    }
    const double within =
        std::clamp(highest_, -first_torque_, first_torque_) - std::clamp(lowest_, -first_torque_, first_torque_);
    stiffness_ = { within >= torque_span_, 1.0 / slope };
    const double second = slope + regression_.coefficient(BEYOND, 0);
    second_stiffness_ = { std::max(highest_, -lowest_) - first_torque_ > torque_span_ && second > 0.0, 1.0 / second };
    lost_motion_ = { std::min(highest_, -lowest_) > 2.0 * play_,
                     2.0 * play_ * (slope + regression_.coefficient(SOFTNESS, 0)) };
    hysteresis_ = { highest_ - lowest_ >= torque_span_ && regression_.inflation(BRANCH) < MAX_INFLATION,
                    -2.0 * regression_.coefficient(BRANCH, 0) };
  }

  Indicator stiffness() const noexcept { return stiffness_; }               ///< K1 [N.m/rad]
  Indicator secondStiffness() const noexcept { return second_stiffness_; }  ///< K2 [N.m/rad]
  Indicator lostMotion() const noexcept { return lost_motion_; }            ///< [rad]
  Indicator hysteresis() const noexcept { return hysteresis_; }             ///< 2 h [rad]

  /// [J]
  Indicator loopArea() const noexcept { return loops_ > 0 ? Indicator{ true, area_ / loops_ } : Indicator{}; }

private:
  static constexpr int COLUMNS = 8;
  using Row = Eigen::Matrix<double, COLUMNS, 1>;
  static constexpr int SLOPE = 1;     // column of the torque
  static constexpr int BRANCH = 2;    // of its play
  static constexpr int BEYOND = 3;    // of the torque beyond T1
  static constexpr int SOFTNESS = 4;  // of the torque up to T0
  static constexpr int COSINE = 6;
  static constexpr int SINE = 7;
  static constexpr double MAX_ERROR = 0.1;       // of the slope, standard, as a share of it [-]
  static constexpr double MAX_INFLATION = 10.0;  // of the branch's variance: both branches at like torques [-]
  static constexpr double DIRECTION_PLAY = 0.1;  // of the motor, far above an encoder's noise [rad]
  // What the law leaves of the torsion of a sound drive, 15 urad rms, over an eccentricity, 0.44 mrad
  // (config/real_sensors.yaml), squared, is 1.2e-3: what tells e must be more [-].
  static constexpr double ECCENTRICITY_LEFT = 1.5e-3;
  static constexpr double LEAST_TOLD = 1e-6;  // of q [-]

  /// Ridges on e, each by what tells it. False: too few samples.
  bool holdEccentricity() noexcept
  {
    if (!regression_.fit(COLUMNS))
    {
      return false;
    }
    const double rows = regression_.rows();
    for (const int column : { COSINE, SINE })
    {
      const double told = regression_.mean(column, column) / regression_.inflation(column);
      Row row = Row::Zero();
      row[column] = ECCENTRICITY_LEFT * std::sqrt(rows / std::max(told, LEAST_TOLD));
      regression_.add(row, Eigen::Matrix<double, 1, 1>(0.0));
    }
    return true;
  }

  void followTorque(double torsion, double joint_torque) noexcept
  {
    if (!started_)
    {
      started_ = true;
      rising_ = true;
      past_first_ = false;
      extreme_ = joint_torque;
      work_ = 0.0;
    }
    else
    {
      work_ += 0.5 * (joint_torque + torque_) * (torsion - torsion_);
    }
    torsion_ = torsion;
    torque_ = joint_torque;
    extreme_ = rising_ ? std::max(extreme_, joint_torque) : std::min(extreme_, joint_torque);
    if (std::abs(joint_torque - extreme_) > play_)
    {
      // Seen as late after each maximum, so that what a loop is short of at its start it has more at its end.
      if (rising_)
      {
        area_ += past_first_ ? work_ : 0.0;
        loops_ += past_first_ ? 1 : 0;
        past_first_ = true;
        work_ = 0.0;
      }
      rising_ = !rising_;
      extreme_ = joint_torque;
    }
  }

  double first_torque_;  // T1 [N.m]
  double torque_span_;
  double play_;  // T0 [N.m]
  Play torque_play_;
  Play direction_play_;
  RunningRegression regression_;
  double lowest_{};   // torque in the regression [N.m]
  double highest_{};  // [N.m]
  Indicator stiffness_;
  Indicator second_stiffness_;
  Indicator lost_motion_;
  Indicator hysteresis_;

  bool started_{};
  bool rising_{};
  double extreme_{};   // of the torque since it turned round last [N.m]
  double torsion_{};   // of the last sample [rad]
  double torque_{};    // of the last sample [N.m]
  double work_{};      // since the last maximum was seen [J]
  bool past_first_{};  // a maximum has been seen: the loop running now is a whole one
  double area_{};      // of the loops that closed [J]
  int loops_{};
};
}  // namespace hjt
