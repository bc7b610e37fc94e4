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
constexpr double FARTHEST = 30.0;  // standard deviations: the normal distribution ends where doubles do

inline double squared(double value)
{
  return value * value;
}

inline double normalShare(double deviation) noexcept
{
  return 0.5 * std::erfc(-deviation / std::sqrt(2.0));
}

/// The deviation below `most` of which a share `share` of the normal distribution's part below `most` lies.
inline double normalBelow(double most, double share) noexcept
{
  const double part = share * normalShare(std::clamp(most, -FARTHEST, FARTHEST));
  return -std::sqrt(2.0) * boost::math::erfc_inv(2.0 * std::clamp(part, 1e-300, 1.0 - 1e-16));
}

/// Factor, log-normal about 1, of a drive that `ends_at` or more would have ended.
inline double factorBelow(double ends_at, double spread, double share) noexcept
{
  return spread > 0.0 ? std::exp(spread * normalBelow(std::log(ends_at) / spread, share)) : 1.0;
}

/// Standard normal deviate of a share of all.
inline double normalAt(double share) noexcept
{
  return normalBelow(FARTHEST, share);
}

/// Factors of wear, as a table of their distribution.
class FactorTable
{
public:
  /// Given the readings, of a drive that `ends_at` or more would have ended. `spread`: of the logarithm beforehand.
  void given(const WearTrend& trend, double spread, double ends_at) noexcept
  {
    constexpr double REACH = 6.5;  // standard deviations
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

  double drawn(double share) const noexcept
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

  std::vector<double> reached_ = std::vector<double>(NODES);  // share of the distribution up to each node
  double first_{};                                            // logarithm of the first node's factor
  double step_{};
  double spread_{};
  double ends_at_{};
  bool is_read_{};
};

/// Fatigue strengths at which the fatigue by a use is known, evenly spaced in their logarithm; straight in the
/// logarithms between them.
constexpr std::size_t STRENGTHS = 49;
constexpr double STRENGTH_REACH = 1.5;  // reach in the logarithm, below and above the median

/// Of entry i, over the median's.
inline double strengthAt(std::size_t i)
{
  return std::exp(STRENGTH_REACH * (2.0 * static_cast<double>(i) / static_cast<double>(STRENGTHS - 1) - 1.0));
}

/// How much a drive has been used: what the nominal drive would have aged by it.
struct Usage
{
  double flank_wear{};      ///< of the nominal drive, worse side [m]
  double mean_flank{};      ///< the same, mean of both sides: half the play's growth [m]
  double interface_wear{};  ///< of the nominal drive [m]
  double bearing_turns{};   ///< [turns at rated torque]
  /// Miner's sums by strength and place: fatigue does not grow in proportion to the nominal drive's.
  std::array<std::array<double, STRESS_PLACES>, STRENGTHS> fatigue{};
  double fillings{};  ///< of grease that were used up [-]

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

/// The use ahead, from now on: entry i after i times `step` hours. The last stretch goes on for ever.
struct FutureLoad
{
  double step{};             ///< [h]
  std::vector<Usage> usage;  ///< from now on, ascending, the first 0; two or more
  /// Depths at which flanks and interface are at their end, as the loads of the new drive would wear them [m]; 0:
  /// those of the parameters.
  double flank_limit{};
  double interface_limit{};
};

/// Hours of use that are left, as a distribution.
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

  /// Lower end of bin `i`: 0, then from 10 h to 1e6 h twenty to the decade. The last one has no end [h].
  static double edge(std::size_t i) noexcept
  {
    return i == 0 ? 0.0 : FIRST_EDGE * std::pow(10.0, (static_cast<double>(i) - 1.0) / BINS_PER_DECADE);
  }

  /// Continuous ranked probability score of the bins' distribution, even within each, against `hours` that came; what
  /// lies in the last bin counts as its beginning [h].
  double crps(double hours) const noexcept;

  std::array<double, BINS> probability{};        ///< that the end comes within each bin [-]
  std::array<double, SHARES.size()> quantile{};  ///< by which these shares have ended [h]
  std::array<double, CAUSES.size()> by_cause{};  ///< that it ends so, in the order of CAUSES [-]
};

/// Whether an assessment replaces the one `before`. It does if its window was compared. A window without a departure
/// that does not show play does not replace one that does.
inline bool supersedes(const Assessment& assessment, const Assessment& before) noexcept
{
  const bool says_less = assessment.level == HealthLevel::OK && !assessment.shows_play &&
                         before.level == HealthLevel::OK && before.shows_play;
  return assessment.state == AssessmentState::ASSESSED && !says_less;
}

/// The remaining life as a distribution over what cannot be seen of one drive, its variation.
///
/// A particle is a drive with factors of wear, a life of its bearing and a fatigue strength of its own, drawn from what
/// the literature and the catalogue leave open (log-normal; the Weibull distribution of the bearing's life), given
/// that its use so far has not ended it: each is drawn from its distribution beyond that limit. The points are Sobol's.
/// Use ages every particle by the same laws. An assessment weighs it by how likely its wear, as severities of faults,
/// makes what it reports:
///
///   no fault found   prod_k (1 - D_k(s_k)); 1 of a window whose load did not go both ways, which shows little wear
///   fault found      sum_k p_k D_k(s_k) f(e_k; s_k) / u + r max(1 - sum_k p_k, q)
///
/// k: tooth_wear, interface_wear, a spall at a race or ball; s_k the particle's severity since the reference was
/// learned; p_k, e_k the assessment's probability and severity, f log-normal about s_k with the assessment's deviation,
/// u the density of severities beforehand; D_k the chance that such wear is found (1 of a spall that is named); r: how
/// often the cause is in no set; q: false alarms (life/assessment_errors). The errors of the assessments of one drive
/// are mostly those of its signatures and stay, so that the last counts alone.
///
/// Of wear that was read over the use (WearTrends) a particle's factor is drawn from its distribution given the
/// readings, and the assessment tells of spalls alone: D_k f / u of wear is 1. How fast it wears from now on differs
/// from how fast it has by a factor that is log-normal: each filling of grease has a rate of its own (RATE_SCATTER),
/// and the present one goes on to its end.
class RemainingLife
{
public:
  explicit RemainingLife(const Parameters& parameters);

  /// Of a drive that is in use still after `so_far`, with this use ahead; `assessment`: the last one that
  /// counts, null: none; `at_reference`: the use when the sound reference of that window was learned, 0: new.
  /// Allocates nothing.
  RemainingHours remaining(const Usage& so_far, const FutureLoad& future_load, const Assessment* assessment,
                           const Usage& at_reference, const WearTrends& trends = {}) noexcept;

private:
  static constexpr std::size_t PARTICLES = 4096;
  static constexpr double SPALLED = 0.25;  // share of drives with a spall, which come first, however rare spalls are
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
  using Point = std::array<double, NATURES>;  // evenly within 0 ... 1

  /// One that `so_far` has not ended.
  struct Drive
  {
    UnitVariation variation;
    std::array<double, STRESS_PLACES> strength;  // logarithms, over the median's
    double log_weight;  // logarithm of the chance of such a bearing and flexspline, to last and to have a spall or none
    double rate_ahead;  // standard normal, of its rate of wear from now on
    double flank_end;   // depth of the flanks at its end, as the loads of the new drive would wear them [m]
  };
  struct End
  {
    double hours;
    double weight;
  };

  using Weakest = std::array<double, STRESS_PLACES>;  // logarithms of strengths by place
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
  double flank_limit_{};           // of the present call, as in FutureLoad [m]
  double interface_limit_{};       // likewise
  FactorTable flank_factors_;      // scratch
  FactorTable interface_factors_;  // scratch
  std::vector<Drive> drives_;      // scratch
  std::vector<End> ends_;          // scratch
};

/// Wear of the nominal drive by a duty cycle, in closed form: loads per revolution of the new drive, grease that
/// ages.
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

  /// Depths as the loads of the new drive would have worn them, of the mean of both flanks and of the interface.
  const LoadFeedback& flank() const { return flank_; }
  const LoadFeedback& interface() const { return interface_; }

  /// From new
  Usage until(double hours) const
  {
    // Mean of the wear factor: grease of age g wears 1 + (factor - 1) g times as fast, g linear in time.
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

  /// `hours`: how far it looks; the use goes on as in its last stretch.
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
  static constexpr double FARTHEST = 1.5;  // share of the limits

  static constexpr double SLOWEST = 1e-3;  // share of the new drive's rate: a depth that wears no longer stays defined

  /// Of two rates; 1 of a use that does not wear.
  static double share(double rate, double of) { return of > 0.0 ? std::max(rate / of, SLOWEST) : 1.0; }

  Usage hourly_;        // in fresh grease
  double grease_rate_;  // share of the grease's life by hour
  double grease_factor_;
  bool grease_changes_;
  LoadFeedback flank_;
  LoadFeedback interface_;
  double flank_limit_{};  // as the loads of the new drive would wear them [m]
  double interface_limit_{};
};
}  // namespace hjt
