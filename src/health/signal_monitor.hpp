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
#include "health/torsion_loop_estimate.hpp"

namespace hjt
{
constexpr double NOT_MEASURED = std::numeric_limits<double>::quiet_NaN();

/// What a drive's own sensors tell at one instant. What is not measured stays NaN: without one of the encoders only
/// what needs both is missing, without a load estimate only efficiency, without set points only the lag.
struct SignalSample
{
  std::int64_t stamp{};                   ///< [ns]
  double motor_angle{ NOT_MEASURED };     ///< encoder, without jumps at full turns [rad]
  double output_angle{ NOT_MEASURED };    ///< encoder, without jumps at full turns [rad]
  double motor_velocity{ NOT_MEASURED };  ///< [rad/s]
  double motor_torque{ NOT_MEASURED };    ///< at the shaft: commanded, or current times torque constant [N.m]
  double load_torque{ NOT_MEASURED };     ///< estimate at the output, > 0 resists positive motion [N.m]
  double temperature{ NOT_MEASURED };     ///< [degC]
  double target_angle{ NOT_MEASURED };    ///< set point of the output angle [rad]
};

/// Ripple of an angle: what three filters in a row do not follow of it.
///
/// Law:   r = (s t / (1 + s t))^3 x
/// where  x  angle, given by its speed [rad];  t  TIME [s]
/// A steady acceleration has no ripple; of a line at f the share (1 + 1 / (2 pi f t)^2)^-1.5 is left, 0.9 at 30 Hz.
class RippleFilter
{
public:
  explicit RippleFilter(double speed = 0.0) : smooth_speed_(speed) {}

  /// `seconds` since the last one. Speed [rad/s].
  void update(double speed, double seconds) noexcept
  {
    const double kept = std::exp(-seconds / TIME);
    smooth_speed_ = kept * smooth_speed_ + (1.0 - kept) * speed;
    acceleration_ = kept * acceleration_ + (1.0 - kept) * (speed - smooth_speed_) / TIME;
    smooth_acceleration_ = kept * smooth_acceleration_ + (1.0 - kept) * acceleration_;
  }

  double ripple() const noexcept { return TIME * TIME * (acceleration_ - smooth_acceleration_); }  ///< [rad]

private:
  static constexpr double TIME = 0.02;  // [s]

  double smooth_speed_;           // [rad/s]
  double acceleration_{};         // [rad/s^2]
  double smooth_acceleration_{};  // [rad/s^2]
};

/// What the motor's torque goes into, over one window: inertia, and friction that grows with the load.
///
/// Law:   F tau = J F a + C F sign(omega) + g_0 [ + g_c F cos(phi) + g_s F sin(phi) ],  F = 1 / (1 + s t)^2
///        F tau = J F a + C F sign(omega) + g_0 + B F omega + l F(sign(omega) |T| / i)   where the motor moves
/// where  tau            motor torque less the load's [N.m];  a, omega  motor acceleration [rad/s^2], speed [rad/s]
///        C              friction: without its column what changes with the temperature or a fault would count as
///                       inertia, for the friction turns round with the motion
///        phi            output angle [rad]; g_c, g_s: weight, where the load is not known
///        B              viscous friction;  T, i  load torque [N.m], ratio;  l  friction by load [-]: needs a load
///                       that varies
///        t              TIME [s]
/// A motion of less than LEAST_ACCELERATION rms, or whose weight goes as its acceleration, has no inertia to see: it
/// goes to 0.
class TorqueBalance
{
public:
  TorqueBalance() : regression_(COLUMNS, 1), friction_(COLUMNS, 1) {}

  void reset() noexcept
  {
    restart();
    started_ = false;
  }

  /// The next window.
  void restart() noexcept
  {
    regression_.reset();
    friction_.reset();
  }

  /// Every sample. `torque`: less the load's; `load`: at the motor, NaN: not known [N.m]; `seconds` since the last one.
  void add(double torque, double load, double velocity, double output_angle, double seconds, bool moving) noexcept
  {
    const double direction = std::copysign(1.0, velocity);
    Values values;
    values << torque, velocity, direction, std::cos(output_angle), std::sin(output_angle),
        direction * (std::isfinite(load) ? std::abs(load) : 0.0);
    if (!started_)
    {
      started_ = true;
      first_ = values;
      second_ = values;
    }
    const double last_speed = second_[1];
    const double kept = std::exp(-seconds / TIME);
    first_ = kept * first_ + (1.0 - kept) * values;
    second_ = kept * second_ + (1.0 - kept) * first_;
    Eigen::Matrix<double, COLUMNS, 1> row;
    row << (second_[1] - last_speed) / seconds, second_[2], 1.0, second_[3], second_[4];
    const Eigen::Matrix<double, 1, 1> balance(second_[0]);
    regression_.add(row, balance);
    if (moving)
    {
      row.tail<2>() << second_[1], second_[5];
      friction_.add(row, balance);
    }
  }

  /// At the motor [kg.m^2].
  double fit(bool load_known) noexcept
  {
    Eigen::Matrix<double, COLUMNS, 1> row = Eigen::Matrix<double, COLUMNS, 1>::Zero();
    row[0] = LEAST_ACCELERATION * std::sqrt(regression_.rows());
    regression_.add(row, Eigen::Matrix<double, 1, 1>(0.0));
    return regression_.fit(load_known ? COLUMNS - 2 : COLUMNS) ? regression_.coefficient(0, 0) : 0.0;
  }

  /// [-]
  Indicator loadFriction() noexcept
  {
    constexpr int LOAD = COLUMNS - 1;
    const bool told = friction_.fit(COLUMNS) && friction_.mean(LOAD, LOAD) > 0.0;
    return { told && friction_.inflation(LOAD) < MAX_INFLATION, friction_.coefficient(LOAD, 0) };
  }

private:
  static constexpr int COLUMNS = 5;
  static constexpr double MAX_INFLATION = 30.0;       // of the variance of the friction by load [-]
  static constexpr double TIME = 0.02;                // [s]
  static constexpr double LEAST_ACCELERATION = 20.0;  // rms, of the motor [rad/s^2]
  using Values = Eigen::Matrix<double, COLUMNS + 1, 1>;

  RunningRegression regression_;
  RunningRegression friction_;
  Values first_{ Values::Zero() };
  Values second_{ Values::Zero() };
  bool started_{};
};

/// Payload of a joint, from its load torque over its angle: a payload gives the same on any path.
///
/// Law:   T = c + s sin(phi) + k cos(phi),  least squares over the time
/// where  T, phi  load torque [N.m], output angle [rad];  s, k  weight;  c  what does not depend on the angle
/// An angle that varies by less than some 0.3 deg rms determines c alone: s and k go to 0.
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

  /// NaN: nothing came.
  Coefficients coefficients() const noexcept
  {
    constexpr double LEAST_SQUARE = 2.5e-5;  // of the sine and cosine about their means [-]
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

/// What a joint's controller cannot keep of its set points, over one window: ripple of the lag, and its lines.
///
/// Law:   r = RippleFilter of i (phi - phi_s),   R^2 = <r^2>,   A_o^2 = 4 <|c_o|^2>,   c_o = mean of r exp(j o theta)
/// where  phi, phi_s  output angle, its set point [rad];  i  ratio;  theta  motor angle [rad];  o  order
///        <>          mean over the travel;  c_o forgets in LINE_TRAVEL, so that a line counts whatever its phase does:
///                    under a load that changes its sign, and from one move to the next
/// Set points are smooth: of the motion itself nothing is left in r, which the ripple of the angle alone is full of.
class LagEstimate
{
public:
  static constexpr std::size_t LINES = 3;
  static constexpr std::array<double, LINES> ORDERS{ 1.0, 2.0, 4.0 };

  void reset() noexcept { *this = LagEstimate(); }

  /// The next window.
  void restart() noexcept
  {
    travel_ = 0.0;
    square_ = 0.0;
    lines_ = {};
  }

  /// Every sample. `lag`: at the motor [rad], NaN: no set point; `travel` of the motor, `seconds` since the last one;
  /// `moving`: it counts.
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

  Indicator ripple() const noexcept  ///< R [rad]
  {
    return { travel_ > LEAST_TRAVEL, std::sqrt(square_ / travel_) };
  }

  /// A_o [rad]
  Indicator line(std::size_t order) const noexcept
  {
    const Line& line = lines_[order];
    return { line.travel > SEEN_SHARE * std::max(travel_, LEAST_TRAVEL), 2.0 * std::sqrt(line.square / line.travel) };
  }

private:
  static constexpr double LINE_TRAVEL = 2.0 * TWO_PI;    // [rad]
  static constexpr double LEAST_TRAVEL = 10.0 * TWO_PI;  // in a window [rad]
  static constexpr double SETTLING_TIME = 0.2;           // of the filter [s]
  static constexpr double USED_BAND = 0.8;               // of half the samples a turn [-]
  static constexpr double SEEN_SHARE = 0.5;              // of the travel, that a line could be seen in [-]

  struct Line
  {
    std::complex<double> mean;
    double travel{};  // [rad]
    double square{};
  };

  RippleFilter filter_;
  double last_{};  // lag [rad]
  double age_{};   // [s]
  double travel_{};
  double square_{};
  std::array<Line, LINES> lines_;
};

/// Coulomb and viscous friction at the motor shaft.
///
/// Law:   tau - T / i = C sign(omega) + B omega + g_c cos(phi) + g_s sin(phi) + g_0
/// where  tau, T      motor torque, load estimate (0 if none) [N.m];  i  ratio [-]
///        omega, phi  motor speed over about a turn [rad/s], output angle [rad]; the terms in phi take up the weight
/// Recursive least squares over samples at near-constant speed, forgotten exponentially over travel.
/// Valid while the motion separates the two: several speeds, each way.
class FrictionEstimate
{
public:
  /// `memory`: travel of the motor after which a sample counts 1/e [rad].
  explicit FrictionEstimate(double memory) : memory_(memory), regression_(COLUMNS, 1) {}

  void reset() noexcept
  {
    regression_.reset();
    fitted_ = false;
  }

  /// `travel`: of the motor since the last sample [rad].
  void add(double travel, double velocity, double output_angle, double torque) noexcept
  {
    regression_.forget(std::exp(-std::abs(travel) / memory_));
    Eigen::Matrix<double, COLUMNS, 1> row;
    row << std::copysign(1.0, velocity), velocity, std::cos(output_angle), std::sin(output_angle), 1.0;
    regression_.add(row, Eigen::Matrix<double, 1, 1>(torque));
  }

  void fit() noexcept { fitted_ = regression_.fit(COLUMNS); }

  Indicator coulomb() const noexcept { return value(0); }  ///< [N.m]
  Indicator viscous() const noexcept { return value(1); }  ///< [N.m.s/rad]

private:
  static constexpr int COLUMNS = 5;
  /// Speed and direction tell Coulomb from viscous friction only while their variance is inflated less than this [-]:
  /// two speeds in the ratio 1 to 2, each way, give 10.
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

/// Health indicators from a drive's own signals, window by window, in fixed memory. Allocates only at construction.
///
/// A window ends after indicators.window_turns turns of the motor at steady speed, either way, or after
/// indicators.window_time. The joint torque is the load estimate and the weight that output.gravity_torque says.
/// Steady: the mean speed over about half a turn is above indicators.least_speed, and the speed itself within
/// indicators.speed_change of it. Lines are fitted to the calm part of the steady motion: not from 20 ms before to
/// 0.4 s after a change of speed, which excites the drive a thousand times more than the lines. Without a motor encoder
/// they are fitted to all steady motion.
class SignalMonitor
{
public:
  explicit SignalMonitor(const Parameters& parameters);

  /// Looks for the bearing's slip in every further window with a motor encoder (BearingSlip); allocates, as updates do
  /// then.
  void seekBearingSlip(const Parameters& parameters) { slip_.emplace(parameters); }

  void reset() noexcept;

  /// True: this sample completed a window. A sample without stamp progress, angle or torque is passed over and counted.
  bool update(const SignalSample& given) noexcept;

  /// Of the last window that was completed.
  const SignalIndicators& indicators() const noexcept { return indicators_; }

  std::uint64_t refused() const noexcept { return refused_; }
  double progress() const noexcept;  ///< of the running window, 0 ... 1 [-]

private:
  /// Sums over a window; the mean is over `weight`.
  struct Mean
  {
    void add(double value, double value_weight = 1.0) noexcept
    {
      sum += value_weight * value;
      weight += value_weight;
    }
    double value() const noexcept { return sum / weight; }  // NaN: nothing came
    double sum{};
    double weight{};
  };

  struct Window
  {
    std::int64_t elapsed{};  // [ns]
    double travel{};         // at steady speed [rad]
    int samples{};           // at steady speed
    double line_travel{};    // of the samples that lines are fitted to [rad]
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
    double residuals{};  // number
    double residual_square{};
    double residual_fourth{};
    double residual_largest{};
  };

  /// A sample for the lines that waits whether the motion stays calm.
  struct Waiting
  {
    LineSample sample;
    double travel{};       // [rad]
    std::int64_t stamp{};  // [ns]
  };

  void start(const SignalSample& sample, double motor_angle) noexcept;
  double weightAt(double output_angle) const noexcept;
  SignalSample withWeight(SignalSample sample) const noexcept;
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
  void fillTorsion() noexcept;

  const double ratio_;
  const OutputParameters output_;
  const double output_inertia_;  // of the load and the circular spline [kg.m^2]
  const double motor_inertia_;   // of the motor and the wave generator, at the output [kg.m^2]
  const IndicatorParameters parameters_;
  OrderTracker tracker_;
  std::optional<BearingSlip> slip_;
  FrictionEstimate friction_;
  SmoothedTorsion smoothed_;
  TorsionLoopEstimate loop_;
  TurnWindow turn_;
  EfficiencyEstimate efficiency_;
  SignalIndicators indicators_;
  std::uint64_t refused_{};

  bool started_{};
  SignalSample last_;
  double last_angle_{};     // of the motor [rad]
  double torsion_zero_{};   // of the first sample, so that what is summed is small [rad]
  double mean_velocity_{};  // over about half a turn [rad/s]
  RippleFilter speed_;      // of the speed as read: uneven stamps do not disturb it
  RippleFilter angle_;      // of the motor angle
  TorqueBalance balance_;
  LagEstimate lag_;
  double calm_{};  // how long the motion has been [s]
  std::array<Waiting, 128> waiting_;
  std::size_t first_waiting_{};
  std::size_t waiting_count_{};
  double ringing_{};        // amplitude after the last change of speed [rad]
  double turn_travel_{};    // since the turn window was read [rad]
  bool tracked_{};          // every line has been fitted: the residual means something
  double residual_mean_{};  // slow [rad]
  Window window_;
};
}  // namespace hjt
