// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "elements/load.hpp"
#include "surface/surface_cache.hpp"
#include "tracking/drive_temperature.hpp"
#include "tracking/joint_evidence.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
class Observer;

/// Lag of one signal behind another signal: the lag at which their cross-correlation is largest.
///
/// Both signals pass the same high-pass filter. The class sums products of the signals for lags on a grid from -LONGEST
/// to LONGEST, and forgets old products over MEMORY. A parabola through the largest correlation and its two neighbours
/// gives a lag between points of the grid. Nothing allocates.
class DelayEstimate
{
public:
  static constexpr double LONGEST = 0.1;          ///< longest lag [s]
  static constexpr double GRID = 0.004;           ///< difference between two neighbouring lags [s]
  static constexpr double MEMORY = 20.0;          ///< time constant with which the sums forget old rows [s]
  static constexpr double MIN_CORRELATION = 0.7;  ///< least correlation that gives a lag [-]

  void reset() noexcept { *this = DelayEstimate(); }

  /// Adds a row of both signals. `time` [s] must be later than in the row before.
  void add(double time, double leading, double lagging) noexcept
  {
    const bool first = end_ == begin_ || time > at(end_ - 1).time + MotionDifferentiator::MAX_GAP;
    const double step = first ? 0.0 : time - at(end_ - 1).time;
    if (first)
    {
      begin_ = end_;
      leading_mean_ = leading;
      lagging_mean_ = lagging;
    }
    const double fresh = 1.0 - std::exp(-step / SLOWEST);
    leading_mean_ += fresh * (leading - leading_mean_);
    lagging_mean_ += fresh * (lagging - lagging_mean_);
    rows_[end_ % ROOM] = { time, leading - leading_mean_, lagging - lagging_mean_ };
    ++end_;

    // The lagging signal counts at a time in the middle of the held rows. So rows before and after this time are known.
    const double middle = time - LONGEST;
    const std::uint64_t oldest = std::max(begin_, end_ > ROOM ? end_ - ROOM : 0);
    if (at(oldest).time > middle - LONGEST)
    {
      return;
    }
    std::uint64_t above = end_ - 1;
    const auto interpolate = [&](double when, double Row::*signal)
    {
      while (above > oldest + 1 && at(above - 1).time > when)
      {
        --above;
      }
      const Row& high = at(above);
      const Row& low = at(above - 1);
      return low.*signal + (high.*signal - low.*signal) * (when - low.time) / (high.time - low.time);
    };
    const double later = interpolate(middle, &Row::lagging);
    const double kept = std::exp(-step / MEMORY);
    seconds_ = kept * seconds_ + step;
    lagging_power_ = kept * lagging_power_ + step * later * later;
    above = end_ - 1;
    for (std::size_t i = 0; i < LAGS; ++i)
    {
      const double earlier = interpolate(middle - GRID * (static_cast<double>(i) - HALF), &Row::leading);
      products_[i] = kept * products_[i] + step * later * earlier;
      leading_power_[i] = kept * leading_power_[i] + step * earlier * earlier;
    }
  }

  /// Lag of `lagging` behind `leading` [s]. None: too few rows, a correlation below MIN_CORRELATION, or no peak.
  std::optional<double> lag() const noexcept
  {
    std::size_t best = 0;
    for (std::size_t i = 1; i < LAGS; ++i)
    {
      best = correlation(i) > correlation(best) ? i : best;
    }
    const double peak = correlation(best);
    if (seconds_ < MIN_SECONDS || best == 0 || best + 1 == LAGS || peak < MIN_CORRELATION)
    {
      return std::nullopt;
    }
    const double below = correlation(best - 1);
    const double above = correlation(best + 1);
    const double bend = below - 2.0 * peak + above;
    const double beside = bend < 0.0 ? 0.5 * (below - above) / bend : 0.0;
    return GRID * (static_cast<double>(best) - HALF + beside);
  }

private:
  static constexpr double MIN_SECONDS = 2.0;  // least duration of the signals for a lag [s]

  static constexpr std::size_t ROOM = 512;
  static constexpr int HALF = 25;  // number of lags in each direction: LONGEST / GRID
  static constexpr std::size_t LAGS = 2 * HALF + 1;
  static constexpr double SLOWEST = 0.5;  // time constant of the high-pass [s]

  struct Row
  {
    double time;
    double leading;
    double lagging;
  };
  const Row& at(std::uint64_t index) const noexcept { return rows_[index % ROOM]; }

  double correlation(std::size_t lag) const noexcept
  {
    const double power = leading_power_[lag] * lagging_power_;
    return power > 0.0 ? products_[lag] / std::sqrt(power) : 0.0;
  }

  std::array<Row, ROOM> rows_{};
  std::uint64_t begin_{};  // number of the first row after the last gap
  std::uint64_t end_{};
  double leading_mean_{};
  double lagging_mean_{};
  std::array<double, LAGS> products_{};
  std::array<double, LAGS> leading_power_{};
  double lagging_power_{};
  double seconds_{};  // duration of the signals in the sums, less what the sums have forgotten [s]
};

/// Measured value of a quantity, and its prediction.
struct Compared
{
  double measured{};
  double predicted{};
  double band{};  ///< half width of the range in which the residual of a sound joint stays; 0: not known

  double residual() const noexcept { return measured - predicted; }
};

/// Comparison of a measured joint with a sound joint at the time of one row of telemetry. The fields are those of
/// Comparison.msg. Their values are always finite.
struct Comparison
{
  double time{};             ///< time of the row [s]
  Compared position;         ///< angle of the joint [rad]
  Compared velocity;         ///< speed of the joint [rad/s]
  Compared current;          ///< current of the motor [A]
  double joint_torque{};     ///< torque of the joint on the arm: motor torque - friction - inertia of the rotor [N.m]
  double friction_torque{};  ///< friction of a sound joint, at the joint, with the sign of the motion [N.m]
  double load_torque{};      ///< load with weight and inertia in the prediction; > 0 resists positive motion [N.m]
  bool load_provided{};      ///< whether a load was received; if one is expected but missing, the current has no band
  double temperature{};      ///< temperature of the grease in the prediction [degC]
  bool temperature_received{};   ///< whether `temperature` follows from a received temperature
  double housing_temperature{};  ///< temperature near the motor if thermal.model = two_nodes, else of the grease [degC]
  bool sticking{};               ///< whether friction holds the joint, so that any current within the band is possible
  bool after_gap{};              ///< whether this row is the first one after a gap in the telemetry

  double residual_torque{};  ///< measured - predicted current, as a torque at the joint [N.m]
  bool isOutside() const noexcept { return std::abs(current.residual()) > current.band && current.band > 0.0; }
};

/// Numbers of rows and events in a Tracker.
struct TrackerCounters
{
  std::uint64_t compared{};              ///< rows with a comparison
  std::uint64_t refused{};               ///< rows that are repeated, out of order, not finite or impossible
  std::uint64_t gaps{};                  ///< gaps longer than MotionDifferentiator::MAX_GAP
  std::uint64_t restarts{};              ///< number of times that stamps went back by more than StreamTiming::RESTART
  std::uint64_t outside{};               ///< comparisons with a current outside its band
  std::uint64_t without_load{};          ///< comparisons without a load, although telemetry.load expects a received one
  std::uint64_t refused_temperatures{};  ///< temperatures that are not finite or impossible
  std::uint64_t solver_failures{};       ///< steps of the twin in mode `torque` without convergence
};

/// The twin beside a robot: compares rows of telemetry with a prediction, in mode `torque`, `motion` or `observer`, and
/// judges the health. Live rows and rows of a recording give the same results if each load arrives before the rows that
/// are MotionDifferentiator::HALF_WIDTH later. After construction nothing throws or allocates.
class Tracker
{
public:
  static constexpr double OUTSIDE_MEMORY = 30.0;  ///< time constant of outsideShare(), longer than a contact [s]

  /// @throws ParameterError if the parameters do not allow the mode. `mode` must not be COMMANDS.
  Tracker(const Parameters& parameters, InputMode mode, const SurfaceSource& surface_source = {});
  ~Tracker();

  void reset() noexcept;

  /// `fits`: whether angles, velocities and efforts of the telemetry fit together. If not, the health is not judged.
  /// The windows of the signals start again when the telemetry fits.
  void setFits(bool fits) noexcept;

  /// Sets the load at the output from `time` [s] on [N.m]: the load without or with weight and inertia, as
  /// telemetry.load says. Ignores a number that is not finite.
  void pushLoad(double time, double torque) noexcept;

  /// Sets the drive's temperature [degC] from `time` [s] on for rows without it. Counts and ignores impossible values.
  void pushTemperature(double time, double temperature) noexcept { temperatures_.push(time, temperature); }

  /// Sets the estimated temperature for rows without a received temperature [degC]; none: the configured temperature.
  void setTemperature(std::optional<double> temperature) noexcept { estimated_temperature_ = temperature; }

  bool hasEstimate() const noexcept { return estimated_temperature_.has_value(); }

  /// Sets the reference of the joint's signals. Without this call the first windows are the reference. Allocates.
  void setReference(std::vector<ReferenceBin> bins) { evidence_.setReference(std::move(bins)); }

  /// Takes a row of telemetry and ignores MotionRow::load. Call pop() afterwards.
  void push(const MotionRow& row) noexcept;

  /// The next comparison that is ready; none: no comparison is ready. A comparison is ready when the rows after its row
  /// are known (MotionDifferentiator). Call this function until it returns none.
  std::optional<Comparison> pop(bool at_end = false) noexcept;

  /// Replaces push() and pop() for a row with known speed and acceleration, for example from ArmLoad. The row must be
  /// later than the row before, and its values possible. The function ignores MotionRow::load.
  Comparison compare(MotionSample sample) noexcept;

  /// Whether the load of the last comparison was known: a load was received, or telemetry.load expects none.
  bool isLoadKnown() const noexcept { return load_is_known_; }

  TrackerCounters counters() const noexcept;

  /// Share of the rows with a current outside its band, averaged over OUTSIDE_MEMORY [-].
  double outsideShare() const noexcept { return outside_share_; }

  /// Evidence on the measured joint. The evidence is the same in every mode. Rows during a contact, and for
  /// ContactWatch::HOLD after it, do not count for evidence and outsideShare(). The windows of the signals then start
  /// again.
  const JointEvidence& evidence() const noexcept { return evidence_; }

  /// Clears the evidence, so that only later rows count for the next verdict.
  void forgetEvidence() noexcept { evidence_.forget(); }

  /// Lag of the measured behind the predicted current (mode `motion`) or speed (mode `torque`) [s]; none: not known.
  std::optional<double> lag() const noexcept { return lag_.lag(); }

  /// Indicators of the measured joint, from its own signals.
  const SignalIndicators& signalIndicators() const noexcept { return evidence_.indicators(); }
  const Assessment& assessment() const noexcept { return evidence_.assessor().assessment(); }

private:
  void restart() noexcept;
  void begin(double time) noexcept;
  Comparison comparisonOf(MotionSample& sample) noexcept;
  std::optional<double> loadAt(double time) const noexcept;
  // Each of these functions fills position, velocity, current and torques of a comparison. `external`: load without the
  // configured weight and inertia [N.m]. `sample.load`: load with weight and inertia [N.m].
  void predictByTorque(const MotionSample& sample, double external, Comparison& now) noexcept;
  void predictByMotion(const MotionSample& sample, Comparison& now) const noexcept;
  void predictByObserver(const MotionSample& sample, double external, Comparison& now) noexcept;
  void watch(const MotionSample& sample, const Comparison& now, bool load_is_known) noexcept;

  LoadSource load_source_;
  Load load_;
  TelemetryParameters telemetry_;
  double ratio_;
  GreaseTemperature grease_;
  double temperature_;                           // temperature of the grease at the last row [degC]
  std::optional<double> estimated_temperature_;  // estimate for rows without a received temperature [degC]
  JointEvidence evidence_;
  std::unique_ptr<TorqueDriven> torque_driven_;  // null in all modes except TORQUE
  std::unique_ptr<Observer> observer_;           // null in all modes except OBSERVER
  MotionDifferentiator smoother_;
  bool restarted_{};
  bool fits_{ true };
  bool load_is_known_{ true };
  double last_time_{ -HUGE_VAL };  // time of the last row since the last restart [s]
  HeldValues loads_;
  TemperatureRecord temperatures_;
  double outside_share_{};
  double last_compared_{};  // time of the last comparison [s]
  DelayEstimate lag_;
  TrackerCounters counters_;
  std::uint64_t refused_{};  // number of rows that push() refused, and that smoother_ refused before its last restart
};
}  // namespace hjt
