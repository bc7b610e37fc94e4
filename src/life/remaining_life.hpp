// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <boost/math/special_functions/erf.hpp>

#include "harmonic_joint_twin/health/assessment.hpp"
#include "life/ageing_laws.hpp"
#include "life/drive_ageing.hpp"
#include "life/wear_trend.hpp"

namespace hjt
{
constexpr double FARTHEST = 30.0;  // largest normal deviate in the computations, whose probability a double holds [-]

inline double squared(double value)
{
  return value * value;
}

inline double normalShare(double deviation) noexcept  ///< probability of a smaller normal deviate [-]
{
  return 0.5 * std::erfc(-deviation / std::sqrt(2.0));
}

/// Quantile for `share` of the standard normal distribution, truncated above at `most`.
inline double normalBelow(double most, double share) noexcept
{
  const double part = share * normalShare(std::clamp(most, -FARTHEST, FARTHEST));
  return -std::sqrt(2.0) * boost::math::erfc_inv(2.0 * std::clamp(part, 1e-300, 1.0 - 1e-16));
}

/// Quantile for `share` of a log-normal factor with median 1, truncated above at `ends_at`, because a larger factor
/// would have ended the use of the drive. `spread`: standard deviation of the factor's logarithm.
inline double factorBelow(double ends_at, double spread, double share) noexcept
{
  return spread > 0.0 ? std::exp(spread * normalBelow(std::log(ends_at) / spread, share)) : 1.0;
}

/// Quantile for `share` of the standard normal distribution.
inline double normalAt(double share) noexcept
{
  return normalBelow(FARTHEST, share);
}

/// Tabulated distribution of the wear of a drive over the wear of the nominal drive (the factor of wear).
class FactorTable
{
public:
  /// Computes the distribution, given the readings of `trend`. `spread`: prior standard deviation of the logarithm;
  /// `ends_at`: largest factor, because a larger factor would have ended the use of the drive.
  void given(const WearTrend& trend, double spread, double ends_at) noexcept
  {
    constexpr double REACH = 6.5;  // range of the table, in standard deviations of the logarithm
    is_read_ = trend.isKnown() && spread > 0.0;
    spread_ = spread;
    ends_at_ = ends_at;
    if (!is_read_)
    {
      return;
    }
    const double last = std::clamp(std::log(ends_at) / spread, 1e-3 - REACH, REACH);
    first_ = -REACH * spread;
    step_ = (last + REACH) * spread / static_cast<double>(NODES - 1);
    double largest = -HUGE_VAL;
    for (std::size_t i = 0; i < NODES; ++i)
    {
      const double logarithm = first_ + step_ * static_cast<double>(i);
      reached_[i] = trend.logDensity(std::exp(logarithm)) - 0.5 * squared(logarithm / spread);
      largest = std::max(largest, reached_[i]);
    }
    double before = 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < NODES; ++i)
    {
      const double here = std::exp(reached_[i] - largest);
      sum += i == 0 ? 0.0 : before + here;
      before = here;
      reached_[i] = sum;
    }
    std::transform(reached_.begin(), reached_.end(), reached_.begin(), [sum](double value) { return value / sum; });
  }

  double drawn(double share) const noexcept  ///< quantile of the factor for `share` [-]
  {
    if (!is_read_)
    {
      return factorBelow(ends_at_, spread_, share);
    }
    const auto after = std::lower_bound(reached_.begin() + 1, reached_.end() - 1, share);
    const double stretch = *after - *(after - 1);
    const double part = stretch > 0.0 ? (share - *(after - 1)) / stretch : 0.5;
    return std::exp(first_ + step_ * (static_cast<double>(after - 1 - reached_.begin()) + part));
  }

private:
  static constexpr std::size_t NODES = 4096;

  std::vector<double> reached_ = std::vector<double>(NODES);  // cumulative distribution at each node
  double first_{};                                            // logarithm of the factor at the first node
  double step_{};
  double spread_{};
  double ends_at_{};
  bool is_read_{};
};

/// Number of fatigue strengths in the table Usage::fatigue. The strengths are evenly spaced in the logarithm, and the
/// logarithm of the fatigue is interpolated linearly over the logarithm of the strength.
constexpr std::size_t STRENGTHS = 49;
constexpr double STRENGTH_REACH = 1.5;  // range of ln(strength / median strength) on either side of 0 [-]

/// Fatigue strength of entry i of the table Usage::fatigue, over the median of all drives [-].
inline double strengthAt(std::size_t i)
{
  return std::exp(STRENGTH_REACH * (2.0 * static_cast<double>(i) / static_cast<double>(STRENGTHS - 1) - 1.0));
}

/// Use of a drive, expressed as the ageing of the nominal drive by this use.
struct Usage
{
  double flank_wear{};      ///< wear of the nominal drive's more worn flank, leading or trailing [m]
  double mean_flank{};      ///< mean wear of the nominal drive's two flanks: half of the growth of the play [m]
  double interface_wear{};  ///< interface wear of the nominal drive [m]
  double bearing_turns{};   ///< number of turns at rated torque that wear the bearing as much as the use
  /// Miner's sums by fatigue strength and place. The ratio of two strengths does not give the ratio of their sums.
  std::array<std::array<double, STRESS_PLACES>, STRENGTHS> fatigue{};
  double fillings{};  ///< number of used fillings of grease [-]

  Usage operator-(const Usage& other) const noexcept
  {
    Usage rest{ flank_wear - other.flank_wear,
                mean_flank - other.mean_flank,
                interface_wear - other.interface_wear,
                bearing_turns - other.bearing_turns,
                fatigue,
                fillings - other.fillings };
    for (std::size_t i = 0; i < STRENGTHS; ++i)
    {
      for (std::size_t place = 0; place < STRESS_PLACES; ++place)
      {
        rest.fatigue[i][place] -= other.fatigue[i][place];
      }
    }
    return rest;
  }
};

/// Future use from now on, in equal intervals. After the last interval, the use of this interval repeats without end.
struct FutureLoad
{
  double step{};             ///< length of an interval [h]
  std::vector<Usage> usage;  ///< entry i: use in the next i times `step` hours; at least two entries
  /// Wear limits of flanks and interface [m], as depths that the same use would cause with the loads of the new drive
  /// (LoadFeedback); 0: the limits of the parameters.
  double flank_limit{};
  double interface_limit{};
};

struct RemainingHours
{
  static constexpr std::array<double, 5> SHARES{ 0.05, 0.1, 0.5, 0.9, 0.95 };
  static constexpr std::array CAUSES{
    EndOfLife::FLANK_WEAR,          EndOfLife::INTERFACE_WEAR,     EndOfLife::BEARING,
    EndOfLife::TOOTH_SPACE_FATIGUE, EndOfLife::TRANSITION_FATIGUE, EndOfLife::FLANGE_FATIGUE
  };
  static constexpr std::size_t BINS = 102;
  static constexpr double FIRST_EDGE = 10.0;  // [h]
  static constexpr double BINS_PER_DECADE = 20.0;

  /// Lower edge of bin `i` [h]: 0, then twenty edges in a decade from 10 h to 1e6 h. The last bin has no upper edge.
  static double edge(std::size_t i) noexcept
  {
    return i == 0 ? 0.0 : FIRST_EDGE * std::pow(10.0, (static_cast<double>(i) - 1.0) / BINS_PER_DECADE);
  }

  /// Continuous ranked probability score of the distribution, uniform within each bin, for the true `hours`. The
  /// probability of the last bin counts at its lower edge [h].
  double crps(double hours) const noexcept;

  std::array<double, BINS> probability{};        ///< probability that the end is in each bin [-]
  std::array<double, SHARES.size()> quantile{};  ///< hours in which the shares SHARES of drives reach the end [h]
  std::array<double, CAUSES.size()> by_cause{};  ///< probability of each cause of the end, in the order of CAUSES [-]
};

/// Whether `assessment` replaces `before`: `assessment` compared its window, unless `assessment` is OK without showing
/// play and `before` is OK and shows play.
inline bool supersedes(const Assessment& assessment, const Assessment& before) noexcept
{
  const bool says_less = assessment.level == HealthLevel::OK && !assessment.shows_play &&
                         before.level == HealthLevel::OK && before.shows_play;
  return assessment.state == AssessmentState::ASSESSED && !says_less;
}

/// Distribution of the remaining life over the unknown variation of one drive.
///
/// A particle is a drive with its own factors of wear, bearing life and fatigue strength. Their distributions are from
/// literature and catalogue (log-normal; Weibull for the bearing's life), truncated by the condition that the drive is
/// still in use. The random numbers are a Sobol sequence. Use ages all particles by the same
/// laws. An assessment weights each particle by the likelihood of this assessment, given the particle's wear as
/// severities of faults:
///
///   no fault found   prod_k (1 - D_k(s_k)); 1 for a window whose load did not change sign, which shows little wear
///   fault found      sum_k p_k D_k(s_k) f(e_k; s_k) / u + r max(1 - sum_k p_k, q)
///
/// k: tooth_wear, interface_wear, spall of a race or ball; s_k: severity of the particle since the reference was
/// learned; p_k, e_k: probability and severity in the assessment; f: log-normal density about s_k with the assessment's
/// deviation; u: prior density of severities; D_k: probability that the assessment finds wear of severity s_k (1 for a
/// named spall); r: share of cases in which the reported set lacks the cause; q: share of false alarms
/// (life/read_wear.hpp). Only the last assessment counts, because the errors of a drive's assessments persist.
///
/// For wear with readings (WearTrends) the factor of wear of a particle has the distribution given the readings
/// (FactorTable). The assessment then informs about spalls only: D_k f / u of wear is 1. The future rate of wear
/// differs from the past rate by a log-normal factor, because the rate is different in each filling of grease
/// (RATE_SCATTER). The current filling continues until its end.
class RemainingLife
{
public:
  explicit RemainingLife(const Parameters& parameters);

  /// Remaining life of a drive that is still in use after the use `so_far`. `assessment`: last assessment that compared
  /// its window, null: none; `at_reference`: use at which the sound reference of the assessment was learned, 0 for a
  /// new drive. The function does not allocate.
  RemainingHours remaining(const Usage& so_far, const FutureLoad& future_load, const Assessment* assessment,
                           const Usage& at_reference, const WearTrends& trends = {}) noexcept;

private:
  static constexpr std::size_t PARTICLES = 4096;
  // share of particles with a spall, the first in the sequence, whatever the probability of a spall is [-]
  static constexpr double SPALLED = 0.25;
  enum Nature
  {
    FLANK,
    INTERFACE,
    BEARING_LIFE,
    SPALL_GROWTH,
    STRENGTH,
    TRANSITION,
    RATE_AHEAD,
    READING_GAIN,
    READING_OFFSET,
    NATURES
  };
  using Point = std::array<double, NATURES>;  // uniform in 0 ... 1

  /// A particle: a drive that is still in use after the use so far.
  struct Drive
  {
    UnitVariation variation;
    std::array<double, STRESS_PLACES> strength;  // logarithms of the strengths over the median
    double log_weight;  // log of the probability that bearing, spalled or not, and flexspline outlast the use so far
    double rate_ahead;  // standard normal deviate of the future rate of wear
    double flank_end;   // equivalent flank wear (LoadFeedback) at the end of life [m]
  };
  struct End
  {
    double hours;
    double weight;
  };

  using Weakest = std::array<double, STRESS_PLACES>;  // logarithms of strengths over the median, by place
  Weakest weakestLeft(const Usage& so_far) const noexcept;
  Drive drive(const Point& point, const Usage& so_far, const Weakest& weakest, bool is_spalled,
              const WearTrends& trends) const noexcept;
  double likelihood(const Assessment& assessment, const Usage& so_far, const Usage& at_reference,
                    const UnitVariation& variation, bool wear_is_read) const noexcept;
  std::array<double, RemainingHours::CAUSES.size()> hoursLeft(const Drive& drive, const Usage& so_far,
                                                              const FutureLoad& future_load) const noexcept;
  void summarize(RemainingHours& result, double sum) noexcept;

  LifeParameters parameters_;
  FaultScaleParameters fault_scale_;
  BearingLife bearing_;
  std::vector<Point> points_;
  double flank_limit_{};           // FutureLoad::flank_limit of the current call [m]
  double interface_limit_{};       // FutureLoad::interface_limit of the current call [m]
  FactorTable flank_factors_;      // working memory
  FactorTable interface_factors_;  // working memory
  std::vector<Drive> drives_;      // working memory
  std::vector<End> ends_;          // working memory
};

/// Wear of the nominal drive by a duty cycle in closed form, with grease that ages and the loads of the new drive.
class NominalUse
{
public:
  NominalUse(const DriveAgeing& ageing, const LifeParameters& life, bool grease_changes)
    : grease_factor_(life.grease_wear_factor)
    , grease_changes_(grease_changes)
    , flank_(FARTHEST * life.flank_wear_limit,
             [&](double depth)
             {
               DriveAge age;
               age.flank_wear = { depth, depth };
               return share(ageing.rates(nominalDrive(life), age).meanFlank(),
                            ageing.rates(nominalDrive(life), {}).meanFlank());
             })
    , interface_(FARTHEST * life.interface_wear_limit,
                 [&](double depth)
                 {
                   DriveAge age;
                   age.interface_wear = depth;
                   return share(ageing.rates(nominalDrive(life), age).interface_wear,
                                ageing.rates(nominalDrive(life), {}).interface_wear);
                 })
  {
    const DriveAge rate = ageing.rates(nominalDrive(life), {});
    hourly_ = { rate.worstFlank(), rate.meanFlank(), rate.interface_wear, rate.bearing_turns, {}, 0.0 };
    for (std::size_t i = 0; i < STRENGTHS; ++i)
    {
      hourly_.fatigue[i] = ageing.fatigueRates(strengthAt(i));
    }
    grease_rate_ = rate.grease;
    const double worse_side = rate.meanFlank() > 0.0 ? rate.worstFlank() / rate.meanFlank() : 1.0;
    flank_limit_ = worse_side * flank_.of(life.flank_wear_limit / worse_side);
    interface_limit_ = interface_.of(life.interface_wear_limit);
  }

  /// Equivalent wear depths (LoadFeedback) as functions of the real depths: of the flanks' mean and of the interface.
  const LoadFeedback& flank() const { return flank_; }
  const LoadFeedback& interface() const { return interface_; }

  /// Use of a drive in the first `hours` hours of its life.
  Usage until(double hours) const
  {
    // Grease of age g (used share of its life) makes wear 1 + (factor - 1) g times as fast. g is linear in time.
    const double age = grease_rate_ * hours;
    const double changes = grease_changes_ ? std::floor(age) : 0.0;
    const double left = age - changes;
    const double extra =
        grease_rate_ > 0.0 ? 0.5 * (grease_factor_ - 1.0) * (changes + left * left) / grease_rate_ : 0.0;
    const double fresh_hours = hours + extra;
    Usage usage{ hourly_.flank_wear * fresh_hours,
                 hourly_.mean_flank * fresh_hours,
                 hourly_.interface_wear * fresh_hours,
                 hourly_.bearing_turns * hours,
                 hourly_.fatigue,
                 age };
    for (auto& by_place : usage.fatigue)
    {
      for (double& damage : by_place)
      {
        damage *= hours;
      }
    }
    return usage;
  }

  /// Use that follows the first `now` hours, for a forecast over `hours` hours in `stretches` intervals.
  FutureLoad from(double now, double hours, int stretches) const
  {
    FutureLoad future_load;
    future_load.step = hours / stretches;
    future_load.flank_limit = flank_limit_;
    future_load.interface_limit = interface_limit_;
    const Usage before = until(now);
    for (int i = 0; i <= stretches; ++i)
    {
      future_load.usage.push_back(until(now + i * future_load.step) - before);
    }
    return future_load;
  }

private:
  static constexpr double FARTHEST = 1.5;  // largest tabulated wear, as a share of its limit

  static constexpr double SLOWEST = 1e-3;  // least rate of wear over that of the new drive, so that no rate is zero

  /// Rate of wear over the rate `of` of the new drive, at least SLOWEST; 1 for a use without wear [-].
  static double share(double rate, double of) { return of > 0.0 ? std::max(rate / of, SLOWEST) : 1.0; }

  Usage hourly_;        // use in an hour with fresh grease
  double grease_rate_;  // share of the grease's life that an hour uses [1/h]
  double grease_factor_;
  bool grease_changes_;
  LoadFeedback flank_;
  LoadFeedback interface_;
  double flank_limit_{};  // equivalent flank wear (LoadFeedback) at the end of life [m]
  double interface_limit_{};
};
}  // namespace hjt
