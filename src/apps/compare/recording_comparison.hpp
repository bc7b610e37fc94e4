// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "apps/compare/decimated.hpp"
#include "apps/compare/friction_points.hpp"
#include "apps/compare/residual_spectrum.hpp"
#include "apps/compare/torsion_points.hpp"

#include "tracking/contact_watch.hpp"
#include "tracking/motion_driven.hpp"
#include "tracking/signal_watch.hpp"

namespace hjt
{
/// One row, measured beside predicted.
struct ComparedRow
{
  MotionSample measured;
  MotionPrediction predicted;

  double residual() const { return measured.current - predicted.current; }  ///< [A]
};

/// One window of the signals and what was made of it.
struct JudgedWindow
{
  SignalIndicators indicators;
  Deviations deviations{};
  Assessment assessment;
};

/// What the recorded motion covers.
struct MotionReach
{
  std::uint64_t rows{};
  std::uint64_t impossible{};        ///< rows with a current or load beyond what the joint has
  std::uint64_t motor_rows{};        ///< rows with a motor angle
  std::uint64_t temperature_rows{};  ///< rows with a received temperature
  double least_load{};               ///< [N.m]
  double most_load{};                ///< [N.m]
  double least_angle{};              ///< [rad]
  double most_angle{};               ///< [rad]
};

/// A recorded joint beside the twin that makes the same motion, row by row; memory does not grow with the rows.
class RecordingComparison
{
public:
  static constexpr double MOVING = 0.01;  ///< [rad/s]

  /// `baseline`: of the sound joint; empty: learned from the first windows. `watch`: is given every window.
  /// @throws ParameterError if the ring finds no equilibrium under load.
  RecordingComparison(const Parameters& parameters, std::vector<ReferenceBin> baseline,
                      std::function<void(const JudgedWindow&)> watch);

  void update(const MotionSample& sample);

  double ratio() const { return ratio_; }
  const MotionDriven& twin() const { return twin_; }
  const MotionReach& reach() const { return reach_; }
  const Decimated<ComparedRow>& course() const { return course_; }
  const FrictionPoints& friction() const { return friction_; }
  const ResidualSpectrum& spectrum() const { return spectrum_; }
  const TorsionPoints& torsion() const { return torsion_; }
  const Assessor& assessor() const { return health_.assessor(); }

  double currentRms() const;    ///< of the measured current [A]
  double predictedRms() const;  ///< of the predicted current [A]
  double residualRms() const;   ///< [A]
  /// Standard deviation of the residual about its mean: an unknown constant load does not count [A].
  double residualSpread() const;
  /// What of the residual is left after the best constant and the best multiple of the predicted friction: neither a
  /// constant load nor worn or cold grease counts, rms [A].
  double unexplainedRms() const;
  const ContactWatch& contact() const { return contact_; }  ///< means something where the load is that of the arm
  double temperature() const;                               ///< that the rows were judged at, mean [degC]
  /// More than half of the rows had a received temperature.
  bool isTemperatureReceived() const { return 2 * reach_.temperature_rows > reach_.rows; }
  /// The twin's friction by the speeds of `friction`, under the typical load, at a temperature [degC], mean [N.m].
  double twinFrictionAt(double temperature) const;
  double typicalLoad() const;  ///< median of its magnitude [N.m]
  double largestLoad() const;  ///< that all but one in a thousand rows stay below [N.m]

  bool baselineGiven() const { return baseline_given_; }
  std::uint64_t assessedWindows() const { return assessed_; }
  /// The last window of those at the worst level; none: no window was compared with a reference.
  const std::optional<JudgedWindow>& worst() const { return worst_; }
  double alarmTime() const { return alarm_time_; }  ///< when the level first left OK [s]
  Cause cause() const;                              ///< that most windows in alarm name

private:
  void watchSignals(const MotionSample& sample);
  double loadQuantile(double share) const;

  static constexpr double LOAD_STEPS = 568.0;  // of the histogram

  const Parameters parameters_;
  const double ratio_;
  MotionDriven twin_;
  MotionReach reach_;
  Decimated<ComparedRow> course_;
  FrictionPoints friction_;
  ResidualSpectrum spectrum_;
  TorsionPoints torsion_;
  ContactWatch contact_;
  const double load_step_;            // [N.m]
  std::vector<std::uint64_t> loads_;  // histogram of magnitudes
  double current_squares_{};
  double predicted_squares_{};
  double temperatures_{};                                // sum [degC]
  Eigen::Matrix3d products_{ Eigen::Matrix3d::Zero() };  // of 1, predicted friction, residual [1, A, A]

  SignalWatch health_;
  const bool baseline_given_;
  const std::function<void(const JudgedWindow&)> watch_;
  std::uint64_t assessed_{};
  std::optional<JudgedWindow> worst_;
  double alarm_time_{};
  std::array<std::uint64_t, CAUSE_COUNT> votes_{};
};
}  // namespace hjt
