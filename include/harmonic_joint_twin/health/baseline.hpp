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
  double deviation{ 1e30 };  ///< rms of a drive like the model, unit of the indicator; 1e30: not known
  double share{};            ///< share of the difference of drive and model, of a line of all lines of its signal [-]
  double freedom{ 1.0 };     ///< degrees of freedom both are known with [-]
};

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

/// `load_step`: step between two classes of load [N.m].
OperatingBin binOf(const OperatingPoint& point, double load_step) noexcept;

/// The gear's step between two classes of load [N.m].
double loadStep(const Parameters& parameters) noexcept;

/// Covariates of healthy indicators within a class: temperature, its square, the load's mean magnitude, and numbers of
/// the payload, which are constant during a job and equal on any path. Those are the load's constant part, its parts
/// over sine and cosine of the output angle, and the inertia.
constexpr std::size_t PLACES = 7;
constexpr std::size_t OWN_PLACES = 2;  ///< number of the first covariates, for which each class has slopes of its own
using Place = std::array<double, PLACES>;
using PlaceSquares = std::array<Place, PLACES>;  ///< by pairs of coordinates

/// Deviations of a sound drive from one recording to the next, beside those in its reference.
struct Repeatability
{
  double share{};            ///< indicators.least_spread [-]
  double friction_share{};   ///< of the friction, at any speed [-]
  double friction_torque{};  ///< of the friction too, at the motor [N.m]
};

/// Largest number of common causes, which change several healthy indicators together from window to window.
constexpr std::size_t COMMON_CAUSES = 3;

/// One healthy indicator, over the windows that determined it.
struct Reference
{
  int count{};
  double mean{};             // unit of the indicator; from fitReference on at the mean place of the class
  double variance{};         // about the mean, from fitReference on about what the place makes of it
  double within{};           // half the mean square of what successive windows differ by; 0: not known
  double relative_square{};  // mean square of the windows' relativeErrors; 0: not known [-]
  double scale{};            // mean magnitude, what was subtracted included; unit of the indicator
  bool fitted{};             // has slopes and shares of common causes
  double ridge{};            // lambda: information of the slopes before any window, in windows at place 1 [-]
  double slopes_freedom{};   // degrees of freedom that the slopes take [-]
  Place slopes{};            // over the place, unit of the indicator
  /// Shares of the spread that go with each common cause, of unit variance [-]
  std::array<double, COMMON_CAUSES> common{};
};

/// Sums of products of the differences of an indicator and of the place, over the windows or pairs of windows that have
/// the indicator.
struct IndicatorSums
{
  int count{};
  double square{};  // of the indicator
  Place mixed{};
  PlaceSquares places{};
};

/// Sums over the learned windows, of differences from the means.
struct ReferenceSums
{
  std::array<IndicatorSums, INDICATOR_COUNT> by_indicator{};
  std::array<double, INDICATOR_COUNT> means{};
  std::array<Place, INDICATOR_COUNT> mean_places{};
  PlaceSquares places{};  // of all windows
  /// Of all windows, row by row up to the diagonal.
  std::array<double, INDICATOR_COUNT*(INDICATOR_COUNT + 1) / 2> indicators{};
};

/// Sums over pairs of successive windows, of differences from one to the next.
struct StepSums
{
  std::array<IndicatorSums, INDICATOR_COUNT> by_indicator{};
  std::uint64_t last_window{};  // SignalIndicators::windows, of the last one learned
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
  int runs{};  // stretches of windows that follow each other
  Place mean_place{};
  PlaceSquares information{};        // of the slopes by the windows' places, without ridge; from fitReference
  std::array<double, TAILS> tail{};  // 1/degrees of freedom of the windows' own distribution, 0: normal; likewise
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

/// Sums that the reference of a class is fitted to, in addition to its ReferenceBin.
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

/// One indicator against its reference.
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
/// Law:   c = 3/2 m^(1/3) ((m + x)^(2/3) - m^(2/3)),  to first order x;  x where m is none
/// where  m  sound amplitude;  x  change of it, not below -m;  in the unit of the amplitude
double amplitudeChange(double sound, double change) noexcept;

/// Difference of the last windows of a class from their reference, and the covariance D + F F' of sound windows.
/// F  Reference::common times the reference's share of a score's spread;  D  square of the spread that F leaves
struct WindowResidual
{
  int windows{};                                     ///< number of windows averaged [-]
  std::array<double, INDICATOR_COUNT> sound{};       ///< reference with what was subtracted, units of the indicators
  std::array<double, INDICATOR_COUNT> difference{};  ///< from it; of what isFreeAmplitude by amplitudeChange
  std::array<double, INDICATOR_COUNT> own{};         ///< diagonal of D; 0: not compared
  std::array<std::array<double, COMMON_CAUSES>, INDICATOR_COUNT> common{};  ///< rows of F
  double freedom{};                                                         ///< v: of the reference's spreads [-]
  double pattern_freedom{};                                                 ///< v' of what scalars have together [-]
  double pattern_stretch{ 1.0 };                                            ///< its spread in Student's unit [-]
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

/// Indicators of a healthy joint by operating point: learned from the first windows there, or given. Compared is the
/// trimmed mean over the last indicators.evidence_windows windows of a class: a fifth of them, one at least of three or
/// more, is left out at either end.
///
/// Law:   S^2 = p (r + 1/(e n)) + max(p (1 - r), w^2) / k + R^2 + q^2 + (p + R^2) (z - z_0)' L (z - z_0) / e
///        t = g mean(x - m - b (z - z_0)) / S,   g^2 = 1 / (1 - 2 y^2 a / k)
///        p = (v s^2 + v_0 s_0^2) / (v + v_0) max(c^2 / c_0^2, 1)
///        score = sign(t) sqrt(v' log(1 + t^2 / v')) (8 v' + 1) / (8 v' + 3)
///        1 / v' = y^2 ((1 + 3 a / (1 - 4 a)) / (v + v_0) + a / k),   v = e n - 1 - d, at least 1
/// where  m, s, n  mean, standard deviation and number of the healthy windows
///        z, z_0   place of the window in its class, mean of the healthy ones;  b, s  slopes over it and what they
///                 leave, by ridge regression (fitReference);  L, d  covariance of the slopes where s = 1, degrees of
///                 freedom they take
///        y        share of S^2 that is learned: of p and w^2 (Satterthwaite 1946)
///        a        1 / degrees of freedom of one window's own distribution, by the healthy ones; 0: normal
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

  /// `signatures`: its CarriedErrors are used.
  Baseline(const Parameters& parameters, std::shared_ptr<const SignatureSet> signatures);

  /// Sets the reference of a file; learning stops. `carried`: the reference is of another motion.
  void setReference(std::vector<ReferenceBin> bins, bool carried = false);

  void reset() noexcept;  ///< forgets a learned reference, but keeps a given one

  /// Learns a window or compares it: LEARNING, ASSESSED, NO_REFERENCE or OTHER_PAYLOAD. `model`: indicators of a model
  /// that were subtracted from it; nullptr: none.
  AssessmentState update(const SignalIndicators& indicators, const SignalIndicators* model,
                         Deviations& deviations) noexcept;

  double threshold() const noexcept { return threshold_; }                 ///< of |score| [-]
  Deviation pattern(double student) const noexcept;                        ///< scores that, along a pattern
  double patternThreshold() const noexcept { return pattern_threshold_; }  ///< of the score of a pattern [-]
  const WindowResidual& residual() const noexcept { return residual_; }    ///< of the class of the last window
  const OperatingBin& bin() const noexcept { return bin_; }                ///< class of the last window
  const std::vector<ReferenceBin>& bins() const noexcept { return bins_; }
  const std::vector<LearnedSums>& sums() const noexcept
  {
    return sums_;
  }                                                           ///< by bin; empty of a reference that was given
  int windowsHere() const noexcept { return windows_here_; }  ///< windows in the reference, or compared since reset
  /// Windows that a reference needs.
  int windowsNeeded() const noexcept { return given_ ? MIN_WINDOWS : windows_; }
  bool given() const noexcept { return given_; }           ///< by setReference: there are no sums to fit again
  double loadStep() const noexcept { return load_step_; }  ///< [N.m]
  const Repeatability& repeatability() const noexcept { return repeatability_; }

private:
  /// One window against its reference.
  struct Compared
  {
    std::array<double, INDICATOR_COUNT> difference{};  // NaN: not compared
    std::array<double, INDICATOR_COUNT> relative{};    // relativeErrors
    Place along{};                                     // z - z_0 along the axes of the slopes' information, squared
  };

  /// The last windows of a class, oldest overwritten.
  struct Recent
  {
    std::size_t count{};
    std::size_t next{};
  };

  /// A difference of several windows.
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
    double slopes{};   // by the uncertainty of the slopes
    double carried{};  // added by carrying [unit of the indicator squared]
  };

  /// Variance of a difference [unit of the indicator squared].
  struct Variance
  {
    double all{};
    double learned{};  // part of the variance that was learned: from the reference's windows and their scatter
  };

  ReferenceBin* find(const OperatingPoint& point) noexcept;
  ReferenceBin* findCarried(const OperatingBin& bin) noexcept;
  void makeRoom(std::size_t bins);
  /// The window's place less the reference's mean one, as it is compared.
  Place placeFrom(const ReferenceBin& bin, const OperatingPoint& point) const noexcept;
  bool isOtherPayload(const ReferenceBin& bin, const Place& place) const noexcept;
  void take(const ReferenceBin& bin, const Place& place, const SignalIndicators& indicators,
            const SignalIndicators* model, Compared& window) noexcept;
  Average average(std::size_t first, std::size_t count, std::size_t indicator) const noexcept;
  /// `left`: of the reference [unit of the indicator squared].
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
  std::array<double, INDICATOR_COUNT> floor_{};  // q
  Place axes_sizes_{};                           // information along its axes, of the last window's class
  WindowResidual residual_;
  std::array<double, INDICATOR_COUNT> expected_{};  // of the last window, without the model's indicators
  OperatingBin bin_;
  int windows_here_{};
  bool given_{};
  bool carried_{};
  std::vector<ReferenceBin> bins_;  // never beyond its first capacity
  std::vector<LearnedSums> sums_;   // likewise
  FitRoom fit_room_;
  std::vector<Recent> recent_;      // by bin
  std::vector<Compared> compared_;  // evidence_windows_ by bin
};
}  // namespace hjt
