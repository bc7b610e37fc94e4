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
/// By how much one signal of a stream lags behind another: where their cross-correlation is largest.
///
/// Both pass the same high-pass; products are summed for lags on a grid up to LONGEST to either side and forgotten over
/// MEMORY; a parabola through the largest three gives what lies between. Fixed memory; nothing allocates.
class DelayEstimate
{
public:
  static constexpr double LONGEST = 0.1;          ///< [s]
  static constexpr double GRID = 0.004;           ///< between lags tried [s]
  static constexpr double MEMORY = 20.0;          ///< [s]
  static constexpr double MIN_CORRELATION = 0.7;  ///< below it no delay is given [-]

  void reset() noexcept { *this = DelayEstimate(); }

  /// A row of both, later than the one before [s].
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

    // The lagging signal is taken in the middle of what is held, so that the leading one is known to either side.
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

  /// Of the lagging signal, > 0: it comes later [s]. Nothing: too little alike, or the largest lies at the end.
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
  static constexpr double MIN_SECONDS = 2.0;  // of signal before a delay is given

  static constexpr std::size_t ROOM = 512;
  static constexpr int HALF = 25;  // LONGEST / GRID
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
  std::uint64_t begin_{};  // first row of the present stretch
  std::uint64_t end_{};
  double leading_mean_{};
  double lagging_mean_{};
  std::array<double, LAGS> products_{};
  std::array<double, LAGS> leading_power_{};
  double lagging_power_{};
  double seconds_{};  // that the sums hold
};

/// One quantity, measured and predicted.
struct Compared
{
  double measured{};
  double predicted{};
  double band{};  ///< half width within which a healthy joint's residual is expected; 0: nothing is known of it

  double residual() const noexcept { return measured - predicted; }
};

/// A healthy joint beside the measured one at the time of one row of telemetry. Fields as in Comparison.msg; always
/// finite.
struct Comparison
{
  double time{};             ///< of the row [s]
  Compared position;         ///< of the joint [rad]
  Compared velocity;         ///< of the joint [rad/s]
  Compared current;          ///< of the motor [A]
  double joint_torque{};     ///< torque on the arm: measured, less friction and the rotor's inertia [N.m]
  double friction_torque{};  ///< of a healthy joint, at the joint, with its sign [N.m]
  double load_torque{};      ///< at the output that was reckoned with, all in all, > 0 resists positive motion [N.m]
  bool load_provided{};      ///< a load was received; else weight and inertia as configured, and where telemetry.load
                             ///< expects one, no band
  double temperature{};      ///< of the grease, that the prediction was made at [degC]
  bool temperature_received{};   ///< it comes from a received one; else estimated or as configured
  double housing_temperature{};  ///< thermal.model = two_nodes: beside the motor; else that of the grease [degC]
  bool sticking{};               ///< friction holds the joint: any current within the band fits
  bool after_gap{};              ///< first after a gap in the telemetry

  /// Measured less predicted current as a torque at the joint [N.m].
  double residual_torque{};
  bool isOutside() const noexcept { return std::abs(current.residual()) > current.band && current.band > 0.0; }
};

/// Counts of the rows that were given.
struct TrackerCounters
{
  std::uint64_t compared{};              ///< rows beside which there is a comparison
  std::uint64_t refused{};               ///< repeated, out of order, not finite or beyond what can be
  std::uint64_t gaps{};                  ///< longer than MotionDifferentiator::MAX_GAP
  std::uint64_t restarts{};              ///< stamps went back by more than StreamTiming::RESTART
  std::uint64_t outside{};               ///< comparisons whose current lies outside its band
  std::uint64_t without_load{};          ///< comparisons without a received load, though telemetry.load expects one
  std::uint64_t refused_temperatures{};  ///< not finite or beyond what a drive can have
  std::uint64_t solver_failures{};       ///< steps of the twin in torque mode that did not converge
};

/// The twin beside a robot: rows of telemetry in, comparisons and health out, in one of the modes `torque`, `motion`
/// and `observer`. Live and offline alike: the same rows and loads give the same numbers, if a load comes before the
/// rows that are MotionDifferentiator::HALF_WIDTH later than it. Knows no ROS; after construction nothing throws or
/// allocates.
class Tracker
{
public:
  static constexpr double OUTSIDE_MEMORY = 30.0;  ///< a touch of the arm is shorter [s]

  /// @throws ParameterError where the parameters do not allow the mode; `mode` is not COMMANDS.
  Tracker(const Parameters& parameters, InputMode mode, const SurfaceSource& surface_source = {});
  ~Tracker();

  void reset() noexcept;

  /// False: the telemetry does not fit together; health is not judged, and starts again once it does.
  void setFits(bool fits) noexcept;

  /// The load at the output from `time` on; as telemetry.load says, external or all in all [N.m]. Not finite: refused.
  void pushLoad(double time, double torque) noexcept;

  /// The temperature of the drive from `time` on, for rows without their own [degC]. Bad ones are refused and counted.
  void pushTemperature(double time, double temperature) noexcept { temperatures_.push(time, temperature); }

  /// An estimate for rows without a received temperature [degC]; none: the configured one.
  void setTemperature(std::optional<double> temperature) noexcept { estimated_temperature_ = temperature; }

  bool hasEstimate() const noexcept { return estimated_temperature_.has_value(); }

  /// Reference of the joint's signals; none: learned from the first windows. Allocates.
  void setReference(std::vector<ReferenceBin> bins) { evidence_.setReference(std::move(bins)); }

  /// A row of telemetry; its own load is passed over. Take the comparisons afterwards.
  void push(const MotionRow& row) noexcept;

  /// The next comparison that is ready, at most MotionDifferentiator::HALF_WIDTH after its row. Call it until there is
  /// none.
  std::optional<Comparison> pop(bool at_end = false) noexcept;

  /// In place of both, for a row whose rates are known, as ArmLoad makes it: later than the one before, its values
  /// possible. Its own load is passed over too.
  Comparison compare(MotionSample sample) noexcept;

  /// The last comparison had the load that is expected, or none is.
  bool isLoadKnown() const noexcept { return load_is_known_; }

  TrackerCounters counters() const noexcept;

  /// Share of the last rows, forgotten over OUTSIDE_MEMORY, whose current lies outside its band [-].
  double outsideShare() const noexcept { return outside_share_; }

  /// Of the measured joint, in every mode alike. While something touches the arm its health is not judged, starts again
  /// afterwards, and the rows do not count as outside.
  const JointEvidence& evidence() const noexcept { return evidence_; }

  /// The verdict is of what follows.
  void forgetEvidence() noexcept { evidence_.forget(); }

  /// Delay of the measured signal relative to its prediction: current (motion) or speed (torque); the observer has none
  /// [s].
  std::optional<double> lag() const noexcept { return lag_.lag(); }

  /// Health of the measured joint, from its own signals.
  const SignalIndicators& signalIndicators() const noexcept { return evidence_.indicators(); }
  const Assessment& assessment() const noexcept { return evidence_.assessor().assessment(); }

  /// Predicts a sample in this mode: fills position, velocity, current, torques. @param external load besides the
  /// weight and inertia that are configured; the whole is in the sample [N.m]
  class Follower
  {
  public:
    virtual ~Follower() = default;
    virtual void follow(const MotionSample& sample, double external, Comparison& now) noexcept = 0;
    virtual std::uint64_t solverFailures() const noexcept { return 0; }
  };

private:
  void restart() noexcept;
  void begin(double time) noexcept;
  Comparison comparisonOf(MotionSample& sample) noexcept;
  std::optional<double> loadAt(double time) const noexcept;
  void watch(const MotionSample& sample, const Comparison& now, bool load_is_known) noexcept;

  InputMode mode_;
  LoadSource load_source_;
  Load load_;
  TelemetryParameters telemetry_;
  double ratio_;
  GreaseTemperature grease_;
  double temperature_;                           // of the grease, at the last row [degC]
  std::optional<double> estimated_temperature_;  // in its place where none is received [degC]
  JointEvidence evidence_;
  std::unique_ptr<Follower> follower_;
  MotionDifferentiator smoother_;
  bool restarted_{};
  bool fits_{ true };
  bool load_is_known_{ true };
  double last_time_{ -HUGE_VAL };  // of the rows since the last restart [s]
  HeldValues loads_;
  TemperatureRecord temperatures_;
  double outside_share_{};
  double last_compared_{};  // [s]
  DelayEstimate lag_;
  TrackerCounters counters_;
  std::uint64_t refused_{};  // before the smoother, and by it before the last restart
};
}  // namespace hjt
