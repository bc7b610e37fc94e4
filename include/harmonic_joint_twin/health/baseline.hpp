// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "harmonic_joint_twin/health/signal_indicators.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
struct SignatureSet;

/// Difference of a sound drive's indicator between two motions, minus the difference of the model's indicator.
struct CarriedError
{
  double deviation{ 1e30 };  ///< rms of a drive like the model, in the indicator's unit; 1e30: not known
  double share{};  ///< share of the difference between drive and model; of a line: share of all lines of its signal [-]
  double freedom{ 1.0 };  ///< degrees of freedom from which both were estimated [-]
};

/// Class of operating points whose windows are compared: octave of speed, direction (-1 backward, 0 both, 1 forward),
/// load in steps of three eighths of the gear's rated torque, and temperature in steps of 10 K. A missing measurement
/// counts as 0.
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

/// Class of an operating point. `load_step`: width of a class of load [N.m].
OperatingBin binOf(const OperatingPoint& point, double load_step) noexcept;

/// Whether the point is within the class or at most a quarter of a step outside.
bool isInReach(const OperatingBin& bin, const OperatingPoint& point, double load_step) noexcept;

/// Width of a class of load for this gear [N.m].
double loadStep(const Parameters& parameters) noexcept;

/// Covariates of sound indicators within a class. They are the temperature, its square, the mean magnitude of the load,
/// and the load's mean, its coefficients of sine and cosine of the output angle, and the inertia. The last four
/// describe the payload, which does not change in a job.
constexpr std::size_t PLACES = 7;
constexpr std::size_t OWN_PLACES = 2;  ///< the first covariates, for which each class has its own slopes
using Place = std::array<double, PLACES>;
using PlaceSquares = std::array<Place, PLACES>;  ///< products of two covariates, by pairs

/// Covariates of an operating point in its class, normalised [-]. Temperature and load are -1 ... 1 between the edges
/// of the class, and limited to 1.5 outside. The payload's have the same steps; the inertia counts by its torque at 5
/// rad/s^2. A covariate that was not measured is 0.
Place placeIn(const OperatingBin& bin, const OperatingPoint& point, double load_step) noexcept;

/// Repeatability of a sound drive from one recording to the next.
struct Repeatability
{
  double share{};            ///< share of each indicator, indicators.least_spread [-]
  double friction_share{};   ///< share of the friction, at any speed [-]
  double friction_torque{};  ///< additional part of the friction, at the motor [N.m]
};

/// Number of common causes, each of which changes several sound indicators together.
constexpr std::size_t COMMON_CAUSES = 3;

/// Reference of one indicator: its statistics over the windows that determined it.
struct Reference
{
  int count{};
  double mean{};             // in the indicator's unit; after fitReference at the mean covariates of the class
  double variance{};         // about the mean; after fitReference about the regression on the covariates
  double within{};           // half the mean square of differences of successive windows; 0: not known
  double relative_square{};  // mean square of relativeErrors over the windows; 0: not known [-]
  double scale{};            // mean magnitude with the subtracted model included, in the indicator's unit
  bool fitted{};             // fitReference has set slopes and common causes
  double ridge{};            // lambda: prior information of the slopes, as a number of windows at covariate 1 [-]
  double slopes_freedom{};   // degrees of freedom that the slopes use [-]
  Place slopes{};            // slopes over the covariates, in the indicator's unit
  /// Loadings of the spread on the common causes, each of variance 1 [-].
  std::array<double, COMMON_CAUSES> common{};
};

/// Sums of products of an indicator's and the covariates' differences, over the windows or pairs that have the
/// indicator.
struct IndicatorSums
{
  int count{};
  double square{};  // of the indicator alone
  Place mixed{};
  PlaceSquares places{};
};

/// Sums over the learned windows, about the means.
struct ReferenceSums
{
  std::array<IndicatorSums, INDICATOR_COUNT> by_indicator{};
  std::array<double, INDICATOR_COUNT> means{};
  std::array<Place, INDICATOR_COUNT> mean_places{};
  PlaceSquares places{};  // over all windows
  /// Products of two indicators over all windows, as the rows of a lower triangle.
  std::array<double, INDICATOR_COUNT*(INDICATOR_COUNT + 1) / 2> indicators{};
};

/// Sums over pairs of successive windows, of the differences within a pair.
struct StepSums
{
  std::array<IndicatorSums, INDICATOR_COUNT> by_indicator{};
  std::uint64_t last_window{};  // SignalIndicators::windows of the last learned window
  std::array<double, INDICATOR_COUNT> last{};
  Place last_place{};
};

/// Number of kinds of indicators, scalars and lines. All indicators of a kind have the same tail of their distribution.
constexpr std::size_t TAILS = 2;
constexpr std::size_t tailOf(std::size_t indicator)
{
  return indicator < SCALAR_COUNT ? 0 : 1;
}

struct ReferenceBin
{
  OperatingBin bin;
  int windows{};
  int runs{};  // number of uninterrupted sequences of windows
  Place mean_place{};
  PlaceSquares information{};  // of the slopes from the covariates, without the ridge; set by fitReference
  // inverse degrees of freedom of the windows' distribution, 0: normal; set by fitReference
  std::array<double, TAILS> tail{};
  std::array<Reference, INDICATOR_COUNT> references;
};

/// The first windows themselves, because sums do not contain the tails of their distribution.
struct KeptWindows
{
  static constexpr std::size_t MOST = 64;
  std::size_t count{};
  std::array<Place, MOST> places{};
  std::array<std::array<float, INDICATOR_COUNT>, MOST> values{};
};

/// Sums that fitReference needs in addition to the ReferenceBin of a class.
struct LearnedSums
{
  ReferenceSums windows;
  StepSums steps;
  KeptWindows kept;
};

/// Working memory of fitReference.
struct FitRoom
{
  std::vector<double> correlations = std::vector<double>(INDICATOR_COUNT * INDICATOR_COUNT);
};

/// Deviation of one indicator from its reference.
struct Deviation
{
  double expected{};
  double spread{};
  /// Normal score: number of standard deviations at which a normal quantity is as unlikely. NaN: not compared.
  double score{ std::numeric_limits<double>::quiet_NaN() };
  double threshold_factor{};  ///< deviation over its value at the threshold [-]
  double freedom{};           ///< v': degrees of freedom of deviation over spread [-]
  double stretch{ 1.0 };      ///< spread in the unit of Student's distribution [-]
};

using Deviations = std::array<Deviation, INDICATOR_COUNT>;

/// Transforms the change of an amplitude into a nearly normal quantity. The amplitude of noise has a Rayleigh
/// distribution, whose tail is longer than the normal one. Its power 2/3 is nearly normal (Wilson and Hilferty 1931).
///
/// Law:   c = 3/2 m^(1/3) ((m + x)^(2/3) - m^(2/3)),  to first order x;  c = x if m = 0
/// where  m  sound amplitude;  x  its change, at least -m;  both in the unit of the amplitude
double amplitudeChange(double sound, double change) noexcept;

/// Difference of the last windows of a class from their reference, with the covariance D + F F' of sound windows,
/// where  F  Reference::common times the reference's share of a score's spread
///        D  diagonal matrix of the squared spreads that F does not explain
struct WindowResidual
{
  int windows{};  ///< number of averaged windows [-]
  /// reference with the subtracted model included, in the indicators' units
  std::array<double, INDICATOR_COUNT> sound{};
  /// difference from the reference; of an isFreeAmplitude by amplitudeChange
  std::array<double, INDICATOR_COUNT> difference{};
  std::array<double, INDICATOR_COUNT> own{};                                ///< diagonal of D; 0: not compared
  std::array<std::array<double, COMMON_CAUSES>, INDICATOR_COUNT> common{};  ///< rows of F
  double freedom{};               ///< v: degrees of freedom of the reference's spreads [-]
  double pattern_freedom{};       ///< v' of a pattern of scalars [-]
  double pattern_stretch{ 1.0 };  ///< spread of a pattern in the unit of Student's distribution [-]
};

enum class BaselineState : std::uint8_t
{
  LEARNING,      ///< the window was added to the reference of its operating point
  COMPARED,      ///< the window was compared with the reference
  NO_REFERENCE,  ///< the given reference lacks this operating point
  OTHER_PAYLOAD  ///< the reference does not cover what the joint carries in this window
};

/// Indicators of a sound joint by operating point, learned from the first windows there or given. The class compares
/// the trimmed mean of the last indicators.evidence_windows windows of an operating point. The trimmed mean omits a
/// fifth of the windows at either end, at least one of three or more.
///
/// Law:   S^2 = p (r + 1/(e n)) + max(p (1 - r), w^2) / k + R^2 + q^2 + (p + R^2) (z - z_0)' L (z - z_0) / e
///        t = g mean(x - m - b (z - z_0)) / S,   g^2 = 1 / (1 - 2 y^2 a / k)
///        p = (v s^2 + v_0 s_0^2) / (v + v_0) max(c^2 / c_0^2, 1)
///        score = sign(t) sqrt(v' log(1 + t^2 / v')) (8 v' + 1) / (8 v' + 3)
///        1 / v' = y^2 ((1 + 3 a / (1 - 4 a)) / (v + v_0) + a / k),   v = e n - 1 - d, at least 1
/// where  m, s, n  mean, standard deviation and number of the sound windows
///        z, z_0   covariates of the window (placeIn), their mean over the sound ones
///        b        slopes over the covariates by ridge regression (fitReference);  s is then the deviation from them
///        L, d     covariance of the slopes where s = 1, degrees of freedom that they use
///        y        share of S^2 that was learned, as p and w^2 (Satterthwaite 1946)
///        a        inverse degrees of freedom of one window's distribution, from the sound ones; 0: normal
///        R        repeatability of the drive from one recording to the next (Repeatability)
///        k        averaged windows, minus those omitted at one end
///        w^2      half the mean square of successive differences without the two largest, from four windows on
///        r        share of s^2 common to successive windows: 1 minus half their mean square difference over s^2 (von
///                 Neumann 1941). It is shrunk towards the mean of scalars or lines, and its uncertainty is added. 1
///                 without successive windows
///        e        share of the windows that count as independent, (1 - r') / (1 + r'), at least one in each sequence;
///                 r' is r minus its error. 1 without successive windows
///        s_0, v_0 spread by similar lines (varianceOfAlike) and ALIKE_FREEDOM; of scalars and if carried v_0 = 0
///        c, c_0   rms factor of the motion on the fit's standard error (relativeErrors), of the averaged and of the
///                 sound windows: the spread of a line is in proportion to c
///        q        a tenth of the effect of one encoder count; 0.3 for kurtosis, 0.5 for crest
/// A carried reference is one of another motion, for windows from which a model is subtracted. They are compared with
/// the class of both directions at their temperature that has most windows. Then b is over temperature alone and
/// WindowResidual::common is 0. The variance grows by the squares of CarriedError::deviation and of CarriedError::share
/// of |m| (of a line: of all amplitudes of its signal together), both times 10/windows below ten windows. v is at most
/// CarriedError::freedom. The score transforms Student's t into a normal deviate (Wallace 1959), so that few windows
/// give no more alarms than many. The thresholds are normal quantiles of indicators.false_alarm_rate. All indicators
/// share one half of the rate, two-sided, and the patterns of all causes share the other half, one-sided (Bonferroni).
/// Without patterns the indicators share all. If a class has too few windows for a reference, a window at its edge
/// counts for the class beyond that edge. A window whose payload or load increases S^2 by more than
/// OTHER_PAYLOAD_WIDENING is not compared.
///
/// Learning opens at most indicators.baseline_classes classes. The constructor allocates their memory of 0.2 MB each. A
/// given reference needs 19 kB for a class and replaces that memory.
class Baseline
{
public:
  static constexpr std::size_t MAX_EVIDENCE = 100;  // number of windows
  /// Least number of windows for a spread; least value of indicators.baseline_windows.
  static constexpr int MIN_WINDOWS = 8;

  /// `signatures` gives the CarriedErrors.
  Baseline(const Parameters& parameters, std::shared_ptr<const SignatureSet> signatures);

  /// Uses the reference of a file and ends learning. `carried`: the windows are of another motion.
  void setReference(std::vector<ReferenceBin> bins, bool carried = false);

  void reset() noexcept;  ///< discards what was learned, but keeps a given reference

  /// Learns or compares a window. `model`: indicators of a model that were subtracted from it; nullptr: none were.
  BaselineState update(const SignalIndicators& indicators, const SignalIndicators* model,
                       Deviations& deviations) noexcept;

  double threshold() const noexcept { return threshold_; }  ///< threshold of |score| [-]
  Deviation pattern(double student) const noexcept;         ///< scores a value of Student's t along a pattern
  double patternThreshold() const noexcept { return pattern_threshold_; }  ///< threshold of the score of a pattern [-]
  const WindowResidual& residual() const noexcept { return residual_; }    ///< for the class of the last window
  const OperatingBin& bin() const noexcept { return bin_; }                ///< class of the last window
  const std::vector<ReferenceBin>& bins() const noexcept { return bins_; }
  const std::vector<LearnedSums>& sums() const noexcept { return sums_; }  ///< by class; empty for a given reference
  /// windows of this class, in the reference or compared since the reset
  int windowsHere() const noexcept { return windows_here_; }
  /// Number of windows that a reference needs.
  int windowsNeeded() const noexcept { return given_ ? MIN_WINDOWS : windows_; }
  bool given() const noexcept { return given_; }  ///< setReference has given the reference, so that it has no sums
  double loadStep() const noexcept { return load_step_; }  ///< width of a class of load [N.m]
  const Repeatability& repeatability() const noexcept { return repeatability_; }
  /// Score of a change of one indicator alone, with the spread of the last window; 0: not compared.
  double scoreOf(std::size_t indicator, double change, const Deviations& deviations) const noexcept;

private:
  /// Difference of one window from its reference.
  struct Compared
  {
    std::array<double, INDICATOR_COUNT> difference{};  // NaN: not compared
    std::array<double, INDICATOR_COUNT> relative{};    // by relativeErrors
    Place along{};  // squares of z - z_0 along the principal axes of the slopes' information
  };

  /// Positions of the last windows of a class; the oldest is overwritten.
  struct Recent
  {
    std::size_t count{};
    std::size_t next{};
  };

  /// Mean difference of several windows.
  struct Average
  {
    double difference{};
    double relative_square{};  // c^2
    double scatter_square{};   // w^2
    double weight{};           // k
  };

  /// Factors of the reference's variance: the part common to all windows, and the mean of the rest.
  struct Widening
  {
    double stays{};
    double varies{};
    double slopes{};   // factor for the uncertainty of the slopes
    double carried{};  // added for a carried reference, in the indicator's unit squared
  };

  /// Variance of a difference, in the indicator's unit squared.
  struct Variance
  {
    double all{};
    double learned{};  // part that was learned from the reference's windows and from the scatter of the last ones
  };

  ReferenceBin* find(const OperatingPoint& point) noexcept;
  ReferenceBin* findCarried(const OperatingBin& bin) noexcept;
  void makeRoom(std::size_t bins);
  /// Covariates of the window minus their mean in the reference.
  Place placeFrom(const ReferenceBin& bin, const OperatingPoint& point) const noexcept;
  bool isOtherPayload(const ReferenceBin& bin, const Place& place) const noexcept;
  void take(const ReferenceBin& bin, const Place& place, const SignalIndicators& indicators,
            const SignalIndicators* model, Compared& window) noexcept;
  Average average(std::size_t first, std::size_t count, std::size_t indicator) const noexcept;
  /// `left`: variance of the reference after the regression, in the indicator's unit squared.
  Variance variance(std::size_t indicator, const ReferenceBin& bin, const Average& average, double left,
                    const Widening& widening) const noexcept;
  double scoreOf(double difference, const Deviation& scale) const noexcept;
  void compare(const ReferenceBin& bin, std::size_t first, std::size_t count, Deviations& deviations) noexcept;

  std::shared_ptr<const SignatureSet> signatures_;
  const int windows_;
  const std::size_t evidence_windows_;
  const Repeatability repeatability_;
  const double load_step_;  // [N.m]
  double threshold_{};
  double pattern_threshold_{};
  std::array<double, INDICATOR_COUNT> floor_{};  // least spreads q
  Place axes_sizes_{};  // information along its principal axes for the class of the last window
  WindowResidual residual_;
  std::array<double, INDICATOR_COUNT> expected_{};  // for the last window, without the model's indicators
  OperatingBin bin_;
  int windows_here_{};
  bool given_{};
  bool carried_{};
  std::vector<ReferenceBin> bins_;  // capacity is fixed
  std::vector<LearnedSums> sums_;   // capacity is fixed
  FitRoom fit_room_;
  std::vector<Recent> recent_;      // by class
  std::vector<Compared> compared_;  // evidence_windows_ for each class
};
}  // namespace hjt
