// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "harmonic_joint_twin/health/signal_indicators.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Class of operating points that are compared with each other: octave of speed, direction (-1 back, 0 both, 1
/// forward), steps of three eighths of the gear's rated torque and of 10 K. What is not measured counts as 0.
struct OperatingBin
{
  int speed{};
  int direction{};
  int load{};
  int temperature{};
  bool operator==(const OperatingBin& other) const noexcept
  {
    return speed == other.speed && direction == other.direction && load == other.load &&
           temperature == other.temperature;
  }
};

/// `load_step`: between two classes of load [N.m].
OperatingBin binOf(const OperatingPoint& point, double load_step) noexcept;

/// That of this gear [N.m].
double loadStep(const Parameters& parameters) noexcept;

/// What healthy indicators follow within a class: temperature, its square and load, as the place in the class.
constexpr std::size_t PLACES = 3;
using Place = std::array<double, PLACES>;

/// -1 ... 1 from one edge of the class to the other; 0 of what is not measured [-].
Place placeIn(const OperatingBin& bin, const OperatingPoint& point, double load_step) noexcept;

/// What else moves healthy indicators together from one window to another.
constexpr std::size_t COMMON_CAUSES = 3;

/// One healthy indicator, over the windows that determined it.
struct Reference
{
  int count{};
  double mean{};      // unit of the indicator
  double variance{};  // about the mean, from fitReference on about what the place makes of it
  bool fitted{};      // has slopes and common causes
  Place slopes{};     // over the place, unit of the indicator
  /// Shares of the spread that go with each common cause, of unit variance [-]
  std::array<double, COMMON_CAUSES> common{};
};

/// Sums over the windows learned, of products of differences from the means.
struct ReferenceSums
{
  std::array<std::array<double, INDICATOR_COUNT>, INDICATOR_COUNT> indicators{};
  std::array<std::array<double, INDICATOR_COUNT>, PLACES> mixed{};  // place and indicator
  std::array<Place, PLACES> places{};
};

struct ReferenceBin
{
  OperatingBin bin;
  int windows{};
  Place mean_place{};
  std::array<Place, PLACES> leverage{};  // inverse of the places' sums, from fitReference
  std::array<Reference, INDICATOR_COUNT> references;
  ReferenceSums sums;
};

/// Makes of the sums what windows are compared with: the straight line over the place by least squares, and of what it
/// leaves the first principal components of the correlations, as many as stand out of noise, COMMON_CAUSES at most:
/// eigenvalue above the edge (1 + sqrt(p / n))^2 of p independent indicators in n windows (Marchenko and Pastur 1967).
/// Of indicators that every window determined; neither from fewer than 16 windows. Does not allocate.
void fitReference(ReferenceBin& bin) noexcept;

/// One indicator against its reference.
struct Deviation
{
  double expected{};
  double spread{};
  /// Normal score of the deviation: standard deviations a normal quantity of known spread would be as unlikely at. NaN:
  /// not compared.
  double score{ std::numeric_limits<double>::quiet_NaN() };
  double threshold_factor{};  ///< deviation over spread, as a multiple of that at the threshold [-]
};

using Deviations = std::array<Deviation, INDICATOR_COUNT>;

/// All indicators of a window against their references.
struct WindowDeviations
{
  Deviations plain;        ///< each by itself
  Deviations conditional;  ///< each given all others: what the common causes explain is none
};

/// What an amplitude changes by, as a nearly normal number. An amplitude of noise alone is Rayleigh's, whose tail is
/// far longer than the normal one; that of its power 2/3 is not (Wilson and Hilferty 1931).
///
/// Law:   c = 3/2 m^(1/3) ((m + x)^(2/3) - m^(2/3)),  to first order x;  x where m is none
/// where  m  sound amplitude;  x  change of it, not below -m;  in the unit of the amplitude
double amplitudeChange(double sound, double change) noexcept;

/// What a window differs from its reference by, and what sound windows differ by: covariance D + F F'.
struct WindowResidual
{
  std::array<double, INDICATOR_COUNT> sound{};       ///< reference with what was subtracted, units of the indicators
  std::array<double, INDICATOR_COUNT> difference{};  ///< from it; of what isFreeAmplitude by amplitudeChange
  std::array<double, INDICATOR_COUNT> own{};         ///< diagonal of D; 0: not compared
  std::array<std::array<double, COMMON_CAUSES>, INDICATOR_COUNT> common{};  ///< rows of F
  double freedom{};                                                         ///< v: of the reference's spreads [-]
};

enum class BaselineState : std::uint8_t
{
  LEARNING,     ///< the window went into the reference of its operating point
  COMPARED,     ///< the window was compared with it
  NO_REFERENCE  ///< no reference for this operating point, and none is learned
};

/// Indicators of a healthy joint by operating point: learned from the first windows there, or given.
///
/// Law:   t = (x - m - b (z - z_0)) / sqrt(max(s^2, u^2) (1 + h) + (f m)^2 + q^2),  h = 1/n + (z - z_0)' L (z - z_0)
///        score = sign(t) sqrt(v log(1 + t^2 / v)) (8 v + 1) / (8 v + 3),  v = n - 1 - PLACES
/// where  m, s, n  mean, standard deviation and number of the healthy windows
///        z, z_0   place of the window in its class, mean of the healthy ones;  b, s  slopes over it and what they
///                 leave, by least squares;  L  inverse of the places' sums of squares, so that h grows beyond what was
///                 learned
///        u        standard error of the fit;  f  indicators.least_spread;  q  a tenth of what one encoder count makes;
///          0.3 for kurtosis, 0.5 for crest
/// Given the others, with what moves all of them together:
///        t_i = (C^-1 d)_i / sqrt((C^-1)_ii),  C = D + F F',  of v - r degrees of freedom;  d  numerators as above
/// where  F    s times Reference::common, r columns;  D  diagonal: variance as above, of what F leaves of s
/// The score turns Student's t into a normal deviate (Wallace 1959), so that few windows give no more alarms than many.
/// Threshold: normal quantile of indicators.false_alarm_rate shared by all indicators in both
/// ways, two-sided (Bonferroni).
class Baseline
{
public:
  static constexpr std::size_t MAX_BINS = 64;

  explicit Baseline(const Parameters& parameters);

  /// Uses the reference of a file; learning stops.
  void setReference(std::vector<ReferenceBin> bins);

  void reset() noexcept;  ///< forgets what was learned, not what was given

  /// `model`: indicators of a model that were subtracted from these; nullptr: none were.
  BaselineState update(const SignalIndicators& indicators, const SignalIndicators* model,
                       WindowDeviations& deviations) noexcept;

  double threshold() const noexcept { return threshold_; }               ///< of |score| [-]
  const WindowResidual& residual() const noexcept { return residual_; }  ///< of the last window
  const std::vector<ReferenceBin>& bins() const noexcept { return bins_; }
  int windowsNeeded() const noexcept { return windows_; }
  double loadStep() const noexcept { return load_step_; }  ///< [N.m]

private:
  ReferenceBin* find(const OperatingBin& bin) noexcept;
  void learn(ReferenceBin& bin, const SignalIndicators& indicators) const noexcept;
  /// Of a window's difference; `left`: of the reference [unit of the indicator squared], `widening`: 1 + h [-].
  double variance(std::size_t indicator, const ReferenceBin& bin, const SignalIndicators& indicators, double left,
                  double widening) const noexcept;
  Deviation deviation(double difference, double expected, double spread, double freedom) const noexcept;
  void compare(const ReferenceBin& bin, const SignalIndicators& indicators, const SignalIndicators* model,
               WindowDeviations& deviations) noexcept;

  const int windows_;
  const double least_spread_;
  const double load_step_;  // [N.m]
  double threshold_;
  std::array<double, INDICATOR_COUNT> floor_{};  // q
  WindowResidual residual_;
  bool given_{};
  std::vector<ReferenceBin> bins_;  // never beyond its first capacity
};
}  // namespace hjt
