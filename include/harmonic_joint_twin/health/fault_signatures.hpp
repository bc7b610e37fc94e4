// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "harmonic_joint_twin/health/baseline.hpp"
#include "harmonic_joint_twin/health/signal_indicators.hpp"
#include "harmonic_joint_twin/params/faults.hpp"

namespace hjt
{
/// Causes of an alarm: the kinds of faults, in their order from FIRST_FAULT on, and a damaged tooth of the circular
/// spline.
enum class Cause : std::uint8_t
{
  NONE,
  FIRST_FAULT,
  CIRCULAR_SPLINE_TOOTH = FIRST_FAULT + FAULT_KINDS,
  COUNT
};
constexpr auto CAUSE_COUNT = static_cast<std::size_t>(Cause::COUNT);

constexpr Cause causeOf(FaultKind kind)
{
  return static_cast<Cause>(static_cast<std::size_t>(Cause::FIRST_FAULT) + static_cast<std::size_t>(kind));
}

const char* causeName(Cause cause) noexcept;  ///< name of the cause, for example "tooth_root_crack"

/// Groups of indicators that show the same property of the drive. In each group the strongest indicator counts.
enum class Feature : std::size_t
{
  RATIO,
  KINEMATIC_ERROR,
  STIFFNESS,
  LOST_MOTION,
  LOOP_AREA,
  RUNNING_TORQUE,
  COULOMB,
  VISCOUS,
  EFFICIENCY,
  RESIDUAL,
  IMPULSES,  ///< kurtosis and crest of the residual
  ORDER_1,
  ORDER_2,
  ORDER_4,
  ORDER_6,
  ORDER_8,
  ORDER_CIRCULAR_SPLINE,
  CAGE,
  BALL,
  OUTER,
  INNER,
  COUNT
};
constexpr auto FEATURE_COUNT = static_cast<std::size_t>(Feature::COUNT);

/// Largest deviation within a group of indicators.
struct FeatureScore
{
  double score{};             ///< signed score; of a phase-locked line the length of its change, > 0; 0: not compared
  double threshold_factor{};  ///< as in Deviation
  std::size_t indicator{};    ///< index of that indicator
  bool compared{};
};
using FeatureScores = std::array<FeatureScore, FEATURE_COUNT>;

FeatureScores featureScores(const Deviations& deviations) noexcept;

/// Numbers of a signature: the scalar indicators, then the amplitudes of the lines by signal. Of a phase-locked line
/// the number is the length of its complex change, because the phase depends on the fault's place.
constexpr std::size_t SIGNATURE_SIZE = SCALAR_COUNT + LINE_SIGNALS * FIRST_LOADED + LOADED_COUNT;

constexpr std::size_t signatureNumber(LineSignal signal, std::size_t line)  ///< for lines with hasLine
{
  return SCALAR_COUNT + static_cast<std::size_t>(signal) * FIRST_LOADED + line;
}
static_assert(signatureNumber(LineSignal::MOTOR_RIPPLE, LINE_COUNT) == SIGNATURE_SIZE);

/// Whether a signature gives a change as a share of the sound value. Stiffness and play scale with the size of the cup,
/// thicker grease multiplies the friction, and the lag depends on the gains of the controller.
constexpr bool isShare(Cause cause, ScalarIndicator indicator)
{
  switch (indicator)
  {
    case ScalarIndicator::TORSIONAL_STIFFNESS:
    case ScalarIndicator::SECOND_STIFFNESS:
    case ScalarIndicator::LOST_MOTION:
    case ScalarIndicator::HYSTERESIS:
    case ScalarIndicator::HYSTERESIS_AREA:
    case ScalarIndicator::LOAD_FRICTION:
    case ScalarIndicator::LAG_RIPPLE:
    case ScalarIndicator::LAG_ORDER_1:
    case ScalarIndicator::LAG_ORDER_2:
    case ScalarIndicator::LAG_ORDER_4:
      return true;
    case ScalarIndicator::RUNNING_TORQUE:
    case ScalarIndicator::COULOMB_TORQUE:
    case ScalarIndicator::VISCOUS_FRICTION:
      return cause == causeOf(FaultKind::LUBRICANT_DEGRADATION);
    default:
      return false;
  }
}

constexpr bool isStiffness(ScalarIndicator indicator)
{
  return indicator == ScalarIndicator::TORSIONAL_STIFFNESS || indicator == ScalarIndicator::SECOND_STIFFNESS;
}

/// Additional numbers of a robot in closed loop, from LOAD_FRICTION on.
constexpr std::size_t FIRST_OF_ROBOT = indexOf(ScalarIndicator::LOAD_FRICTION);
constexpr std::size_t ROBOT_NUMBERS = indexOf(ScalarIndicator::LAG_ORDER_4) - FIRST_OF_ROBOT + 1;

constexpr bool isOfRobot(std::size_t number)
{
  return number - FIRST_OF_ROBOT < ROBOT_NUMBERS;
}

/// Changes of those numbers by a fault, as shares of the sound values, for any gear in any motion.
struct RobotSignature
{
  Cause cause;
  double severity;  ///< 0 ... 1 [-]
  std::array<double, ROBOT_NUMBERS> share;
};

/// Speed and direction of a motion.
struct MotionKind
{
  double speed;      ///< magnitude of the motor's speed [rad/s]
  double direction;  ///< magnitude of OperatingPoint::direction, 0 ... 1 [-]
};
constexpr MotionKind ANY_MOTION{ 0.0, 0.0 };

/// Changes of the indicators of one gear in one motion by a fault of one severity.
struct Signature
{
  Cause cause;
  double severity;  ///< 0 ... 1 [-]
  MotionKind motion;
  std::array<double, SIGNATURE_SIZE> change{};  ///< in the units of the indicators; as a share if isShare [-]
};

/// One signature, or several that come together. The first one is that of the cause; null: none.
using SignatureParts = std::array<const Signature*, 3>;

/// The signatures of a gear and their errors, from the file that parameter indicators.signatures names. Without a file
/// there are no signatures, and the errors of a carried reference are not known.
struct SignatureSet
{
  SignatureSet() { sound.fill(std::numeric_limits<double>::quiet_NaN()); }

  std::string gear;                           ///< name of the gear, for the user
  double number_error{};                      ///< r of CauseSearch [-]
  double motion_error{};                      ///< m [-]
  double line_error{};                        ///< l [-]
  double evidence_weight{};                   ///< b_0 [-]
  double misfit_weight{};                     ///< w_1 [-]
  double severity_error{};                    ///< relative error of the severity by the signatures [-]
  double severity_misfit{};                   ///< additional relative error of the severity if no signature fits [-]
  std::vector<Signature> signatures;          ///< with the indicators of a robot
  std::vector<RobotSignature> of_robots;      ///< by cause, in ascending order of severity
  std::array<bool, SIGNATURE_SIZE> fitted{};  ///< indicators that the signatures contain; the search ignores the others
  std::array<double, SCALAR_COUNT>
      sound{};  ///< indicators of the sound drive in the check-up, in their units; NaN: not known
  std::array<CarriedError, INDICATOR_COUNT> carried{};
  std::array<double, CAUSE_COUNT> occurrence{};  ///< rating of how often a cause occurs; 0: not rated [-]
};

/// Causes that change an indicator by at least `share` of its sound value at severity 1; `sign`: +1 up, -1 down.
std::vector<Cause> causesThatMove(const SignatureSet& set, ScalarIndicator indicator, double sign, double share);

std::size_t patternCount(const SignatureSet& set) noexcept;  ///< number of causes that have signatures

/// The cause whose pattern a window shows most clearly.
struct PatternScore
{
  Cause cause{};     ///< NONE: no cause
  double student{};  ///< Student's t with WindowResidual::freedom, one-sided [-]
};

/// The window's differences d along the pattern of each cause. Many small changes that belong together show along a
/// pattern before any of them is out of the ordinary by itself.
///
/// Law:   t = p' C^-1 d / sqrt(p' C^-1 p),  C = D + F F',  p_i = sum_h P(h) mu_i / |mu|,  |mu|^2 = sum_i mu_i^2 / D_ii
/// where  h        over the signatures of the cause whose severity is nearest to 0.4
/// others   as in CauseSearch; lines are excluded, because F contains little of the noise that neighbouring lines share
class CausePatterns
{
public:
  explicit CausePatterns(std::shared_ptr<const SignatureSet> set);

  PatternScore strongest(const WindowResidual& residual, const OperatingPoint& point) const noexcept;

private:
  std::shared_ptr<const SignatureSet> set_;
  std::array<std::vector<std::size_t>, CAUSE_COUNT> rows_;  // indices in the set
};

/// Probability and severity of each cause by a window.
struct CausePosterior
{
  /// Probability, given that the drive is not sound; entry NONE: no fault of the table is the cause [-].
  std::array<double, CAUSE_COUNT> probability{};
  std::array<double, CAUSE_COUNT> severity{};            ///< mean, given the cause [-]
  std::array<double, CAUSE_COUNT> severity_deviation{};  ///< standard deviation of the severity [-]
};

/// Searches for the cause by the likelihood of the window's differences d from the reference under every signature.
///
/// Law:   d ~ t_v(mu, D_h + F F'),   P(h | d) ~ P(h) p(d | h)^b,   P(h) ~ 1 + O / O_m by cause, within it ~ w_0 + a
///        a = exp(-(ln(n / n_h) / N)^2 / 2 - ((q - q_h) / Q)^2 / 2), 1 in ANY_MOTION
///        D_h,ii = D_ii (1 + S^2) + (r^2 + m^2 (1 - a)) mu_i^2 + (l s A_i)^2 / 2
///        b = b_0 (w_1 + (1 - w_1) / f),   f = max(1, (d - mu)' (D + F F')^-1 (d - mu) / N) of the most likely h
/// where  mu       change by the signature; of the two parts of a line with a phase: mean 0, variance half its square
///        D, F, v  WindowResidual
///        O, O_m   rated occurrence of the cause, mean of those that are rated: of the others, and of none, O = O_m
///        r        error of a signature in proportion to each number: other gears, places
///        S        strength of something of no signature, 0 of a signature
///        m, a     error of each number in a motion of another kind;  how far the motions are alike
///        A, s     amplitude of the line that the sound drive has there, 0 of what is no line with a phase; severity
///        l        share of such a line that a fault of severity 1 changes: errors of manufacture differ. Also of
///                 the lost motion, without the 2: how far wear opens the teeth depends on how tight they were
///        b        weight of the evidence: what a signature is off by is not independent from number to number
///        f, N     misfit: the more even the best signature leaves, the less the evidence says, w_1 of it at least,
///                 and the less is known of the severity;  numbers compared
///        n, q     MotionKind of the window, of the signature: where a line meets a resonance of the drive, it is the
///                 larger part of every signature, elsewhere of none;  N = 0.2, Q = 0.3, w_0 = 0.001
/// Teeth, interface and grease wear together: h is also the sum of the signatures of two or three of them in one
/// motion,
/// where the others have the severity of the first or two fifths of it. Such a sum counts for the cause of the first,
/// and all its sums together have the same prior weight as its single signatures, in addition to these.
/// Stiffness changes as a compliance does: mu = c x^2 / x_h,  c  share by the signature, x  sound value of the window's
/// motion, x_h  of SignatureSet::sound. An eccentric encoder adds the same to the compliance of every drive.
/// Something of no signature: mu = 0, S = 3, 10, 30, 100. With a tenth of the weight each, what is no fault of a
/// gear: a brake that drags, mu of running and Coulomb torque 0.05, 0.15, 0.4, 1 of the sound running torque, S = 0;
/// noise g = 0.12, 0.25, 0.5, 1 more, 1 + S^2 = (1 + g)^2, mu of the kinematic error g of the sound one.
/// Indicators for which the signatures were not fitted do not count.
///
/// A search makes one pass over all signatures for their likelihoods and one for the sums over them, in as many parts
/// as the caller chooses. Only the constructor allocates.
class CauseSearch
{
public:
  explicit CauseSearch(std::shared_ptr<const SignatureSet> set);

  std::size_t signatures() const noexcept
  {
    return 2 * likelihoods_.size();
  }  ///< steps of a search: both passes over the signatures

  void start() noexcept;  ///< begins a search for the next window
  bool isDone() const noexcept { return next_ == signatures(); }

  /// Advances by up to `count` signatures. Residual and point must not change before the search is done.
  void advance(const WindowResidual& residual, const OperatingPoint& point, std::size_t count) noexcept;

  CausePosterior posterior() const noexcept;  ///< result; valid after the search

private:
  struct Row
  {
    SignatureParts parts{};
    double prior{ 1.0 };  // prior relative to that of a single signature
  };
  static std::vector<Row> rowsOf(const SignatureSet& set);
  static std::array<double, CAUSE_COUNT> priorsOf(const SignatureSet& set);

  /// Sums over the signatures of one cause.
  struct Sum
  {
    /// `weighted`: logarithm of the likelihood times the weight of the evidence.
    void add(double weighted, double prior, double severity) noexcept;

    double priors{};
    double total{};   // sum of prior times weighted likelihood
    double first{};   // first moment of the severity
    double second{};  // second moment of the severity
  };

  std::shared_ptr<const SignatureSet> set_;
  std::vector<Row> rows_;
  std::array<double, CAUSE_COUNT> beforehand_;  // priors (1 + O / O_m) / 2
  // logarithms, of the rows, then of the unknown causes; after the first pass times b
  std::vector<double> likelihoods_;
  double misfit_{ 1.0 };  // f, after the first pass
  std::array<Sum, CAUSE_COUNT> sums_{};
  std::size_t next_{};
};
}  // namespace hjt
