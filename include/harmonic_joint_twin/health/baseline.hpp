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

/// How an indicator of a sound drive, minus the indicator of the twin, differs between two motions.
struct CarriedError
{
  double deviation{ 1e30 };  ///< rms difference for a drive like the twin, in the indicator's unit; 1e30: not known
  double share{};  ///< further rms difference over |drive - twin|; for a line |drive - twin| of its signal's lines [-]
  double freedom{ 1.0 };  ///< degrees of freedom of the estimates `deviation` and `share` [-]
};

/// Class of operating points whose windows are compared with each other. A class is an octave of speed, a direction (-1
/// backward, 0 both, 1 forward), a step of load (three eighths of the gear's rated torque) and a step of temperature
/// (10 K). A load or temperature that is not measured counts as 0.
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

/// The class of an operating point. `load_step`: width of a class of load [N.m].
OperatingBin binOf(const OperatingPoint& point, double load_step) noexcept;

/// Width of a class of load for this gear [N.m].
double loadStep(const Parameters& parameters) noexcept;

/// Number of covariates that correct the indicators within a class: temperature, its square, mean magnitude of the load
/// and four numbers of the payload, which do not depend on the path. These numbers are the inertia and three parts of
/// the load: the constant part, and the factors of the sine and the cosine of the output angle.
constexpr std::size_t PLACES = 7;
/// Number of covariates, temperature and its square, that have a separate slope in each class. Classes that differ only
/// in temperature share the slopes of the other covariates.
constexpr std::size_t OWN_PLACES = 2;
using Place = std::array<double, PLACES>;
using PlaceSquares = std::array<Place, PLACES>;  ///< products of every two covariates, as a square matrix

/// Standard deviations of a sound drive's indicators from one recording to the next.
struct Repeatability
{
  double share{};            ///< standard deviation of an indicator over its magnitude, indicators.least_spread [-]
  double friction_share{};   ///< part of the friction's deviation that grows with the friction, over the friction [-]
  double friction_torque{};  ///< constant part of the friction's deviation, as a torque at the motor [N.m]
};

/// Largest number of common causes, which change several indicators of a sound drive together from window to window.
constexpr std::size_t COMMON_CAUSES = 3;

/// Reference of one indicator: statistics over the healthy windows that determined the indicator.
struct Reference
{
  int count{};
  double mean{};             // mean of the indicator; after fitReference its value at the class's mean covariates
  double variance{};         // variance about the mean; after fitReference about the regression on the covariates
  double within{};           // half the mean square of the differences between successive windows; 0: not known
  double relative_square{};  // mean square of the indicator's relativeErrors over the windows; 0: not known [-]
  double scale{};            // mean magnitude of the indicator, to which a subtracted model's value is added again
  bool fitted{};             // whether fitReference set slopes and common causes
  double ridge{};  // lambda of fitReference: prior information on the slopes, as windows at a covariate of 1 [-]
  double slopes_freedom{};  // degrees of freedom that the slopes use [-]
  Place slopes{};           // slopes over the covariates, in the indicator's unit
  /// Loadings of the indicator, divided by its spread, on the common causes, each of variance 1 [-].
  std::array<double, COMMON_CAUSES> common{};
};

/// Sums of products of two differences, of an indicator or of its covariates (Place), from a mean or between successive
/// windows. The sums are over all windows, or pairs of windows, that determined the indicator.
struct IndicatorSums
{
  int count{};
  double square{};  // sum of the squares of the indicator's differences
  Place mixed{};    // sums of the indicator's difference times a covariate's difference
  PlaceSquares places{};
};

/// Sums of products of the windows' differences from their means, over the learned windows.
struct ReferenceSums
{
  std::array<IndicatorSums, INDICATOR_COUNT> by_indicator{};
  std::array<double, INDICATOR_COUNT> means{};
  std::array<Place, INDICATOR_COUNT> mean_places{};
  PlaceSquares places{};  // sums of products of the covariates' differences, over all windows
  /// Sums of products of every two indicators' differences over all windows, as the rows of a lower triangle.
  std::array<double, INDICATOR_COUNT*(INDICATOR_COUNT + 1) / 2> indicators{};
};

/// Sums of products of differences between successive windows, over the learned windows.
struct StepSums
{
  std::array<IndicatorSums, INDICATOR_COUNT> by_indicator{};
  std::uint64_t last_window{};  // SignalIndicators::windows of the last learned window
  std::array<double, INDICATOR_COUNT> last{};
  Place last_place{};
};

/// Number of kinds of indicators, scalars and lines, whose windows have separate tails (ReferenceBin::tail).
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
  PlaceSquares information{};  // information on the slopes, without the ridge; set by fitReference
  // inverse degrees of freedom of single windows' Student distribution, by kind; 0: normal; set by fitReference
  std::array<double, TAILS> tail{};
  std::array<Reference, INDICATOR_COUNT> references;
};

/// The first windows of a class. fitReference estimates the tail of their distribution, for which sums do not suffice.
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
  /// Normal deviate that a standard normal variable exceeds with the probability of the deviation. NaN: not compared.
  double score{ std::numeric_limits<double>::quiet_NaN() };
  double threshold_factor{};  ///< magnitude of the deviation over the deviation at the threshold of the score [-]
  double freedom{};           ///< degrees of freedom of deviation / spread, v' of Baseline [-]
  double stretch{ 1.0 };      ///< factor that makes deviation / spread a Student's t, g of Baseline [-]

  /// Score of any difference from the reference, in the indicator's unit; 0: not compared.
  double scoreOf(double difference) const noexcept;
};

using Deviations = std::array<Deviation, INDICATOR_COUNT>;

/// Change of an amplitude, transformed to a nearly normal number. The amplitude of noise alone has Rayleigh's
/// distribution, whose tail is far longer than the normal one. The power 2/3 of the amplitude is nearly normal (Wilson
/// and Hilferty 1931).
///
/// Law:   c = 3/2 m^(1/3) ((m + x)^(2/3) - m^(2/3)),  c ~ x for small x;  c = x if m = 0
/// where  m, x  sound amplitude, its change (at least -m), in the unit of the amplitude;  c  result, in the same unit
double amplitudeChange(double sound, double change) noexcept;

/// Mean difference of a class's last windows from the reference, and its covariance D + F F' if the drive is sound.
/// The columns of F are the effects of the common causes; the diagonal matrix D holds the remaining variances.
struct WindowResidual
{
  int windows{};  ///< number of averaged windows [-]
  /// expected values of the sound drive, with the twin's indicators if these were subtracted, in the indicators' units
  std::array<double, INDICATOR_COUNT> sound{};
  /// differences from the reference; if isFreeAmplitude, transformed by amplitudeChange
  std::array<double, INDICATOR_COUNT> difference{};
  std::array<double, INDICATOR_COUNT> own{};                                ///< variances D; 0: not compared
  std::array<std::array<double, COMMON_CAUSES>, INDICATOR_COUNT> common{};  ///< rows of F
  double freedom{};               ///< degrees of freedom of the reference's spreads, v of Baseline [-]
  double pattern_freedom{};       ///< degrees of freedom of a pattern of scalars, v' of Baseline [-]
  double pattern_stretch{ 1.0 };  ///< factor that makes a pattern's score a Student's t, g of Baseline [-]
};

enum class AssessmentState : std::uint8_t
{
  WAITING = 0,          ///< no window has been completed
  LEARNING = 1,         ///< the last window was added to the reference of its operating point
  ASSESSED = 2,         ///< the last window was compared with the reference, and the level is a verdict
  NO_REFERENCE = 3,     ///< the reference has no windows, or too few, at the operating point of the last window
  TOO_FEW_WINDOWS = 4,  ///< no deviation was found, but a verdict needs more windows at this operating point
  OTHER_PAYLOAD = 5     ///< last window not compared: the reference has no windows with a similar payload or load
};

/// Indicators of a sound joint by operating point, given or learned from the first windows at each operating point. The
/// class compares the trimmed mean of the last indicators.evidence_windows windows with the reference of the operating
/// point. The mean omits the largest and the least fifth of the values, at least one each of three or more values.
///
/// Law:   S^2 = p (r + 1/(e n)) + max(p (1 - r), w^2) / k + R^2 + q^2 + (p + R^2) (z - z_0)' L (z - z_0) / e
///        t = g mean(x - m - b (z - z_0)) / S,   g^2 = 1 / (1 - 2 y^2 a / k)
///        p = (v s^2 + v_0 s_0^2) / (v + v_0) max(c^2 / c_0^2, 1)
///        score = sign(t) sqrt(v' log(1 + t^2 / v')) (8 v' + 1) / (8 v' + 3)
///        1 / v' = y^2 ((1 + 3 a / (1 - 4 a)) / (v + v_0) + a / k),   v = e n - 1 - d, at least 1
/// where  x        value of the indicator in a window; S is the spread of the mean difference, p the expected variance
///        m, s, n  mean, standard deviation and number of the sound windows
///        z, z_0   covariates of a window (placeIn), their mean over the sound windows
///        b        slopes over the covariates (fitReference); s is the standard deviation about the regression
///        L, d     covariance of the slopes for s = 1, degrees of freedom that the slopes use
///        y        share of S^2 that was estimated from windows, that is, from p and w^2 (Satterthwaite 1946)
///        a        inverse degrees of freedom of a single sound window's distribution; 0: normal
///        R        repeatability of the drive from one recording to the next (Repeatability)
///        k        number of averaged windows, minus those omitted at one end
///        w^2      half the mean square of the differences of successive averaged windows, without the two largest;
///                 0 for three windows or fewer
///        r        share of s^2 that persists from window to window: 1 - half the mean square of the differences of
///                 successive windows / s^2 (von Neumann 1941). r is shrunk to the mean r of all scalars or all lines
///                 (empirical Bayes), plus the standard error of r. r = 1 if no windows are successive
///        e        share of the windows that count as independent, (1 - r') / (1 + r'), at least one window of each
///                 uninterrupted sequence. r' is r with the error subtracted. e = 1 if no windows are successive
///        s_0, v_0 spread of similar lines (varianceOfAlike), ALIKE_FREEDOM; v_0 = 0 for scalars or if carried
///        c, c_0   rms of relativeErrors over the averaged windows and over the sound windows: the spread of a line
///                 grows with the standard error of its fit
///        q        resolution: a tenth of the effect of one encoder count; 0.3 for kurtosis, 0.5 for crest
/// A carried reference comes from another motion, and the twin is subtracted from its windows and from the windows to
/// compare. A window of motion to and fro is compared with the class of such motion at the window's temperature that
/// has the most windows. The slopes b are over temperature alone, F = 0, v is at most CarriedError::freedom, and S^2
/// contains carriedVariance.
/// The score converts Student's t to a normal deviate (Wallace 1959). Few windows therefore cause no more false alarms
/// than many windows. The thresholds are normal quantiles. All indicators share half of indicators.false_alarm_rate
/// (two-sided), and the patterns of all causes share the other half (one-sided, Bonferroni). Without patterns the
/// indicators share the whole rate. A window near the edge of its class counts for the class beyond the edge if its own
/// class has too few windows. If payload or load add more than OTHER_PAYLOAD_WIDENING (p + R^2) to S^2, Baseline does
/// not compare the window.
///
/// Learning opens at most indicators.baseline_classes classes. The constructor allocates 0.2 MB for each class. A
/// reference from setReference replaces this memory by 19 kB for each of its classes.
class Baseline
{
public:
  static constexpr std::size_t MAX_EVIDENCE = 100;  // largest number of windows in a mean
  /// Least number of windows from which a spread is estimated, also the least value of indicators.baseline_windows.
  static constexpr int MIN_WINDOWS = 8;

  /// `signatures`: set with the errors of carried references and the causes that have patterns.
  Baseline(const Parameters& parameters, std::shared_ptr<const SignatureSet> signatures);

  /// Sets the reference, for example from a file, and ends learning. `carried`: whether it is from another motion.
  void setReference(std::vector<ReferenceBin> bins, bool carried = false);

  void reset() noexcept;  ///< forgets all windows and a learned reference; a reference from setReference stays

  /// Learns or compares a window. Returns LEARNING, ASSESSED, NO_REFERENCE or OTHER_PAYLOAD. `model`: indicators of the
  /// twin that were subtracted from the window; nullptr: none.
  AssessmentState update(const SignalIndicators& indicators, const SignalIndicators* model,
                         Deviations& deviations) noexcept;

  double threshold() const noexcept { return threshold_; }  ///< threshold of an indicator's |score| [-]
  Deviation pattern(double student) const noexcept;         ///< deviation of a pattern with Student's t `student`
  double patternThreshold() const noexcept { return pattern_threshold_; }  ///< threshold of the score of a pattern [-]
  const WindowResidual& residual() const noexcept { return residual_; }    ///< residual in the last window's class
  const OperatingBin& bin() const noexcept { return bin_; }                ///< class of the last window
  const std::vector<ReferenceBin>& bins() const noexcept { return bins_; }
  const std::vector<LearnedSums>& sums() const noexcept
  {
    return sums_;
  }                                                           ///< sums of each class; empty after setReference
  int windowsHere() const noexcept { return windows_here_; }  ///< windows learned in the class, or compared since reset
  /// Number of windows that the reference of an operating point needs.
  int windowsNeeded() const noexcept { return given_ ? MIN_WINDOWS : windows_; }
  bool given() const noexcept { return given_; }  ///< whether setReference set the reference, which has no sums then
  double loadStep() const noexcept { return load_step_; }  ///< width of a class of load [N.m]
  const Repeatability& repeatability() const noexcept { return repeatability_; }

private:
  /// Differences of one window's indicators from their references.
  struct Compared
  {
    std::array<double, INDICATOR_COUNT> difference{};  // NaN: not compared
    std::array<double, INDICATOR_COUNT> relative{};    // by relativeErrors
    Place along{};  // squares of z - z_0 (Baseline) along the principal axes of the slopes' information
  };

  /// Ring buffer of a class's last windows: number of windows and place of the next window.
  struct Recent
  {
    std::size_t count{};
    std::size_t next{};
  };

  /// Mean difference of an indicator over the last windows.
  struct Average
  {
    double difference{};
    double relative_square{};  // c^2 of Baseline
    double scatter_square{};   // w^2 of Baseline
    double weight{};           // k of Baseline
  };

  /// Terms of Baseline's S^2: factors on the variance p of the reference, and a term for a carried reference.
  struct Widening
  {
    double stays{};    // r + 1 / (e n) [-]
    double varies{};   // (1 - r) / k [-]
    double slopes{};   // (z - z_0)' L (z - z_0) / e, for the uncertainty of the slopes [-]
    double carried{};  // carriedVariance, in the indicator's unit squared
  };

  /// Variance S^2 of a mean difference, in the indicator's unit squared.
  struct Variance
  {
    double all{};
    double learned{};  // part of S^2 that was estimated from the windows, from p and w^2
  };

  ReferenceBin* find(const OperatingPoint& point) noexcept;
  ReferenceBin* findCarried(const OperatingBin& bin) noexcept;
  void makeRoom(std::size_t bins);
  /// Covariates of an operating point minus their mean in the reference.
  Place placeFrom(const ReferenceBin& bin, const OperatingPoint& point) const noexcept;
  bool isOtherPayload(const ReferenceBin& bin, const Place& place) const noexcept;
  void take(const ReferenceBin& bin, const Place& place, const SignalIndicators& indicators,
            const SignalIndicators* model, Compared& window) noexcept;
  Average average(std::size_t first, std::size_t count, std::size_t indicator) const noexcept;
  /// Variance of a mean difference. `left`: reference's variance about the regression, in the indicator's unit squared.
  Variance variance(std::size_t indicator, const ReferenceBin& bin, const Average& average, double left,
                    const Widening& widening) const noexcept;
  void compare(const ReferenceBin& bin, std::size_t first, std::size_t count, Deviations& deviations) noexcept;

  std::shared_ptr<const SignatureSet> signatures_;
  const int windows_;
  const std::size_t evidence_windows_;
  const Repeatability repeatability_;
  const double load_step_;  // [N.m]
  double threshold_{};
  double pattern_threshold_{};
  std::array<double, INDICATOR_COUNT> floor_{};  // least spreads q of Baseline
  Place axes_sizes_{};  // eigenvalues of the slopes' information, for the class of the last window
  WindowResidual residual_;
  std::array<double, INDICATOR_COUNT> expected_{};  // expected values of the last window, without a subtracted model's
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
