// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include <Eigen/Core>
#include <Eigen/Dense>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/health/motion_indicators.hpp"
#include "harmonic_joint_twin/health/signal_indicators.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "health/health_monitor.hpp"
#include "health/order_tracker.hpp"
#include "health/running_regression.hpp"

namespace hjt
{
constexpr double NOT_MEASURED = std::numeric_limits<double>::quiet_NaN();

/// Signals of a drive's own sensors at one instant. A signal that is not measured stays NaN. Some indicators need both
/// encoders. The efficiency needs an estimate of the load, the indicators of the lag need set points.
struct SignalSample
{
  std::int64_t stamp{};                   ///< [ns]
  double motor_angle{ NOT_MEASURED };     ///< angle of the motor's encoder, without jumps at full turns [rad]
  double output_angle{ NOT_MEASURED };    ///< angle of the output's encoder, without jumps at full turns [rad]
  double motor_velocity{ NOT_MEASURED };  ///< speed of the motor [rad/s]
  double motor_torque{ NOT_MEASURED };    ///< torque at the motor shaft: commanded, or current x torque constant [N.m]
  double load_torque{ NOT_MEASURED };     ///< estimated joint load without weight; > 0 resists positive motion [N.m]
  double temperature{ NOT_MEASURED };     ///< temperature of the drive [degC]
  double target_angle{ NOT_MEASURED };    ///< set point of the output angle [rad]
};

/// Ripple of an angle: the part of the angle that passes three high-pass filters in series.
///
/// Law:   r = (s t / (1 + s t))^3 x
/// where  x  angle, whose speed is given [rad];  r  ripple [rad];  t  TIME [s];  s  Laplace variable
/// A steady acceleration causes no ripple. Of a line at the frequency f, the ripple contains the share
/// (1 + 1 / (2 pi f t)^2)^-1.5 of the amplitude, for example 0.9 at 30 Hz.
class RippleFilter
{
public:
  explicit RippleFilter(double speed = 0.0) : smooth_speed_(speed) {}

  /// `speed`: speed of the angle [rad/s]; `seconds`: time since the last update [s].
  void update(double speed, double seconds) noexcept
  {
    const double kept = std::exp(-seconds / TIME);
    smooth_speed_ = kept * smooth_speed_ + (1.0 - kept) * speed;
    acceleration_ = kept * acceleration_ + (1.0 - kept) * (speed - smooth_speed_) / TIME;
    smooth_acceleration_ = kept * smooth_acceleration_ + (1.0 - kept) * acceleration_;
  }

  double ripple() const noexcept { return TIME * TIME * (acceleration_ - smooth_acceleration_); }  ///< [rad]

private:
  static constexpr double TIME = 0.02;  // time constant t of each filter [s]

  double smooth_speed_;           // [rad/s]
  double acceleration_{};         // [rad/s^2]
  double smooth_acceleration_{};  // [rad/s^2]
};

/// Estimates inertia and friction by load from the motor torque over one window.
///
/// Law:   F tau = J F a + C F sign(omega) + g_0 [ + g_c F cos(phi) + g_s F sin(phi) ]
///        F tau = J F a + C F sign(omega) + g_0 + B F omega + l F(sign(omega) |T| / i),  while the motor moves
/// where  F          filter of TwiceSmoothed;  tau  motor torque minus the load torque at the motor [N.m]
///        a, omega   motor acceleration [rad/s^2], speed [rad/s];  J  inertia at the motor [kg.m^2];  g_0  offset [N.m]
///        C          Coulomb friction [N.m]; without C a change of friction would count as inertia, because both
///                   torques change sign with the motion
///        phi        output angle [rad];  g_c, g_s  weight [N.m], only if the load is not known
///        B          viscous friction [N.m.s/rad];  T, i  load torque [N.m], ratio
///        l          friction by load [-]; it needs a load that varies
/// The estimate of J goes to 0 if the rms acceleration is below LEAST_ACCELERATION, or if the weight is in proportion
/// to the acceleration.
class TorqueBalance
{
public:
  TorqueBalance() : regression_(COLUMNS, 1), friction_(COLUMNS, 1) {}

  void reset() noexcept
  {
    restart();
    smoothed_.reset();
  }

  /// Begins the next window.
  void restart() noexcept
  {
    regression_.reset();
    friction_.reset();
  }

  /// Adds a sample. `torque`: motor torque minus load torque at the motor [N.m]; `load`: load torque at the motor, NaN
  /// if not known [N.m]; `seconds`: time since the last sample [s]; `moving`: whether the motor moves.
  void add(double torque, double load, double velocity, double output_angle, double seconds, bool moving) noexcept
  {
    const double direction = std::copysign(1.0, velocity);
    TwiceSmoothed<COLUMNS + 1>::Values given;
    given << torque, velocity, direction, std::cos(output_angle), std::sin(output_angle),
        direction * (std::isfinite(load) ? std::abs(load) : 0.0);
    smoothed_.update(given, seconds);
    const auto& values = smoothed_.values();
    Eigen::Matrix<double, COLUMNS, 1> row;
    row << smoothed_.rates()[1], values[2], 1.0, values[3], values[4];
    const Eigen::Matrix<double, 1, 1> balance(values[0]);
    regression_.add(row, balance);
    if (moving)
    {
      row.tail<2>() << values[1], values[5];
      friction_.add(row, balance);
    }
  }

  /// Fits the first law. Returns the inertia at the motor [kg.m^2].
  double fit(bool load_known) noexcept
  {
    Eigen::Matrix<double, COLUMNS, 1> row = Eigen::Matrix<double, COLUMNS, 1>::Zero();
    row[0] = LEAST_ACCELERATION * std::sqrt(regression_.rows());
    regression_.add(row, Eigen::Matrix<double, 1, 1>(0.0));
    return regression_.fit(load_known ? COLUMNS - 2 : COLUMNS) ? regression_.coefficient(0, 0) : 0.0;
  }

  /// Fits the second law. Returns the friction by load, l [-].
  Indicator loadFriction() noexcept
  {
    constexpr int LOAD = COLUMNS - 1;
    const bool told = friction_.fit(COLUMNS) && friction_.mean(LOAD, LOAD) > 0.0;
    return { told && friction_.inflation(LOAD) < MAX_INFLATION, friction_.coefficient(LOAD, 0) };
  }

private:
  static constexpr int COLUMNS = 5;
  static constexpr double MAX_INFLATION = 30.0;       // largest inflation of the variance of l [-]
  static constexpr double LEAST_ACCELERATION = 20.0;  // least rms acceleration of the motor [rad/s^2]

  RunningRegression regression_;
  RunningRegression friction_;
  TwiceSmoothed<COLUMNS + 1> smoothed_;
};

/// Load torque of a joint as a function of its angle. The function depends on the payload and not on the path.
///
/// Law:   T = c + s sin(phi) + k cos(phi),  least squares over the time
/// where  T, phi  load torque [N.m], output angle [rad];  s, k  parts by weight [N.m];  c  constant part [N.m]
/// If the rms variation of the angle is below about 0.3 deg, the fit determines only c, and s and k go to 0.
class LoadOverAngle
{
public:
  using Coefficients = Eigen::Vector3d;  // c, s, k [N.m]

  void add(double angle, double torque, double seconds) noexcept
  {
    const Eigen::Vector3d row(1.0, std::sin(angle), std::cos(angle));
    normal_.noalias() += seconds * row * row.transpose();
    right_.noalias() += seconds * torque * row;
  }

  /// Result of the fit; NaN if no sample was added.
  Coefficients coefficients() const noexcept
  {
    constexpr double LEAST_SQUARE = 2.5e-5;  // least mean square of sine and cosine about their means [-]
    const double time = normal_(0, 0);
    const Eigen::Vector2d mean = normal_.col(0).tail<2>() / time;
    const double mean_torque = right_[0] / time;
    Eigen::Matrix2d squares = normal_.bottomRightCorner<2, 2>() - time * mean * mean.transpose();
    squares.diagonal().array() += LEAST_SQUARE * time;
    const Eigen::Vector2d weight = squares.inverse() * (right_.tail<2>() - time * mean_torque * mean);
    return { mean_torque - mean.dot(weight), weight[0], weight[1] };
  }

private:
  Eigen::Matrix3d normal_{ Eigen::Matrix3d::Zero() };
  Eigen::Vector3d right_{ Eigen::Vector3d::Zero() };
};

/// Ripple and lines of the lag of a joint behind its set points, over one window.
///
/// Law:   r = RippleFilter of i (phi - phi_s),   R^2 = <r^2>,   A_o^2 = 4 <|c_o|^2>,   c_o = mean of r exp(j o theta)
/// where  phi, phi_s  output angle, its set point [rad];  i  ratio;  theta  motor angle [rad];  o  order
///        R, A_o      rms ripple, amplitude of the line of order o, both of the lag [rad];  <>  mean over the travel
/// c_o is an exponential mean over LINE_TRAVEL. A_o therefore contains a line whose phase changes, for example with the
/// sign of the load. r does not contain the motion, because it is the ripple of a difference from smooth set points.
class LagEstimate
{
public:
  static constexpr std::size_t LINES = 3;
  static constexpr std::array<double, LINES> ORDERS{ 1.0, 2.0, 4.0 };

  void reset() noexcept { *this = LagEstimate(); }

  /// Begins the next window.
  void restart() noexcept
  {
    travel_ = 0.0;
    square_ = 0.0;
    lines_ = {};
  }

  /// Adds a sample. `lag`: i (phi - phi_s), NaN without a set point [rad]; `travel`: motor travel since the last sample
  /// [rad]; `seconds`: time since the last sample [s]; `moving`: whether the motor moves, so that the sample counts.
  void add(double lag, double motor_angle, double travel, double seconds, bool moving) noexcept
  {
    const bool is_first = age_ == 0.0;
    if (!std::isfinite(lag))
    {
      if (!is_first)
      {
        reset();
      }
      return;
    }
    if (is_first)
    {
      last_ = lag;
    }
    filter_.update((lag - last_) / seconds, seconds);
    last_ = lag;
    age_ += seconds;
    const double way = std::abs(travel);
    const double kept = std::exp(-way / LINE_TRAVEL);
    const double weight = moving && age_ > SETTLING_TIME ? way : 0.0;
    const double ripple = filter_.ripple();
    travel_ += weight;
    square_ += weight * ripple * ripple;
    for (std::size_t i = 0; i < LINES; ++i)
    {
      const bool seen = ORDERS[i] * way < USED_BAND * 0.5 * TWO_PI;
      const std::complex<double> turned = seen ? std::polar(ripple, ORDERS[i] * motor_angle) : 0.0;
      Line& line = lines_[i];
      line.mean = kept * line.mean + (1.0 - kept) * turned;
      line.travel += seen ? weight : 0.0;
      line.square += seen ? weight * std::norm(line.mean) : 0.0;
    }
  }

  Indicator ripple() const noexcept  ///< rms ripple R of the lag [rad]
  {
    return { travel_ > LEAST_TRAVEL, std::sqrt(square_ / travel_) };
  }

  /// Amplitude A_o of the line ORDERS[order] of the lag [rad].
  Indicator line(std::size_t order) const noexcept
  {
    const Line& line = lines_[order];
    return { line.travel > SEEN_SHARE * std::max(travel_, LEAST_TRAVEL), 2.0 * std::sqrt(line.square / line.travel) };
  }

private:
  static constexpr double LINE_TRAVEL = 2.0 * TWO_PI;    // travel after which r has weight 1/e in c_o [rad]
  static constexpr double LEAST_TRAVEL = 10.0 * TWO_PI;  // least travel in a window [rad]
  static constexpr double SETTLING_TIME = 0.2;           // settling time of RippleFilter [s]
  static constexpr double USED_BAND = 0.8;               // highest order, as a share of half the samples per turn [-]
  static constexpr double SEEN_SHARE = 0.5;              // least share of the travel with enough samples for a line [-]

  struct Line
  {
    std::complex<double> mean;
    double travel{};  // [rad]
    double square{};
  };

  RippleFilter filter_;
  double last_{};  // lag of the last sample [rad]
  double age_{};   // time since the first sample [s]
  double travel_{};
  double square_{};
  std::array<Line, LINES> lines_;
};

/// Coulomb and viscous friction at the motor shaft.
///
/// Law:   tau - T / i = C sign(omega) + B omega + g_c cos(phi) + g_s sin(phi) + g_0
/// where  tau, T      motor torque, load estimate (0 if none) [N.m];  i  ratio [-]
///        omega, phi  mean motor speed over about half a turn [rad/s], output angle [rad]
///        C, B        Coulomb friction [N.m], viscous friction [N.m.s/rad];  g_c, g_s, g_0  weight, offset [N.m]
/// The fit is by recursive least squares over samples at nearly constant speed. Weights decay exponentially with the
/// travel. C and B are valid if the motion separates them, that is, has several speeds in each direction.
class FrictionEstimate
{
public:
  /// `memory`: travel of the motor after which a sample has the weight 1/e [rad].
  explicit FrictionEstimate(double memory) : memory_(memory), regression_(COLUMNS, 1) {}

  void reset() noexcept
  {
    regression_.reset();
    fitted_ = false;
  }

  /// Adds a sample. `travel`: motor travel since the last sample [rad]; `torque`: tau - T / i [N.m].
  void add(double travel, double velocity, double output_angle, double torque) noexcept
  {
    regression_.forget(std::exp(-std::abs(travel) / memory_));
    Eigen::Matrix<double, COLUMNS, 1> row;
    row << std::copysign(1.0, velocity), velocity, std::cos(output_angle), std::sin(output_angle), 1.0;
    regression_.add(row, Eigen::Matrix<double, 1, 1>(torque));
  }

  void fit() noexcept { fitted_ = regression_.fit(COLUMNS); }

  Indicator coulomb() const noexcept { return value(0); }  ///< Coulomb friction C [N.m]
  Indicator viscous() const noexcept { return value(1); }  ///< viscous friction B [N.m.s/rad]

private:
  static constexpr int COLUMNS = 5;
  /// Largest inflation of a coefficient's variance at which speed and direction separate Coulomb from viscous friction
  /// [-]. Two speeds in the ratio 1 to 2, in each direction, give 10.
  static constexpr double MAX_INFLATION = 30.0;

  Indicator value(int column) const noexcept
  {
    if (!fitted_ || regression_.inflation(0) > MAX_INFLATION || regression_.inflation(1) > MAX_INFLATION)
    {
      return {};
    }
    return { true, regression_.coefficient(column, 0) };
  }

  double memory_;
  bool fitted_{};
  RunningRegression regression_;
};

/// Computes health indicators from a drive's own signals, window by window. Only the constructor allocates.
///
/// A window ends after indicators.window_turns turns of the motor at steady speed, in either direction, or after
/// indicators.window_time. The joint torque is the load estimate plus the weight by output.gravity_torque. The motion
/// is steady if the mean speed over about half a turn is above indicators.least_speed and the speed differs from the
/// mean by less than the share indicators.speed_change. Lines are fitted to calm motion. Steady motion is calm except
/// from 20 ms before to 0.4 s after a change of speed, because a change excites the drive a thousand times more than
/// the lines do. Without a motor encoder lines are fitted to all steady motion.
class SignalMonitor
{
public:
  explicit SignalMonitor(const Parameters& parameters);

  /// Estimates the bearing's slip in all later windows with a motor encoder. This call and all later updates allocate.
  void seekBearingSlip(const Parameters& parameters) { slip_.emplace(parameters); }

  void reset() noexcept;

  /// Adds a sample. Returns whether the sample completed a window. The monitor refuses and counts a sample without
  /// angle or torque, or with a stamp that is not later than the last one.
  bool update(const SignalSample& given) noexcept;

  /// Indicators of the last complete window.
  const SignalIndicators& indicators() const noexcept { return indicators_; }

  std::uint64_t refused() const noexcept { return refused_; }
  double progress() const noexcept;  ///< share of the current window that is complete, 0 ... 1 [-]

private:
  struct Mean
  {
    void add(double value, double value_weight = 1.0) noexcept
    {
      sum += value_weight * value;
      weight += value_weight;
    }
    double value() const noexcept { return sum / weight; }  // NaN if no value was added
    double sum{};
    double weight{};
  };

  struct Window
  {
    std::int64_t elapsed{};  // time since the start of the window [ns]
    double travel{};         // travel at steady speed [rad]
    int samples{};           // number of samples at steady speed
    double line_travel{};    // travel of the samples that lines are fitted to [rad]
    int line_samples{};
    bool motor_encoder{ true };
    bool both_encoders{ true };
    Mean speed;
    Mean direction;
    Mean load;
    LoadOverAngle load_over_angle;
    Mean temperature;
    Mean running_torque;
    Mean ratio;
    Mean kinematic_error;
    double residuals{};  // number of residuals in the moments below
    double residual_square{};
    double residual_fourth{};
    double residual_largest{};
  };

  /// A sample for the fit of the lines that waits until the monitor knows whether the motion stays calm.
  struct Waiting
  {
    LineSample sample;
    double travel{};       // motor travel since the sample before [rad]
    std::int64_t stamp{};  // stamp of the sample [ns]
  };

  void start(const SignalSample& sample, double motor_angle) noexcept;
  double weightAt(double output_angle) const noexcept;
  void addLoop(const SignalSample& sample, double motor_angle, double torsion, double velocity,
               double seconds) noexcept;
  void addAny(const SignalSample& sample, double velocity, double motor_angle, double output_angle,
              double seconds) noexcept;
  bool judgeMotion(double velocity, double seconds, bool motor_known) noexcept;
  void addSteady(const SignalSample& sample, double motor_angle, double output_angle, double travel,
                 double torsion) noexcept;
  void addLines(const LineSample& sample, double travel, std::int64_t stamp) noexcept;
  void addTurn(double motor_angle, double travel, double torsion) noexcept;
  void addResidual(double travel) noexcept;
  void complete(std::int64_t stamp) noexcept;
  void resetLines() noexcept;
  void fillLines(const OrderTracker& tracker) noexcept;
  void fillLines(LineSignal signal, const OrderTracker& tracker) noexcept;
  void set(ScalarIndicator indicator, double value) noexcept { indicators_.values[indexOf(indicator)] = value; }
  void set(ScalarIndicator indicator, const Indicator& value) noexcept;

  const double ratio_;
  const OutputParameters output_;
  const double output_inertia_;  // inertia of load and circular spline [kg.m^2]
  const double motor_inertia_;   // inertia of motor and wave generator, converted to the output [kg.m^2]
  const IndicatorParameters parameters_;
  OrderTracker tracker_;
  std::optional<BearingSlip> slip_;
  FrictionEstimate friction_;
  TorsionLoopEstimate loop_;
  TurnWindow turn_;
  EfficiencyEstimate efficiency_;
  SignalIndicators indicators_;
  std::uint64_t refused_{};

  bool started_{};
  SignalSample last_;
  double last_angle_{};     // last angle of the motor [rad]
  double torsion_zero_{};   // torsion of the first sample, so that sums stay small [rad]
  double mean_velocity_{};  // mean velocity of the motor over about half a turn [rad/s]
  RippleFilter speed_;      // ripple from the measured speed, which uneven stamps do not disturb
  RippleFilter angle_;      // ripple from the motor angle
  TorqueBalance balance_;
  LagEstimate lag_;
  double calm_{};  // time for which the motion has been calm [s]
  std::array<Waiting, 128> waiting_;
  std::size_t first_waiting_{};
  std::size_t waiting_count_{};
  double ringing_{};        // amplitude of the ringing after the last change of speed [rad]
  double turn_travel_{};    // motor travel since the indicators of turn_ were read last [rad]
  bool tracked_{};          // whether the last fit separated all lines, so that the residual is valid
  double residual_mean_{};  // slow mean of the residual [rad]
  Window window_;
};
}  // namespace hjt
