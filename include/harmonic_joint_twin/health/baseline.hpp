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

/// Difference of an indicator of a sound drive, less the model's, from one motion to another.
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

/// `load_step`: step between two classes of load [N.m].
OperatingBin binOf(const OperatingPoint& point, double load_step) noexcept;

/// The gear's step between two classes of load [N.m].
double loadStep(const Parameters& parameters) noexcept;

/// Covariates of healthy indicators within a class: temperature, its square, the load's mean magnitude, and numbers of
/// the payload, which are constant during a job and equal on any path. Those are the load's constant part, its parts
/// over sine and cosine of the output angle, and the inertia.
constexpr std::size_t PLACES = 7;
/// The first two covariates (temperature and its square) have slopes of their own in each class. The classes share the
/// slopes of the other covariates.
constexpr std::size_t OWN_PLACES = 2;
using Place = std::array<double, PLACES>;
using PlaceSquares = std::array<Place, PLACES>;  ///< products of two covariates, by pairs

/// Deviations of a sound drive from one recording to the next, beside those in its reference.
struct Repeatability
{
  double share{};            ///< share of each indicator, indicators.least_spread [-]
  double friction_share{};   ///< share of the friction, at any speed [-]
  double friction_torque{};  ///< additional part of the friction, at the motor [N.m]
};

/// Largest number of common causes, which change several healthy indicators together from window to window.
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

/// Sums of products of the differences of an indicator and of the place, over the windows or pairs of windows that have
/// the indicator.
struct IndicatorSums
{
  int count{};
  double square{};  // of the indicator alone
  Place mixed{};
  PlaceSquares places{};
};

/// Sums over the learned windows, of differences from the means.
struct ReferenceSums
{
  std::array<IndicatorSums, INDICATOR_COUNT> by_indicator{};
  std::array<double, INDICATOR_COUNT> means{};
  std::array<Place, INDICATOR_COUNT> mean_places{};
  PlaceSquares places{};  // over all windows
  /// Products of two indicators over all windows, as the rows of a lower triangle.
  std::array<double, INDICATOR_COUNT*(INDICATOR_COUNT + 1) / 2> indicators{};
};

/// Sums over pairs of successive windows, of differences from one to the next.
struct StepSums
{
  std::array<IndicatorSums, INDICATOR_COUNT> by_indicator{};
  std::uint64_t last_window{};  // SignalIndicators::windows of the last learned window
  std::array<double, INDICATOR_COUNT> last{};
  Place last_place{};
};

/// Number of kinds of indicators with a tail of their own: scalars and lines.
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

/// The first windows of a class, kept because no sum holds their tails.
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
  /// Normal score of the deviation: a normal quantity of known spread is as unlikely at so many standard deviations.
  /// NaN: not compared.
  double score{ std::numeric_limits<double>::quiet_NaN() };
  double threshold_factor{};  ///< deviation over spread, as a multiple of that at the threshold [-]
  double freedom{};           ///< v': degrees of freedom that deviation over spread has [-]
  double stretch{ 1.0 };      ///< its spread in Student's unit [-]

  /// Score that another difference from the reference would have; 0: not compared.
  double scoreOf(double difference) const noexcept;
};

using Deviations = std::array<Deviation, INDICATOR_COUNT>;

/// Change of an amplitude as a nearly normal number. The amplitude of noise alone has Rayleigh's distribution, whose
/// tail is far longer than that of the normal distribution. Its power 2/3 has no such tail (Wilson and Hilferty 1931).
///
/// Law:   c = 3/2 m^(1/3) ((m + x)^(2/3) - m^(2/3)),  to first order x;  c = x if m = 0
/// where  m  sound amplitude;  x  its change, at least -m;  both in the unit of the amplitude
double amplitudeChange(double sound, double change) noexcept;

/// Difference of the last windows of a class from their reference, and the covariance D + F F' of sound windows.
/// F  Reference::common times the reference's share of a score's spread;  D  square of the spread that F leaves
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

enum class AssessmentState : std::uint8_t
{
  WAITING = 0,          ///< no window has been completed
  LEARNING = 1,         ///< the window went into the reference of its operating point
  ASSESSED = 2,         ///< the last window was compared with the reference, and the level is a verdict
  NO_REFERENCE = 3,     ///< the given reference does not know this operating point
  TOO_FEW_WINDOWS = 4,  ///< compared, but nothing found in fewer windows of this operating point than a verdict takes
  OTHER_PAYLOAD = 5     ///< not compared: the reference knows no such payload or load
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
///        k        windows averaged, less those left out at one end
///        w^2      half the mean square of the steps from each to the next, without the two largest: of more than
///                 three windows
///        r        share of s^2 that stays from one window to the next: 1 less half the mean square of what successive
///                 windows differ by, over s^2 (von Neumann 1941), drawn to the mean of scalars or lines by as much as
///                 its error explains their scatter, plus what it is then uncertain by; 1 if none followed another
///        e        share of the windows that count as independent, (1 - r') / (1 + r'), at least one in every stretch;
///                 r' as r, less the error; 1 if none followed another
///        s_0, v_0 spread by lines like it (varianceOfAlike) and ALIKE_FREEDOM; of what is no line, or carried, v_0 = 0
///        c, c_0   what the motion makes of the fit's standard error (relativeErrors), rms, of the windows averaged and
///                 of the healthy ones: what a line is off by differs between windows as c does
///        q        a tenth of what one encoder count makes; 0.3 for kurtosis, 0.5 for crest
/// A carried reference is a reference of another motion, for windows from which a model is subtracted. Such windows are
/// compared with the class of motion to and fro at their temperature that has the most windows. b is over temperature
/// alone, and F is 0. The variance grows by the squares of CarriedError::deviation and of CarriedError::share of |m|
/// (of a line: of all amplitudes of its signal together), both times 10/windows below ten windows. v is
/// CarriedError::freedom at most.
/// The score turns Student's t into a normal deviate (Wallace 1959), so that few windows give no more alarms than many
/// windows do.
/// Thresholds: normal quantiles of indicators.false_alarm_rate, one half of it shared by all indicators, two-sided, the
/// other by the patterns of all causes, one-sided (Bonferroni); without patterns all of it by the indicators.
/// A window at the edge of a class with too few windows for a reference belongs to the class beyond that edge. A window
/// whose payload or load makes S^2 more than OTHER_PAYLOAD_WIDENING times as large is not compared.
///
/// Learning opens indicators.baseline_classes classes at most. The constructor takes their memory, 0.2 MB for each. A
/// given reference needs 19 kB for each class, and its memory replaces that of the learned classes.
class Baseline
{
public:
  static constexpr std::size_t MAX_EVIDENCE = 100;  // windows
  /// Least number of windows for a spread, and least value of indicators.baseline_windows.
  static constexpr int MIN_WINDOWS = 8;

  /// `signatures` gives the CarriedErrors.
  Baseline(const Parameters& parameters, std::shared_ptr<const SignatureSet> signatures);

  /// Sets the reference of a file; learning stops. `carried`: the reference is of another motion.
  void setReference(std::vector<ReferenceBin> bins, bool carried = false);

  void reset() noexcept;  ///< forgets a learned reference, but keeps a given one

  /// Learns a window or compares it: LEARNING, ASSESSED, NO_REFERENCE or OTHER_PAYLOAD. `model`: indicators of a model
  /// that were subtracted from it; nullptr: none.
  AssessmentState update(const SignalIndicators& indicators, const SignalIndicators* model,
                         Deviations& deviations) noexcept;

  double threshold() const noexcept { return threshold_; }  ///< threshold of |score| [-]
  Deviation pattern(double student) const noexcept;         ///< scores a value of Student's t along a pattern
  double patternThreshold() const noexcept { return pattern_threshold_; }  ///< threshold of the score of a pattern [-]
  const WindowResidual& residual() const noexcept { return residual_; }    ///< for the class of the last window
  const OperatingBin& bin() const noexcept { return bin_; }                ///< class of the last window
  const std::vector<ReferenceBin>& bins() const noexcept { return bins_; }
  const std::vector<LearnedSums>& sums() const noexcept
  {
    return sums_;
  }                                                           ///< by bin; empty of a reference that was given
  int windowsHere() const noexcept { return windows_here_; }  ///< windows in the reference, or compared since reset
  /// Windows that a reference needs.
  int windowsNeeded() const noexcept { return given_ ? MIN_WINDOWS : windows_; }
  bool given() const noexcept { return given_; }  ///< setReference has given the reference, so that it has no sums
  double loadStep() const noexcept { return load_step_; }  ///< width of a class of load [N.m]
  const Repeatability& repeatability() const noexcept { return repeatability_; }

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

  /// Factors and terms of a difference's variance beside that of the reference.
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
