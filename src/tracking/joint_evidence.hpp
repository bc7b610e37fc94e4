// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "statics/torsion_curve.hpp"
#include "tracking/contact_watch.hpp"
#include "tracking/friction_points.hpp"
#include "tracking/motion_driven.hpp"
#include "tracking/plausible.hpp"
#include "tracking/signal_watch.hpp"
#include "tracking/time_fit.hpp"
#include "tracking/torsion_points.hpp"

namespace hjt
{
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
  static constexpr double MOVING = 0.01;  ///< [rad/s]

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
  /// The friction is all mobilised.
  bool tellsFriction(const MotionPrediction& predicted) const noexcept;
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
