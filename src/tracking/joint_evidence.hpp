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
/// Mean torsion of the rows at one torque of the joint, for each direction of turning.
struct TorsionMean
{
  double torque{};    ///< torque at the joint [N.m]
  double forward{};   ///< mean torsion while turning forward; NaN: no such motion under this torque [rad]
  double backward{};  ///< mean torsion while turning backward; NaN: no such motion under this torque [rad]
};

/// Torsion of a joint with two encoders, and torsion of its twin under the same loads, for torques up to
/// output.load_torque_limit. The memory has a fixed size; add() neither allocates nor throws.
class TorsionPoints
{
public:
  explicit TorsionPoints(const Parameters& parameters)
    : step_(std::max(parameters.output.load_torque_limit, 1.0) / STEPS), regression_(SINE + 1, 1)
  {
  }

  void reset() noexcept
  {
    regression_.reset();
    bins_ = {};
  }

  /// Adds a row. `torque`: torque at the output [N.m]. `twin`: torsion of the twin [rad]. `torsion`: motor angle /
  /// ratio - joint angle, plus any constant [rad]. `position`, `speed`: angle and speed of the joint [rad], [rad/s].
  void add(double torque, double twin, double torsion, double position, double speed) noexcept
  {
    // Any zero is large beside the torsion, and the ridge of the fit would add a part of it to the compliance.
    zero_ = rows() == 0 ? torsion : zero_;
    torsion -= zero_;
    Eigen::Matrix<double, SINE + 1, 1> row;
    row << 1.0, std::copysign(1.0, speed), twin, std::cos(position), std::sin(position);
    regression_.add(row, Eigen::Matrix<double, 1, 1>(torsion));
    Bin& bin = bins_[speed < 0.0 ? 1 : 0][static_cast<std::size_t>(std::lround(torque / step_ + STEPS))];
    bin.sum += torsion;
    bin.rows += 1.0;
  }

  std::uint64_t rows() const { return static_cast<std::uint64_t>(regression_.rows()); }

  /// Mean torsions in the order of the torques. An offset makes them 0 where the twin's torsion is 0.
  std::vector<TorsionMean> means() const
  {
    std::vector<TorsionMean> means;
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

  /// Measured torsion over the twin's torsion under the same torques, by least squares with one offset for each
  /// direction of turning [-]; NaN: the torque hardly varied.
  double compliance() const
  {
    return twinAmplitude() < MIN_VARIED ? std::numeric_limits<double>::quiet_NaN() : fitted().coefficient(TWIN, 0);
  }

  /// Standard deviation of the twin's torsion from row to row [rad].
  double twinAmplitude() const { return std::sqrt(std::max(0.0, covariance(TWIN, TWIN))); }

  /// Standard deviation over the rows of cos(joint angle + phase), for the phase that gives the largest deviation [-].
  double turnAmplitude() const
  {
    const double cosines = covariance(COSINE, COSINE);
    const double sines = covariance(SINE, SINE);
    // The square root of the larger eigenvalue of the covariance matrix.
    return std::sqrt(0.5 * (cosines + sines) + std::hypot(0.5 * (cosines - sines), covariance(COSINE, SINE)));
  }

private:
  static constexpr int STEPS = 142;            // number of steps of the torque from 0 to the largest load [-]
  static constexpr double MIN_VARIED = 20e-6;  // least standard deviation of the twin's torsion for a result [rad]
  // Columns of the regression: 0 is a constant, 1 the direction of turning. The fit does not use COSINE and SINE.
  static constexpr int TWIN = 2;
  static constexpr int COSINE = 3;
  static constexpr int SINE = 4;

  struct Bin
  {
    double sum{};
    double rows{};
  };

  RunningRegression fitted() const
  {
    RunningRegression regression = regression_;
    regression.fit(TWIN + 1);
    return regression;
  }
  double covariance(int column, int other) const
  {
    return regression_.mean(column, other) - regression_.mean(column, 0) * regression_.mean(other, 0);
  }

  double step_;    // width of a step of the torque [N.m]
  double zero_{};  // torsion of the first row [rad]
  RunningRegression regression_;
  std::array<std::array<Bin, 2 * STEPS + 1>, 2> bins_{};  // by direction of turning, then by torque in increasing order
};

/// Health of a measured joint from its own signals. After construction nothing allocates or throws.
class SignalWatch
{
public:
  explicit SignalWatch(const Parameters& parameters)
    : telemetry_(parameters.telemetry)
    , ratio_(nominalRatio(parameters.gear))
    , temperature_(parameters.input.temperature)
    , monitor_(withoutWeight(parameters))  // because the load of a sample contains the weight
    , assessor_(parameters)
  {
  }

  /// Sets the reference, from the joint when it was sound. Without this call the first windows are the reference.
  void setReference(std::vector<ReferenceBin> bins) { assessor_.setReference(std::move(bins)); }

  /// Takes a sample whose load includes weight and inertia. Returns true if it completed a window of the indicators.
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
  double temperature_;  // assumed temperature of samples without one [degC]
  SignalMonitor monitor_;
  Assessor assessor_;
};

/// A contact that the torque of a joint shows.
struct Contact
{
  double since{};    ///< time when the contact began [s]
  double lasted{};   ///< duration of the contact without its pauses, which are shorter than ContactWatch::HOLD [s]
  double largest{};  ///< largest difference between residual torque and usual residual torque [N.m]
};

/// Detects that something touches the arm: for a short time the residual torque of a joint differs from its usual
/// residual torque. A residual that persists becomes the usual one. If the residual is unusual for more than a fifth of
/// the motion, the reason is friction, gain or payload, and not a contact.
///
/// A contact begins when the residual, averaged over MEAN, has differed for LASTING from the usual residual of this
/// direction of motion by more than half of the friction + 5 % of the load + 2 % of the largest load. If the rows are
/// far apart, the window of their rates spreads a jolt over a longer time, and LASTING is longer by as much. The memory
/// has a fixed size; nothing allocates or throws.
class ContactWatch
{
public:
  static constexpr double MEMORY = 10.0;  ///< time of motion in one direction over which the usual residual adapts [s]
  static constexpr double HOLD = 10.0;    ///< time after a contact in which the joint is not judged [s]

  explicit ContactWatch(double largest_load) : largest_load_(largest_load) {}  ///< largest load of the joint [N.m]

  void reset() noexcept { *this = ContactWatch(largest_load_); }

  /// `residual_torque`: measured - predicted torque at the joint [N.m]. `is_held`: whether stiction holds the joint.
  void update(const MotionSample& sample, double residual_torque, double friction_torque, bool is_held) noexcept
  {
    constexpr double MEAN = 0.1;     // time over which the residual is averaged [s]
    constexpr double SETTLED = 0.3;  // time of motion in one direction after which presliding is over [s]
    constexpr double LASTING = 0.1;  // least time for which the difference must persist [s]
    constexpr double KNOWN = 2.0;    // time of motion in one direction after which the usual residual is known [s]
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
    constexpr double ROWS = 4.0;  // least number of rows from which rates are computed
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
    constexpr double OFTEN = 0.2;  // share of the motion from which on an unusual residual is no contact [-]
    return touched_ > 0.0 && touched_ < OFTEN * (usual_[0].time + usual_[1].time);
  }
  bool isTouching() const noexcept { return hasSeen() && time_ == last_; }  ///< whether the last row shows a contact
  /// Whether a contact lasts, or ended less than HOLD ago.
  bool isRecent() const noexcept { return hasSeen() && time_ - last_ < HOLD; }
  const Contact& last() const noexcept { return contact_; }     ///< the last contact
  const Contact& largest() const noexcept { return largest_; }  ///< the contact with the largest torque

private:
  struct Usual
  {
    double torque{};  // usual residual torque [N.m]
    double time{};    // time of motion in this direction [s]
  };

  double largest_load_;
  double time_{};
  int way_{};                     // direction of motion, +1 or -1; 0: at rest
  double moved_{};                // time of motion in the direction way_ [s]
  double mean_{};                 // mean difference between residual and usual residual [N.m]
  double beyond_{};               // time for which the mean difference has exceeded its bound [s]
  std::array<Usual, 2> usual_{};  // for backward and forward motion
  double last_{ -std::numeric_limits<double>::infinity() };  // time of the last row that shows a contact [s]
  double touched_{};                                         // duration of all contacts [s]
  Contact contact_;
  Contact largest_;
};

/// A clause that describes a contact.
inline std::string contactText(const Contact& contact)
{
  return "something touched the arm, or its payload changed, at " + roundedText(contact.since, 3) + " s for " +
         roundedText(contact.lasted, 2) + " s, with up to " + roundedText(contact.largest, 2) +
         " N.m more than this motion usually takes";
}

/// One window of the signals with its deviations and assessment.
struct JudgedWindow
{
  SignalIndicators indicators;
  Deviations deviations{};
  Assessment assessment;
};

constexpr double LEAST_MOTION = 0.02;  ///< range of angles below which a joint counts as at rest [rad]

/// Ranges and numbers of rows of the measured motion of a joint.
struct MotionReach
{
  bool isAtRest() const { return most_angle - least_angle < LEAST_MOTION; }

  std::uint64_t rows{};
  std::uint64_t impossible{};        ///< rows with a current or load that the joint cannot have
  std::uint64_t motor_rows{};        ///< rows with a motor angle
  std::uint64_t temperature_rows{};  ///< rows with a received temperature
  std::uint64_t touched_rows{};      ///< rows during a contact or less than ContactWatch::HOLD after it; do not count
  double begin{};                    ///< time of the first row [s]
  double end{};                      ///< time of the last row [s]
  double sampled{};                  ///< sum of the times from row to row, without gaps [s]
  double least_load{};               ///< least load [N.m]
  double most_load{};                ///< largest load [N.m]
  double least_angle{};              ///< least angle [rad]
  double most_angle{};               ///< largest angle [rad]
};

/// Source of the load in the samples.
enum class LoadOrigin
{
  CONFIGURED,  ///< configured weight and inertia of the joint
  RECORDED,
  ARM  ///< rigid-body dynamics of the arm's links and payload
};

/// Groups of a joint's parameters that JointEvidence and the verdict use.
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
  double possible_current;  ///< largest current that the joint can draw [A]
};

/// Collects the evidence on a measured joint: sums over its rows, and over the twin's values in the same motion.
/// `hjt::judge` makes a verdict of the evidence. Rows during a contact, and for ContactWatch::HOLD after it, do not
/// count, unless the load is the configured one. After construction nothing allocates or throws.
class JointEvidence
{
public:
  /// @throws ParameterError if the ring finds no equilibrium under load.
  JointEvidence(const Parameters& parameters, LoadOrigin load);

  /// Sets the reference of the signals of the sound joint. Without this call the first windows are the reference.
  void setReference(std::vector<ReferenceBin> bins);

  /// Result of update() for a row.
  enum class Row
  {
    IMPOSSIBLE,  ///< the joint cannot have the current or the load of the row
    TOUCHED,     ///< something touches the arm, or touched it less than ContactWatch::HOLD ago
    COUNTED,
    WINDOW  ///< the row counts and completed a window of the signals
  };

  /// Takes a sample whose load includes weight and inertia. `fits`: whether the signals of the sample count.
  Row update(const MotionSample& sample, bool fits = true) noexcept
  {
    predict(sample);
    return judge(sample, fits);
  }
  /// update() in two steps: predict() for every row, then judge() for rows with a known load.
  const MotionPrediction& predict(const MotionSample& sample) noexcept { return predicted_ = twin_.step(sample); }
  Row judge(const MotionSample& sample, bool fits) noexcept;

  void forget() noexcept;  ///< clears the sums, but keeps the reference of the signals and the state of the contact
  void reset() noexcept;   ///< clears everything, because rows of another recording follow
  void resetSignals() noexcept { health_.reset(); }  ///< clears only the windows of the signals

  LoadOrigin loadOrigin() const { return load_; }
  const EvidenceParameters& parameters() const { return parameters_; }
  double ratio() const { return ratio_; }
  const MotionDriven& twin() const { return twin_; }
  const MotionPrediction& predicted() const { return predicted_; }  ///< prediction for the last row
  const MotionReach& reach() const { return now_.reach; }
  const FrictionPoints& friction() const { return now_.friction; }
  /// As friction(), but FrictionPoint::twin is the friction in the controller's target current. Rows without this
  /// current do not count.
  const FrictionPoints& besideController() const { return now_.beside_controller; }
  const TorsionPoints& torsion() const { return torsion_; }
  const SignalIndicators& indicators() const { return health_.indicators(); }
  const Assessor& assessor() const { return health_.assessor(); }
  const ContactWatch& contact() const { return contact_; }
  /// Whether something touches the arm, or touched it less than ContactWatch::HOLD ago.
  bool isTouched() const { return load_ != LoadOrigin::CONFIGURED && contact_.isRecent(); }

  double currentRms() const { return rms(MEASURED); }     ///< root mean square of the measured current [A]
  double predictedRms() const { return rms(PREDICTED); }  ///< root mean square of the predicted current [A]
  double residualRms() const { return rms(RESIDUAL); }    ///< root mean square of the residual [A]
  /// Standard deviation of the residual, which an unknown constant load does not change [A].
  double residualSpread() const;
  /// Root mean square of the residual [A] after subtraction of the constant and of the multiple of the predicted
  /// friction that fit best. So a constant load, wear and cold grease do not count.
  double unexplainedRms() const;
  /// Measured over predicted current for load and inertia, without friction [-]; NaN: the prediction is too small.
  FittedFactor loadFactor() const;
  double temperature() const;  ///< mean temperature of the rows [degC]
  /// Whether more than half of the rows had a received temperature.
  bool isTemperatureReceived() const { return 2 * now_.reach.temperature_rows > now_.reach.rows; }
  /// Mean friction [N.m] of the twin at the speeds of friction() and the median load, at a temperature [degC].
  double twinFrictionAt(double temperature) const;
  double typicalLoad() const { return loadQuantile(0.5); }    ///< median of the load's magnitude [N.m]
  double largestLoad() const { return loadQuantile(0.999); }  ///< load that one row in a thousand exceeds [N.m]

  bool baselineGiven() const { return baseline_given_; }
  std::uint64_t assessedWindows() const { return now_.assessed; }
  /// The last window at the worst level; none: no window was judged.
  const std::optional<JudgedWindow>& worst() const { return now_.worst; }
  /// The last assessment that had too few windows for a verdict; none: there is no such assessment.
  const std::optional<Assessment>& tooFew() const { return now_.too_few; }
  double alarmTime() const { return now_.alarm_time; }  ///< time of the first window whose level is not OK [s]
  Cause cause() const;                                  ///< most frequent cause of the windows whose level is not OK
  double causeShare() const;                            ///< share of cause() in the windows whose level is not OK [-]

private:
  static constexpr int LOAD_STEPS = 568;  // number of steps of the load in the histogram [-]
  enum Product : int
  {
    ONE,
    FRICTION,
    RESIDUAL,
    PREDICTED,
    MEASURED,
    PRODUCTS
  };
  using Products = Eigen::Matrix<double, PRODUCTS, PRODUCTS>;

  /// Sums over the rows that count.
  struct Sums
  {
    MotionReach reach;
    FrictionPoints friction;
    FrictionPoints beside_controller;
    std::array<std::uint64_t, LOAD_STEPS + 2> loads{};  // histogram of the load's magnitude
    double temperatures{};                              // sum of the temperatures [degC]
    Products products{ Products::Zero() };              // products of the quantities in Product with each other [A^2]
    /// Products with each other of 1 and of the currents for predicted friction, rest of the prediction and residual
    /// [A^2], summed over the rows that show friction.
    Eigen::Matrix4d gains{ Eigen::Matrix4d::Zero() };
    double gains_time{};  // duration of the rows in `gains` [s]
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
  double counted() const;  // number of rows that count, at least 1
  double rms(Product of) const;

  const EvidenceParameters parameters_;
  const LoadOrigin load_;
  const double ratio_;
  const double load_step_;  // width of a step of the load in the histogram [N.m]
  MotionDriven twin_;
  MotionPrediction predicted_;
  TorsionCourse course_;
  double twin_torsion_{};  // torsion of the twin at the last row with a motor angle [rad]
  ContactWatch contact_;
  SignalWatch health_;
  bool baseline_given_{};
  TorsionPoints torsion_;
  Sums now_;
};
}  // namespace hjt
