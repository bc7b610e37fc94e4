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
/// Causes of a deviation: all kinds of faults, in their order from FIRST_FAULT on, and a damaged tooth of the circular
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

/// Groups of redundant indicators. Only the strongest indicator of a group counts.
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

/// First of the indicators that a robot with closed-loop control gives in addition: from LOAD_FRICTION on.
constexpr std::size_t FIRST_OF_ROBOT = indexOf(ScalarIndicator::LOAD_FRICTION);
constexpr std::size_t ROBOT_NUMBERS = indexOf(ScalarIndicator::LAG_ORDER_4) - FIRST_OF_ROBOT + 1;

constexpr bool isOfRobot(std::size_t number)
{
  return number - FIRST_OF_ROBOT < ROBOT_NUMBERS;
}

/// Changes of those indicators by a fault, as shares of the sound values. They hold for any gear and motion.
struct RobotSignature
{
  Cause cause;
  double severity;  ///< 0 ... 1 [-]
  std::array<double, ROBOT_NUMBERS> share;
};

/// Properties that distinguish kinds of motion.
struct MotionKind
{
  double speed;      ///< magnitude of the motor's speed [rad/s]
  double direction;  ///< magnitude of OperatingPoint::direction, 0 ... 1 [-]
};
constexpr MotionKind ANY_MOTION{ 0.0, 0.0 };

/// Changes of the indicators by a fault of one severity, for one gear in one motion.
struct Signature
{
  Cause cause;
  double severity;  ///< 0 ... 1 [-]
  MotionKind motion;
  std::array<double, SIGNATURE_SIZE> change{};  ///< in the units of the indicators; as a share if isShare [-]
};

/// One signature, or several that occur together, of which the first gives the cause; null: none.
using SignatureParts = std::array<const Signature*, 3>;

/// Signatures of a gear with their uncertainty, from the file of indicators.signatures. Without a file there are no
/// signatures, and the errors of a carried reference are unknown.
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

/// Cause whose pattern correlates best with a window.
struct PatternScore
{
  Cause cause{};     ///< NONE: no cause
  double student{};  ///< Student's t with WindowResidual::freedom, one-sided [-]
};

/// Projects the window's differences d on the pattern of each cause. Many small changes along a pattern are significant
/// before any single one is.
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

/// Probability and severity of each cause, given a window.
struct CausePosterior
{
  /// Probability, given that the drive is not sound; entry NONE: no fault of the table is the cause [-].
  std::array<double, CAUSE_COUNT> probability{};
  std::array<double, CAUSE_COUNT> severity{};            ///< mean, given the cause [-]
  std::array<double, CAUSE_COUNT> severity_deviation{};  ///< standard deviation of the severity [-]
};

/// Likelihood of the window's differences d from the reference, under every signature.
///
/// Law:   d ~ t_v(mu, D_h + F F'),   P(h | d) ~ P(h) p(d | h)^b,   P(h) ~ 1 + O / O_m by cause, within it ~ w_0 + a
///        a = exp(-(ln(n / n_h) / N)^2 / 2 - ((q - q_h) / Q)^2 / 2), 1 in ANY_MOTION
///        D_h,ii = D_ii (1 + S^2) + (r^2 + m^2 (1 - a)) mu_i^2 + (l s A_i)^2 / 2
///        b = b_0 (w_1 + (1 - w_1) / f),   f = max(1, (d - mu)' (D + F F')^-1 (d - mu) / N) of the most likely h
/// where  mu       change by the signature; of the two parts of a phase-locked line: mean 0, variance half its square
///        D, F, v  see WindowResidual
///        O, O_m   rated occurrence of the cause, mean of all rated ones; an unrated cause has O = O_m
///        r        relative error of each number of a signature for other gears and places
///        S        strength of an unknown cause, 0 of a signature
///        m, a     relative error of each number in a motion of another kind;  similarity of the motions, 0 ... 1
///        A, s     amplitude of the line of the sound drive there, 0 except for phase-locked lines;  severity
///        l        share of such a line that a fault of severity 1 changes, because errors of manufacture differ. For
///                 the lost motion the term has no 2: the tightness of the fit determines how far wear opens the teeth
///        b        weight of the evidence: the errors of a signature's numbers are not independent
///        f, N     misfit of the best signature, number of compared indicators. A larger misfit lowers the weight of
///                 the evidence, to w_1 at least, and makes the severity less certain
///        n, q     MotionKind of the window, n_h, q_h of the signature: at a resonance of the drive a line dominates
///                 every signature;  N = 0.2, Q = 0.3, w_0 = 0.001
/// Teeth, interface and grease wear together. Therefore h is also the sum of the signatures of two or three of them in
/// one motion. The others have the severity of the first or two fifths of it. The sum counts for the cause of the
/// first, and all sums of a cause together have the same prior as its single signatures. Stiffness changes as a
/// compliance does: mu = c x^2 / x_h,  c  share by the signature, x  sound value of the window's motion, x_h  of
/// SignatureSet::sound. An eccentric encoder adds the same to the compliance of every drive. An unknown cause has mu =
/// 0, S = 3, 10, 30, 100. Two conditions that are no fault of the gear have a tenth of the prior. A dragging brake has
/// mu of running and Coulomb torque 0.05, 0.15, 0.4, 1 of the sound running torque and S = 0. Noise has g = 0.12, 0.25,
/// 0.5, 1 with 1 + S^2 = (1 + g)^2 and mu of the kinematic error g times the sound one. The search ignores indicators
/// that the signatures were not fitted for.
///
/// A search passes twice over all signatures, for their likelihoods and for the sums over them. The caller divides the
/// passes into parts of any size. Only the constructor allocates.
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
