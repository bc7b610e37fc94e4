// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include "gear/ratio.hpp"
#include "harmonic_joint_twin/health/motion_indicators.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "health/running_regression.hpp"

namespace hjt
{
/// Torsion of the drive at one instant, with the quantities that it depends on.
struct TorsionSample
{
  double torsion;       ///< motor angle / ratio - output angle [rad]
  double torque;        ///< torque through the gear, > 0 resists positive motion [N.m]
  double motor_angle;   ///< [rad]
  double output_angle;  ///< [rad]
};

/// Two first-order lags in series, for several quantities.
///
/// Law:   y = F x,   F = 1 / (1 + s t)^2,   t = TIME
/// where  x, y  quantity, smoothed quantity;  s  Laplace variable
/// All quantities lag by the same time 2 t, so their smoothed values belong to one instant in any motion.
template <int COUNT>
class TwiceSmoothed
{
public:
  static constexpr double TIME = 0.02;  ///< time constant t [s]
  using Values = Eigen::Matrix<double, COUNT, 1>;

  void reset() noexcept { age_ = -1.0; }

  /// Smooths the next values. `seconds`: time since the previous values [s].
  void update(const Values& values, double seconds) noexcept
  {
    if (age_ < 0.0)
    {
      age_ = 0.0;
      first_ = values;
      second_ = values;
    }
    const double kept = std::exp(-seconds / TIME);
    const Values before = second_;
    first_ = kept * first_ + (1.0 - kept) * values;
    second_ = kept * second_ + (1.0 - kept) * first_;
    rates_ = (second_ - before) / seconds;
    age_ += seconds;
  }

  const Values& values() const noexcept { return second_; }
  const Values& rates() const noexcept { return rates_; }  ///< change of `values` per second in the last update

  /// Whether the initial transient of the filter has decayed.
  bool settled() const noexcept { return age_ > 12.0 * TIME; }

private:
  Values first_{ Values::Zero() };
  Values second_{ Values::Zero() };
  Values rates_{ Values::Zero() };
  double age_{ -1.0 };  // [s]; < 0: no values yet
};

/// Play operator (Prandtl and Ishlinskii): the direction in which a quantity moved last.
class Play
{
public:
  explicit Play(double width) : half_(0.5 * width) {}

  /// Returns -1 while the quantity falls, +1 while it rises, and between -1 and +1 within `width` after a reversal.
  double follow(double quantity) noexcept
  {
    centre_ = std::clamp(centre_, quantity - half_, quantity + half_);
    return (quantity - centre_) / half_;
  }

private:
  double half_;
  double centre_{};
};

/// Stiffness, lost motion and hysteresis under a load that swings, over one window.
///
/// The estimate smooths the measured torsion and adds inertia to the torque: x = F x_0,  T = F T_0 + J F d^2(psi)/dt^2
/// where  F         filter of TwiceSmoothed
///        x_0, T_0  measured torsion [rad], torque at one end of the gear [N.m]
///        J, psi    inertia between that end and the gear [kg.m^2], angle of J at the joint [rad]
/// Law:   x = a - h p(T) + q p(theta) + T / K1 + c clamp(T, -T0, T0) + (1 / K2 - 1 / K1) sign(T) max(|T| - T1, 0)
///            + e_c cos(phi) + e_s sin(phi),  least squares over the samples
/// where  x, T         torsion [rad], torque through the gear [N.m]
///        theta, phi   motor angle, output angle [rad]
///        p            Play, with the width indicators.lost_motion_torque for T and DIRECTION_PLAY for theta
///        2 h, 2 q     width of the loop by dry friction in the cup (sign of the torque's change) and in the teeth
///                     (sign of the motion) [rad]
///        T0, T1       indicators.lost_motion_torque, indicators.stiffness_torque [N.m]
///        a, K1, K2    offset [rad], stiffness below and above T1 [N.m/rad]
///        c            additional compliance near zero load, by clearance and worn teeth [rad/(N.m)]
///        e            eccentricity of the output encoder [rad]. A weight also twists the drive by sin(phi); only
///                     inertia separates weight and eccentricity. With u the mean square of the column of e that the
///                     other columns do not explain, the ridge keeps the share u^2 / (u^2 + ECCENTRICITY_LEFT^2) of e,
///                     almost all or almost none. The error of 1 / K1 and 1 / K2 that remains is equal in all windows
///                     of a motion, so it does not affect their changes
/// Lost motion  angle between the middles of the loop at T0 and -T0: 2 T0 (1 / K1 + c) [rad]
/// Loop area    integral of T over the torsion from one maximum of T to the next, mean over the closed loops [J]
/// K1 is valid if T spans health.stiffness_torque_span within -T1 ... T1, and K2 if T exceeds T1 by this span on one
/// side. The lost motion is valid if T reaches 2 T0 on both sides.
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
    interrupt();
    reset();
  }

  /// Restarts the filter after a sample without torsion.
  void interrupt() noexcept { smoothed_.reset(); }

  /// Begins the next window.
  void reset() noexcept
  {
    regression_.reset();
    lowest_ = 0.0;
    highest_ = 0.0;
    started_ = false;
    area_ = 0.0;
    loops_ = 0;
  }

  /// Adds the next sample. `given`: sample with the torque T_0; `speed`: speed of psi [rad/s]; `inertia`: J [kg.m^2];
  /// `seconds`: time since the last sample [s].
  void add(const TorsionSample& given, double speed, double inertia, double seconds) noexcept
  {
    TwiceSmoothed<5>::Values read;
    read << given.torsion, given.torque, given.motor_angle, given.output_angle, speed;
    smoothed_.update(read, seconds);
    if (!smoothed_.settled())
    {
      return;
    }
    const auto& values = smoothed_.values();
    const double torque = values[1] + inertia * smoothed_.rates()[4];
    followTorque(values[0], torque);
    const bool first = regression_.rows() == 0.0;
    lowest_ = first ? torque : std::min(lowest_, torque);
    highest_ = first ? torque : std::max(highest_, torque);
    const double beyond = std::copysign(std::max(std::abs(torque) - first_torque_, 0.0), torque);
    Row row;
    row << 1.0, torque, torque_play_.follow(torque), beyond, std::clamp(torque, -play_, play_),
        direction_play_.follow(values[2]), std::cos(values[3]), std::sin(values[3]);
    regression_.add(row, Eigen::Matrix<double, 1, 1>(values[0]));
  }

  struct Found
  {
    Indicator stiffness;         ///< K1 [N.m/rad]
    Indicator second_stiffness;  ///< K2 [N.m/rad]
    Indicator lost_motion;       ///< lost motion [rad]
    Indicator hysteresis;        ///< hysteresis 2 h [rad]
    Indicator loop_area;         ///< mean area of the closed loops [J]
  };

  Found fit() noexcept
  {
    Found found;
    found.loop_area = loops_ > 0 ? Indicator{ true, area_ / loops_ } : Indicator{};
    if (!holdEccentricity() || !regression_.fit(COLUMNS))
    {
      return found;
    }
    const double slope = regression_.coefficient(SLOPE, 0);
    if (!(slope > 0.0) || regression_.standardError(SLOPE, 0) > MAX_ERROR * slope)
    {
      return found;
    }
    const double within =
        std::clamp(highest_, -first_torque_, first_torque_) - std::clamp(lowest_, -first_torque_, first_torque_);
    found.stiffness = { within >= torque_span_, 1.0 / slope };
    const double second = slope + regression_.coefficient(BEYOND, 0);
    found.second_stiffness = { std::max(highest_, -lowest_) - first_torque_ > torque_span_ && second > 0.0,
                               1.0 / second };
    found.lost_motion = { std::min(highest_, -lowest_) > 2.0 * play_,
                          2.0 * play_ * (slope + regression_.coefficient(SOFTNESS, 0)) };
    found.hysteresis = { highest_ - lowest_ >= torque_span_ && regression_.inflation(BRANCH) < MAX_INFLATION,
                         -2.0 * regression_.coefficient(BRANCH, 0) };
    return found;
  }

private:
  static constexpr int COLUMNS = 8;
  using Row = Eigen::Matrix<double, COLUMNS, 1>;
  static constexpr int SLOPE = 1;     // column of the torque T
  static constexpr int BRANCH = 2;    // column of the play of T
  static constexpr int BEYOND = 3;    // column of the torque beyond T1
  static constexpr int SOFTNESS = 4;  // column of the torque up to T0
  static constexpr int COSINE = 6;
  static constexpr int SINE = 7;
  static constexpr double MAX_ERROR = 0.1;  // largest standard error of the slope, as a share of the slope [-]
  // Largest inflation of the variance of h [-]. The inflation grows if the loop's branches lie at different torques.
  static constexpr double MAX_INFLATION = 10.0;
  static constexpr double DIRECTION_PLAY = 0.1;  // width of the play of the motor angle, far above encoder noise [rad]
  // Mean square that e's column needs after regression on the other columns, to determine e [-]. The value exceeds
  // (15 urad / 0.44 mrad)^2: the law's residual for a sound drive over the eccentricity in config/real_sensors.yaml.
  static constexpr double ECCENTRICITY_LEFT = 1.5e-3;
  static constexpr double LEAST_TOLD = 1e-6;  // lower bound of the mean square of e's column, for the ridge [-]

  /// Adds a ridge for e_c and e_s, larger if other columns explain their column. Returns false if samples are too few.
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
      // A maximum is detected only after a fall by play_: a loop gains at its end the area that it lacks at its start.
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
  double torque_span_;   // health.stiffness_torque_span [N.m]
  double play_;          // T0 [N.m]
  Play torque_play_;
  Play direction_play_;
  TwiceSmoothed<5> smoothed_;  // fields of TorsionSample and speed of psi
  RunningRegression regression_;
  double lowest_{};   // lowest torque in the regression [N.m]
  double highest_{};  // highest torque in the regression [N.m]

  bool started_{};
  bool rising_{};
  double extreme_{};   // extreme of the torque since its last reversal [N.m]
  double torsion_{};   // torsion of the last sample [rad]
  double torque_{};    // torque of the last sample [N.m]
  double work_{};      // integral of the torque over the torsion since the last maximum of the torque [J]
  bool past_first_{};  // whether the torque has had a maximum, so that the next maximum closes a loop
  double area_{};      // sum of the areas of the closed loops [J]
  int loops_{};
};

/// Computes transmission ratio and kinematic error from the torsion over the last turn of the motor.
///
/// The class stores the torsion at marks that are evenly spaced in the motor angle. Each tooth of the flexspline has 16
/// marks, because the error of a sound gear repeats every tooth pitch. The torsion at a mark is interpolated linearly
/// between the samples before and after it. The store holds one turn at any speed.
///
/// If the motor returns to the mark before the last one, the class empties the store. A smaller return (up to 2 mrad
/// with 200 teeth) keeps the store. The two indicators are valid if the store is full, that is, after one turn and one
/// or two marks of travel in one direction since the start or the last reversal.
class TurnWindow
{
public:
  explicit TurnWindow(const GearParameters& gear);

  void reset() noexcept;

  /// `torsion`: motor angle / nominal ratio - output angle [rad]. An angle beyond 1e15 marks, or not finite, empties
  /// the store.
  void update(double motor_angle, double torsion) noexcept;

  /// Travel of the motor over travel of the output in the last turn of the motor [-]. The ratio is not valid if the
  /// store is not full, or if the output moved by less than a millionth of the output's nominal travel.
  Indicator transmissionRatio() const noexcept;

  /// Peak to peak of the torsion at the marks of the last turn, minus the straight line through the ends of the turn
  /// [rad]. The line removes the torsion by a load that changes steadily. The line does not affect errors with a whole
  /// number of cycles per turn, which are equal at both ends. A line by least squares would affect these errors.
  Indicator kinematicError() const noexcept;

private:
  bool full() const noexcept { return count_ == torsions_.size(); }
  void keep(double place, double slope, std::int64_t marks) noexcept;
  double torsionAt(Eigen::Index marks_back) const noexcept;

  double nominal_ratio_;
  std::int64_t marks_per_turn_;
  double marks_per_radian_;

  // A place is the motor angle in marks. The sign of a place is such that the place grows in the direction of travel.
  bool started_{};
  int direction_{ 1 };
  double place_{};              // place of the last sample
  double torsion_{};            // torsion of the last sample [rad]
  std::int64_t newest_mark_{};  // number of the last mark that the motor reached
  Eigen::VectorXd torsions_;    // ring buffer of torsions at the marks of one turn and one mark, ends included [rad]
  Eigen::Index newest_{};
  Eigen::Index count_{};
};

/// Exponential forgetting in time: the weight of a value falls to 1/e in the time `window`.
class Forgetting
{
public:
  /// `window`: time constant [s].
  explicit Forgetting(double window) : window_(window) {}

  /// Factor on a weight after the time `elapsed` [ns]. The class stores the last factor, because most steps are equal.
  double kept(std::int64_t elapsed) noexcept
  {
    if (elapsed != elapsed_)
    {
      elapsed_ = elapsed;
      kept_ = std::exp(-1e-9 * static_cast<double>(elapsed) / window_);
    }
    return kept_;
  }

private:
  double window_;
  std::int64_t elapsed_{};
  double kept_{ 1.0 };
};

/// Efficiency of the drive between the motor shaft and the circular spline.
///
/// Law:   eta = <P_j> / <P_m>  if the motor drives, both means > 0;   eta = <P_m> / <P_j>  if the load drives, both < 0
/// where  P_m  power from the motor: motor torque times motor speed [W]
///        P_j  power from the circular spline to the load: joint torque times output speed [W]
///        <>   exponential mean over `health.averaging_time`
///
/// The efficiency is not valid
/// - during the first `health.averaging_time`,
/// - near standstill, with a mean power below 0.1 W,
/// - if the power does not flow steadily in one direction: the means must have equal signs, and each must be at least
///   90 % of the mean magnitude of its power,
/// - if the output power is more than 1 % larger than the input power, because a mass slows down.
class EfficiencyEstimate
{
public:
  explicit EfficiencyEstimate(const HealthParameters& parameters)
    : window_(std::llround(1e9 * parameters.averaging_time)), forgetting_(parameters.averaging_time)
  {
  }

  void reset() noexcept
  {
    age_ = 0;
    motor_ = {};
    joint_ = {};
  }

  /// Adds a sample. `elapsed`: time since the last sample [ns]; `motor_power`, `joint_power`: P_m, P_j [W].
  void update(std::int64_t elapsed, double motor_power, double joint_power) noexcept
  {
    age_ += elapsed;
    const double kept = forgetting_.kept(elapsed);
    motor_.update(kept, motor_power);
    joint_.update(kept, joint_power);
  }

  Indicator efficiency() const noexcept
  {
    const bool driving = motor_.mean() > 0.0;
    if (age_ < window_ || !motor_.steady() || !joint_.steady() || driving != (joint_.mean() > 0.0))
    {
      return {};
    }
    const double efficiency = driving ? joint_.mean() / motor_.mean() : motor_.mean() / joint_.mean();
    if (efficiency > MAX_EFFICIENCY)
    {
      return {};
    }
    return { true, efficiency };
  }

private:
  static constexpr double MIN_POWER = 0.1;     // least magnitude of a mean power [W]
  static constexpr double STEADY_SHARE = 0.9;  // least magnitude of a mean power over the mean of its magnitude [-]
  static constexpr double MAX_EFFICIENCY = 1.01;

  /// Mean of a power and of its magnitude.
  class PowerMean
  {
  public:
    void update(double kept, double power) noexcept
    {
      mean_ = kept * mean_ + (1.0 - kept) * power;
      magnitude_ = kept * magnitude_ + (1.0 - kept) * std::abs(power);
    }

    bool steady() const noexcept
    {
      return std::abs(mean_) >= MIN_POWER && std::abs(mean_) >= STEADY_SHARE * magnitude_;
    }

    double mean() const noexcept { return mean_; }  // [W]

  private:
    double mean_{};       // [W]
    double magnitude_{};  // [W]
  };

  std::int64_t window_;  // [ns]
  Forgetting forgetting_;
  std::int64_t age_{};  // time since start or reset [ns]
  PowerMean motor_;
  PowerMean joint_;
};

/// Range of a quantity (largest minus least value) over the current window of fixed length and the previous window.
class RecentSpan
{
public:
  /// `window`: length of one window [ns].
  explicit RecentSpan(std::int64_t window) : window_(window) {}

  void reset() noexcept { *this = RecentSpan(window_); }

  void update(std::int64_t elapsed, double value) noexcept
  {
    age_ += elapsed;
    if (!started_ || age_ >= window_)
    {
      age_ = 0;
      before_ = started_ ? running_ : Extremes{ value, value };
      running_ = { value, value };
      started_ = true;
    }
    running_ = { std::min(running_.lowest, value), std::max(running_.highest, value) };
  }

  double span() const noexcept
  {
    return std::max(running_.highest, before_.highest) - std::min(running_.lowest, before_.lowest);
  }

private:
  struct Extremes
  {
    double lowest{};
    double highest{};
  };

  std::int64_t window_;
  std::int64_t age_{};  // age of the current window [ns]
  bool started_{};
  Extremes running_;
  Extremes before_;
};

/// Torsional stiffness of the drive: slope of the joint torque over the torsion.
///
/// Law:   T = T_0 + K tau,  recursive least squares
/// where  T    joint torque;  T_0  its offset        [N.m]
///        tau  torsion                               [rad]
///        K    torsional stiffness                   [N.m/rad]
/// The weight of a sample is the time since the last sample, and decays exponentially with health.averaging_time.
/// The stiffness is valid if the torque spanned `health.stiffness_torque_span` in the current or the previous window.
class StiffnessEstimate
{
public:
  explicit StiffnessEstimate(const HealthParameters& parameters)
    : torque_span_(parameters.stiffness_torque_span)
    , forgetting_(parameters.averaging_time)
    , recent_torque_(std::llround(1e9 * parameters.averaging_time))
  {
  }

  void reset() noexcept
  {
    recent_torque_.reset();
    weight_ = 0.0;
    torsion_mean_ = 0.0;
    torque_mean_ = 0.0;
    torsion_square_ = 0.0;
    product_ = 0.0;
  }

  /// `elapsed`: time since the last sample [ns]; `torsion` [rad]; `joint_torque` [N.m].
  void update(std::int64_t elapsed, double torsion, double joint_torque) noexcept
  {
    recent_torque_.update(elapsed, joint_torque);
    const double kept = forgetting_.kept(elapsed);
    const double time = 1e-9 * static_cast<double>(elapsed);
    weight_ = kept * weight_ + time;
    const double share = time / weight_;
    const double torsion_step = torsion - torsion_mean_;
    const double torque_step = joint_torque - torque_mean_;
    torsion_mean_ += share * torsion_step;
    torque_mean_ += share * torque_step;
    const double remaining = time * (1.0 - share);
    torsion_square_ = kept * torsion_square_ + remaining * torsion_step * torsion_step;
    product_ = kept * product_ + remaining * torsion_step * torque_step;
  }

  Indicator stiffness() const noexcept
  {
    if (recent_torque_.span() < torque_span_ || !(torsion_square_ > 0.0))
    {
      return {};
    }
    return { true, product_ / torsion_square_ };
  }

private:
  double torque_span_;
  Forgetting forgetting_;
  RecentSpan recent_torque_;
  // Weighted sums about the running means, because differences of plain sums would lose the slope in rounding errors.
  double weight_{};          // [s]
  double torsion_mean_{};    // [rad]
  double torque_mean_{};     // [N.m]
  double torsion_square_{};  // [rad^2 s]
  double product_{};         // [N.m rad s]
};

/// State of the model's joint at one instant, with true angles instead of encoder readings.
struct HealthSample
{
  std::int64_t stamp{};      ///< [ns]
  double motor_angle{};      ///< [rad]
  double motor_velocity{};   ///< [rad/s]
  double output_angle{};     ///< [rad]
  double output_velocity{};  ///< [rad/s]
  double motor_torque{};     ///< torque that the motor applies to its shaft [N.m]
  double joint_torque{};     ///< torque of the mesh on the circular spline [N.m]
};

/// Computes the MotionIndicators of a joint step by step. Only the constructor allocates.
class HealthMonitor
{
public:
  HealthMonitor(const HealthParameters& parameters, const GearParameters& gear)
    : nominal_ratio_(nominalRatio(gear)), turn_(gear), stiffness_(parameters), efficiency_(parameters)
  {
  }

  void reset() noexcept
  {
    started_ = false;
    torsion_ = 0.0;
    turn_.reset();
    stiffness_.reset();
    efficiency_.reset();
  }

  /// Adds a sample. Stamps must ascend; call `reset` before a restart of time.
  void update(const HealthSample& sample) noexcept
  {
    torsion_ = sample.motor_angle / nominal_ratio_ - sample.output_angle;
    turn_.update(sample.motor_angle, torsion_);
    // The first sample has no time since a last sample.
    if (started_)
    {
      const std::int64_t elapsed = sample.stamp - stamp_;
      stiffness_.update(elapsed, torsion_, sample.joint_torque);
      efficiency_.update(elapsed, sample.motor_torque * sample.motor_velocity,
                         sample.joint_torque * sample.output_velocity);
    }
    started_ = true;
    stamp_ = sample.stamp;
  }

  MotionIndicators indicators() const noexcept
  {
    return { turn_.transmissionRatio(), torsion_, stiffness_.stiffness(), efficiency_.efficiency(),
             turn_.kinematicError() };
  }

private:
  double nominal_ratio_;
  bool started_{};
  std::int64_t stamp_{};  // stamp of the last sample [ns]
  double torsion_{};      // [rad]
  TurnWindow turn_;
  StiffnessEstimate stiffness_;
  EfficiencyEstimate efficiency_;
};
}  // namespace hjt
