// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "base/number_text.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/health/assessment.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "health/running_regression.hpp"
#include "health/signal_monitor.hpp"
#include "params/variants.hpp"
#include "statics/torsion_curve.hpp"
#include "tracking/friction_points.hpp"
#include "tracking/motion_differentiator.hpp"
#include "tracking/motion_driven.hpp"
#include "tracking/telemetry_fit.hpp"
#include "tracking/telemetry_rows.hpp"

namespace hjt
{
/// Torsion at one joint torque, both ways of turning apart: mean of the rows.
struct TorsionMean
{
  double torque{};    ///< [N.m]
  double forward{};   ///< NaN: never passed that way [rad]
  double backward{};  ///< [rad]
};

/// Torsion of a joint with two encoders, compared with the twin's under the same course of loads, for torques up to
/// output.load_torque_limit. Memory is fixed; `add` neither allocates nor throws.
class TorsionPoints
{
public:
  explicit TorsionPoints(const Parameters& parameters)
    : step_(std::max(parameters.output.load_torque_limit, 1.0) / STEPS), regression_(3, 1)
  {
    bins_.fill(std::vector<Bin>(2 * static_cast<std::size_t>(STEPS) + 1));
  }

  void reset() noexcept
  {
    regression_.reset();
    for (std::vector<Bin>& way : bins_)
    {
      std::fill(way.begin(), way.end(), Bin());
    }
    rows_ = 0;
    twin_sum_ = twin_squares_ = 0.0;
    turn_sum_.setZero();
    turn_squares_.setZero();
  }

  /// `torque` at the output [N.m], `twin` the torsion of the twin under it [rad], `torsion` motor angle over ratio less
  /// joint angle, from any zero [rad], `position` of the joint [rad], `speed` [rad/s].
  void add(double torque, double twin, double torsion, double position, double speed) noexcept
  {
    const double way = speed < 0.0 ? -1.0 : 1.0;
    regression_.add(Eigen::Vector3d(1.0, way, twin), Eigen::Matrix<double, 1, 1>(torsion));
    ++rows_;
    twin_sum_ += twin;
    twin_squares_ += twin * twin;
    const Eigen::Vector2d turn(std::cos(position), std::sin(position));
    turn_sum_ += turn;
    turn_squares_ += turn * turn.transpose();
    Bin& bin = bins_[speed < 0.0 ? 1 : 0][static_cast<std::size_t>(std::lround(torque / step_ + STEPS))];
    bin.sum += torsion;
    bin.rows += 1.0;
  }

  std::uint64_t rows() const { return rows_; }

  /// By torque, ascending, in steps; zero is where the twin's curve has it.
  std::vector<TorsionMean> means() const
  {
    std::vector<TorsionMean> means;
    if (rows_ == 0)
    {
      return means;
    }
    const double zero = fitted().coefficient(0, 0);
    const auto mean_of = [&](const Bin& bin) { return bin.rows > 0.0 ? bin.sum / bin.rows - zero : std::nan(""); };
    for (std::size_t step = 0; step < bins_[0].size(); ++step)
    {
      if (bins_[0][step].rows + bins_[1][step].rows > 0.0)
      {
        means.push_back(
            { (static_cast<double>(step) - STEPS) * step_, mean_of(bins_[0][step]), mean_of(bins_[1][step]) });
      }
    }
    return means;
  }

  /// Measured torsion over the twin's under the same torques, by least squares with an offset for each way of turning;
  /// NaN if the torque hardly varied.
  double compliance() const
  {
    return twinAmplitude() < MIN_VARIED ? std::numeric_limits<double>::quiet_NaN() : fitted().coefficient(2, 0);
  }

  /// Standard deviation of the twin's torsion under the same torques [rad]
  double twinAmplitude() const
  {
    const auto n = static_cast<double>(rows_);
    return rows_ == 0 ? 0.0 : std::sqrt(std::max(0.0, twin_squares_ / n - std::pow(twin_sum_ / n, 2)));
  }

  /// Largest standard deviation that a sine of the joint angle of amplitude 1 has, over all phases [-].
  double turnAmplitude() const
  {
    const double n = std::max(static_cast<double>(rows_), 1.0);
    const Eigen::Matrix2d squares = turn_squares_ / n - turn_sum_ * turn_sum_.transpose() / (n * n);
    // The root of the larger eigenvalue.
    return std::sqrt(0.5 * squares.trace() + std::hypot(0.5 * (squares(0, 0) - squares(1, 1)), squares(0, 1)));
  }

private:
  static constexpr double STEPS = 142.0;       // up to the largest load
  static constexpr double MIN_VARIED = 20e-6;  // least standard deviation of the twin's torsion that allows an
                                               // estimate [rad]
  struct Bin
  {
    double sum{};
    double rows{};
  };

  RunningRegression fitted() const
  {
    RunningRegression regression = regression_;
    regression.fit(3);
    return regression;
  }

  double step_;                           // of the torque [N.m]
  RunningRegression regression_;          // of the torsion over: one, way of turning, the twin's torsion
  std::array<std::vector<Bin>, 2> bins_;  // by way of turning: torques from the least to the largest
  std::uint64_t rows_{};
  double twin_sum_{};
  double twin_squares_{};
  Eigen::Vector2d turn_sum_{ 0.0, 0.0 };  // of cosine and sine of the joint angle
  Eigen::Matrix2d turn_squares_{ Eigen::Matrix2d::Zero() };
};

/// Health of a measured joint from its own signals, live and offline alike. Nothing allocates or throws after
/// construction.
class SignalWatch
{
public:
  explicit SignalWatch(const Parameters& parameters)
    : telemetry_(parameters.telemetry)
    , ratio_(nominalRatio(parameters.gear))
    , temperature_(parameters.input.temperature)
    , monitor_(withoutWeight(parameters))  // the load of a sample holds the weight
    , assessor_(parameters)
  {
  }

  /// The reference to hold the joint against; none: it is learned from the first windows.
  void setReference(std::vector<ReferenceBin> bins) { assessor_.setReference(std::move(bins)); }

  /// `sample`: its load holds weight and inertia too. True: a window is complete, and what follows is of it.
  bool update(const MotionSample& sample) noexcept
  {
    SignalSample signal;
    signal.stamp = std::llround(1e9 * sample.time);
    signal.motor_angle = sample.motor_angle;
    signal.output_angle = sample.position;
    signal.motor_velocity = ratio_ * sample.velocity;
    signal.motor_torque = telemetry_.torque_per_current * (sample.current - telemetry_.current_offset) / ratio_;
    signal.load_torque = sample.load;
    signal.temperature = sample.temperatureOr(temperature_);
    if (!monitor_.update(signal))
    {
      return false;
    }
    assessor_.update(monitor_.indicators());
    return true;
  }

  void reset() noexcept
  {
    monitor_.reset();
    assessor_.reset();
  }

  const SignalIndicators& indicators() const noexcept { return monitor_.indicators(); }
  const Assessor& assessor() const noexcept { return assessor_; }

private:
  TelemetryParameters telemetry_;
  double ratio_;
  double temperature_;  // of samples without one [degC]
  SignalMonitor monitor_;
  Assessor assessor_;
};

/// A contact on a joint's side of the arm.
struct Contact
{
  double since{};    ///< when it was first seen [s]
  double lasted{};   ///< without pauses shorter than ContactWatch::HOLD [s]
  double largest{};  ///< torque at the joint beyond the usual, magnitude [N.m]
};

/// Something that touches the arm: a torque that the joint's motion does not usually take, while it moves, for a short
/// time. What stays becomes the usual, and what comes more often than a fifth of the time is no contact: friction, gain
/// and payload.
///
/// The mean residual over MEAN must differ from the usual one of that direction by more than half of the friction, 5 %
/// of the load and 2 % of the largest load together, for LASTING, longer by what rates of rows that come rarely smear a
/// jolt over. Fixed memory; nothing allocates or throws.
class ContactWatch
{
public:
  static constexpr double MEMORY = 10.0;  ///< of motion one way, in which the usual follows [s]
  static constexpr double HOLD = 10.0;    ///< after a contact, in which nothing is judged [s]

  explicit ContactWatch(double largest_load) : largest_load_(largest_load) {}  ///< [N.m]

  void reset() noexcept { *this = ContactWatch(largest_load_); }

  /// `residual_torque`: measured less predicted, at the joint [N.m]. `is_held`: by stiction.
  void update(const MotionSample& sample, double residual_torque, double friction_torque, bool is_held) noexcept
  {
    constexpr double MEAN = 0.1;     // [s]
    constexpr double SETTLED = 0.3;  // of motion one way: then presliding and the start are over [s]
    constexpr double LASTING = 0.1;  // [s]
    constexpr double KNOWN = 2.0;    // motion in one direction before a mean is known [s]
    constexpr double OF_FRICTION = 0.5;
    constexpr double OF_LOAD = 0.05;
    constexpr double OF_LARGEST = 0.02;
    const double step = sample.after_gap ? 0.0 : std::max(0.0, sample.time - time_);
    time_ = sample.time;
    const int way =
        std::abs(sample.velocity) > MotionDifferentiator::MOVING && !is_held ? (sample.velocity > 0.0 ? 1 : -1) : 0;
    if (way == 0 || way != way_ || step <= 0.0 || step > SETTLED)
    {
      way_ = way;
      moved_ = beyond_ = mean_ = 0.0;
      return;
    }
    constexpr double ROWS = 4.0;  // fewest rows in the window of the rates
    const double smeared = std::max(0.0, ROWS * step - 2.0 * MotionDifferentiator::HALF_WIDTH);
    Usual& usual = usual_[way > 0 ? 1 : 0];
    const double bound =
        OF_FRICTION * std::abs(friction_torque) + OF_LOAD * std::abs(sample.load) + OF_LARGEST * largest_load_;
    const double difference = residual_torque - usual.torque;
    moved_ += step;
    mean_ += (moved_ > step ? 1.0 - std::exp(-step / MEAN) : 1.0) * (difference - mean_);
    usual.time += step;
    const bool is_known = usual.time > KNOWN;
    usual.torque += std::min(1.0, step / std::min(MEMORY, usual.time)) *
                    (is_known ? std::clamp(difference, -bound, bound) : difference);
    beyond_ = std::abs(mean_) > bound && moved_ > SETTLED + smeared && is_known ? beyond_ + step : 0.0;
    if (beyond_ > LASTING + smeared)
    {
      if (!isRecent())
      {
        contact_ = { sample.time - beyond_, 0.0, 0.0 };
      }
      contact_.lasted += step;
      contact_.largest = std::max(contact_.largest, std::abs(mean_));
      largest_ = contact_.largest >= largest_.largest ? contact_ : largest_;
      touched_ += step;
      last_ = sample.time;
    }
  }

  bool hasSeen() const noexcept
  {
    constexpr double OFTEN = 0.2;  // share of the motion
    return touched_ > 0.0 && touched_ < OFTEN * (usual_[0].time + usual_[1].time);
  }
  bool isTouching() const noexcept { return hasSeen() && time_ == last_; }  ///< now
  /// Now, or less than HOLD ago.
  bool isRecent() const noexcept { return hasSeen() && time_ - last_ < HOLD; }
  const Contact& last() const noexcept { return contact_; }     ///< the last one
  const Contact& largest() const noexcept { return largest_; }  ///< that with the largest torque

private:
  struct Usual
  {
    double torque{};  // residual [N.m]
    double time{};    // of motion [s]
  };

  double largest_load_;
  double time_{};
  int way_{};                                                // +1, -1; 0: at rest
  double moved_{};                                           // that way [s]
  double mean_{};                                            // of the difference [N.m]
  double beyond_{};                                          // how long [s]
  std::array<Usual, 2> usual_{};                             // by direction
  double last_{ -std::numeric_limits<double>::infinity() };  // when something touched it [s]
  double touched_{};                                         // in all [s]
  Contact contact_;
  Contact largest_;
};

/// A clause for people.
inline std::string contactText(const Contact& contact)
{
  return "something touched the arm, or its payload changed: at " + roundedText(contact.since, 3) + " s and " +
         roundedText(contact.lasted, 2) + " s long, up to " + roundedText(contact.largest, 2) +
         " N.m beyond what this motion usually takes";
}

/// One window of the signals and what was made of it.
struct JudgedWindow
{
  SignalIndicators indicators;
  Deviations deviations{};
  Assessment assessment;
};

/// Coverage of the measured motion.
struct MotionReach
{
  std::uint64_t rows{};
  std::uint64_t impossible{};        ///< rows with a current or load beyond what the joint has
  std::uint64_t motor_rows{};        ///< rows with a motor angle
  std::uint64_t temperature_rows{};  ///< rows with a received temperature
  std::uint64_t touched_rows{};      ///< rows left out: something touched the arm, or had a moment before
  double begin{};                    ///< of the rows [s]
  double end{};                      ///< [s]
  double sampled{};                  ///< time between rows that follow each other, without gaps [s]
  double least_load{};               ///< [N.m]
  double most_load{};                ///< [N.m]
  double least_angle{};              ///< [rad]
  double most_angle{};               ///< [rad]
};

/// Where the load of the samples comes from.
enum class LoadOrigin
{
  CONFIGURED,  ///< weight and inertia of the joint's parameters
  RECORDED,
  ARM  ///< links and payload, by rigid-body dynamics
};

/// The groups of a joint's parameters that evidence and verdict rest on.
struct EvidenceParameters
{
  explicit EvidenceParameters(const Parameters& of)
    : joint(of.joint)
    , output(of.output)
    , sensors(of.sensors)
    , input(of.input)
    , telemetry(of.telemetry)
    , comparison(of.comparison)
    , indicators(of.indicators)
    , possible_current(possibleCurrent(of))
  {
  }

  JointParameters joint;
  OutputParameters output;
  SensorParameters sensors;
  InputParameters input;
  TelemetryParameters telemetry;
  ComparisonParameters comparison;
  IndicatorParameters indicators;
  double possible_current;  ///< [A]
};

/// Evidence of a measured joint beside the twin in the same motion, row by row, live and offline alike:
/// `hjt::judge` makes the verdict of it. Rows while something touches the arm, and ContactWatch::HOLD after it, count
/// for nothing, unless the load is the configured one. Memory is fixed; after construction nothing allocates or throws.
class JointEvidence
{
public:
  /// @throws ParameterError if the ring finds no equilibrium under load.
  JointEvidence(const Parameters& parameters, LoadOrigin load);

  /// Of the sound joint; without it the signals' reference is learned from the first windows.
  void setReference(std::vector<ReferenceBin> bins);

  /// Result of a row.
  enum class Row
  {
    IMPOSSIBLE,  ///< its current or load is beyond what the joint has
    TOUCHED,     ///< something touches the arm, or did a moment before
    COUNTED,
    WINDOW  ///< counted, and a window of the signals is complete
  };

  /// `sample`: its load holds weight and inertia too. `fits`: else the signals are not looked at.
  Row update(const MotionSample& sample, bool fits = true) noexcept
  {
    predict(sample);
    return judge(sample, fits);
  }
  /// The same in two: the twin makes the motion of every row, of which those with a known load are judged.
  const MotionPrediction& predict(const MotionSample& sample) noexcept { return predicted_ = twin_.step(sample); }
  Row judge(const MotionSample& sample, bool fits) noexcept;

  /// Starts again, but keeps what the signals are held against and what touches the arm.
  void forget() noexcept;
  /// All of it: other rows follow.
  void reset() noexcept;
  /// Of the signals alone.
  void resetSignals() noexcept { health_.reset(); }

  LoadOrigin loadOrigin() const { return load_; }
  const EvidenceParameters& parameters() const { return parameters_; }
  double ratio() const { return ratio_; }
  const MotionDriven& twin() const { return twin_; }
  const MotionPrediction& predicted() const { return predicted_; }  ///< at the row that was taken last
  const MotionReach& reach() const { return now_.reach; }
  const FrictionPoints& friction() const { return now_.friction; }
  /// The same beside the friction that the controller expects, in the twin's place: with its target current in place of
  /// the measured one. Of the rows that hold it.
  const FrictionPoints& besideController() const { return now_.beside_controller; }
  const TorsionPoints& torsion() const { return now_.torsion; }
  const SignalIndicators& indicators() const { return health_.indicators(); }
  const Assessor& assessor() const { return health_.assessor(); }
  const ContactWatch& contact() const { return contact_; }
  /// Something touches the arm, or did less than ContactWatch::HOLD ago.
  bool isTouched() const { return load_ != LoadOrigin::CONFIGURED && contact_.isRecent(); }

  double currentRms() const;    ///< of the measured current [A]
  double predictedRms() const;  ///< of the predicted current [A]
  double residualRms() const;   ///< [A]
  /// Standard deviation of the residual about its mean: an unknown constant load does not count [A].
  double residualSpread() const;
  /// The residual that is left after the best constant and the best multiple of the predicted friction: neither a
  /// constant load nor worn or cold grease counts, rms [A].
  double unexplainedRms() const;
  /// The part of the measured current besides friction, load and inertia: a multiple of the predicted one.
  /// NaN: too little of it to tell.
  FittedFactor loadFactor() const;
  double temperature() const;  ///< that the rows were judged at, mean [degC]
  /// More than half of the rows had a received temperature.
  bool isTemperatureReceived() const { return 2 * now_.reach.temperature_rows > now_.reach.rows; }
  /// The twin's friction by the speeds of `friction`, under the typical load, at a temperature [degC], mean [N.m].
  double twinFrictionAt(double temperature) const;
  double typicalLoad() const;  ///< median of its magnitude [N.m]
  double largestLoad() const;  ///< that all but one in a thousand rows stay below [N.m]

  bool baselineGiven() const { return baseline_given_; }
  std::uint64_t assessedWindows() const { return now_.assessed; }
  /// The last window of those at the worst level; none: no window was judged.
  const std::optional<JudgedWindow>& worst() const { return now_.worst; }
  const std::optional<Assessment>& tooFew() const { return now_.too_few; }  ///< the last one of too few windows
  double alarmTime() const { return now_.alarm_time; }                      ///< when the level first left OK [s]
  Cause cause() const;                                                      ///< that most windows in alarm name
  double causeShare() const;  ///< share of the windows in alarm that name the cause; 0: none [-]

private:
  /// Sums over the rows.
  struct Sums
  {
    explicit Sums(const Parameters& parameters);
    void reset() noexcept;

    MotionReach reach;
    FrictionPoints friction;
    FrictionPoints beside_controller;
    TorsionPoints torsion;
    std::vector<std::uint64_t> loads;  // histogram of magnitudes
    double current_squares{};
    double predicted_squares{};
    double temperatures{};                                // [degC]
    Eigen::Matrix3d products{ Eigen::Matrix3d::Zero() };  // of 1, predicted friction, residual [1, A, A]
    /// The same of 1, predicted friction, the rest of the prediction and the residual, where friction tells.
    Eigen::Matrix4d gains{ Eigen::Matrix4d::Zero() };
    double gains_time{};  // that these rows are of [s]
    std::uint64_t assessed{};
    std::optional<JudgedWindow> worst;
    std::optional<Assessment> too_few;
    double alarm_time{};
    std::array<std::uint64_t, CAUSE_COUNT> votes{};
  };

  double addToReach(const MotionSample& sample) noexcept;
  void addGain(const MotionSample& sample, double residual, double step) noexcept;
  void addRow(const MotionSample& sample, double residual) noexcept;
  bool watchSignals(const MotionSample& sample) noexcept;
  double loadQuantile(double share) const;
  double counted() const;  // rows, 1 at least

  static constexpr double LOAD_STEPS = 568.0;  // of the histogram

  const EvidenceParameters parameters_;
  const LoadOrigin load_;
  const double ratio_;
  const double load_step_;  // [N.m]
  MotionDriven twin_;
  MotionPrediction predicted_;
  TorsionCourse course_;
  double twin_torsion_{};  // under the load of the last row with a motor angle [rad]
  ContactWatch contact_;
  SignalWatch health_;
  bool baseline_given_{};
  Sums now_;
};
}  // namespace hjt
