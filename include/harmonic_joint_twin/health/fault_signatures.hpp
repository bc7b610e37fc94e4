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
/// Causes of an alarm: none, the kinds of faults (from FIRST_FAULT on), and a damaged tooth of the circular spline.
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

/// Groups of indicators that show one property of the drive. Only the largest score of each group counts.
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
  double score{};             ///< score with its sign; never < 0 for a line; 0: not compared [-]
  double threshold_factor{};  ///< Deviation::threshold_factor of the indicator [-]
  std::size_t indicator{};    ///< index of the indicator with the largest deviation
  bool compared{};
};
using FeatureScores = std::array<FeatureScore, FEATURE_COUNT>;

FeatureScores featureScores(const Deviations& deviations) noexcept;

/// Number of values in a signature: changes of the scalar indicators, then of the lines' amplitudes by signal. For a
/// phase-locked line the value is the magnitude of the complex change, whose phase depends on the place of the fault.
constexpr std::size_t SIGNATURE_SIZE = SCALAR_COUNT + LINE_SIGNALS * FIRST_LOADED + LOADED_COUNT;

constexpr std::size_t signatureNumber(LineSignal signal, std::size_t line)  ///< index in a signature; needs hasLine
{
  return SCALAR_COUNT + static_cast<std::size_t>(signal) * FIRST_LOADED + line;
}
static_assert(signatureNumber(LineSignal::MOTOR_RIPPLE, LINE_COUNT) == SIGNATURE_SIZE);

/// Whether a signature states a change as a share of the sound value: stiffness and lost motion scale with the size of
/// the cup, thicker grease multiplies the friction, and the lag depends on the gains of the controller.
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

/// Index of the first value that a signature has only for a robot in closed loop (friction by load, lag).
constexpr std::size_t FIRST_OF_ROBOT = indexOf(ScalarIndicator::LOAD_FRICTION);
constexpr std::size_t ROBOT_NUMBERS = indexOf(ScalarIndicator::LAG_ORDER_4) - FIRST_OF_ROBOT + 1;

constexpr bool isOfRobot(std::size_t number)
{
  return number - FIRST_OF_ROBOT < ROBOT_NUMBERS;
}

/// Changes of the lag and of the friction by load, over their sound values, by a fault in a robot with any gear.
struct RobotSignature
{
  Cause cause;
  double severity;  ///< severity of the fault, 0 ... 1 [-]
  std::array<double, ROBOT_NUMBERS> share;
};

/// Speed and direction of a motion.
struct MotionKind
{
  double speed;      ///< magnitude of the motor's speed [rad/s]
  double direction;  ///< magnitude of OperatingPoint::direction, 0 ... 1 [-]
};
constexpr MotionKind ANY_MOTION{ 0.0, 0.0 };

/// Changes of all indicators of one gear in one motion by a fault of one severity.
struct Signature
{
  Cause cause;
  double severity;  ///< severity of the fault, 0 ... 1 [-]
  MotionKind motion;
  std::array<double, SIGNATURE_SIZE> change{};  ///< changes in the indicators' units, or shares [-] if isShare
};

/// One signature, or several that occur together. The first one is the signature of the cause; null: no signature.
using SignatureParts = std::array<const Signature*, 3>;

/// The signatures of a gear and their errors, from the file that parameter indicators.signatures names. Without a file
/// the set has no signatures and no errors of a carried reference.
struct SignatureSet
{
  SignatureSet() { sound.fill(std::numeric_limits<double>::quiet_NaN()); }

  std::string gear;                       ///< name of the gear, for the user
  double number_error{};                  ///< relative error of each value of a signature, r of CauseSearch [-]
  double motion_error{};                  ///< further relative error if the motions are unlike, m of CauseSearch [-]
  double line_error{};                    ///< share of a sound drive's line that a fault changes, l of CauseSearch [-]
  double evidence_weight{};               ///< factor on the evidence, b_0 of CauseSearch [-]
  double misfit_weight{};                 ///< part of evidence_weight that no misfit lowers, w_1 of CauseSearch [-]
  double severity_error{};                ///< relative error of a severity estimated by the signatures [-]
  double severity_misfit{};               ///< additional relative error of the severity if no signature fits [-]
  std::vector<Signature> signatures;      ///< signatures of the gear, with the values of `of_robots`
  std::vector<RobotSignature> of_robots;  ///< signatures of robots by cause, in ascending order of severity
  std::array<bool, SIGNATURE_SIZE> fitted{};  ///< values that the signatures contain; the search ignores the others
  std::array<double, SCALAR_COUNT>
      sound{};  ///< scalar indicators of the sound drive in the check-up, in their units; NaN: not known
  std::array<CarriedError, INDICATOR_COUNT> carried{};
  std::array<double, CAUSE_COUNT> occurrence{};  ///< rating of how often a cause occurs; 0: not rated [-]
};

/// Causes that at severity 1 change an indicator by at least `share` of its sound value, up (`sign` 1) or down (-1).
std::vector<Cause> causesThatMove(const SignatureSet& set, ScalarIndicator indicator, double sign, double share);

std::size_t patternCount(const SignatureSet& set) noexcept;  ///< number of causes that have signatures

/// The cause whose pattern has the largest score in a window.
struct PatternScore
{
  Cause cause{};     ///< NONE: no cause
  double student{};  ///< Student's t of the pattern, one-sided, with pattern_freedom of WindowResidual [-]
};

/// The differences d of a window along the pattern p of each cause. A pattern combines many small changes. The score of
/// the pattern can exceed its threshold while no single indicator exceeds the threshold of indicators.
///
/// Law:   t = p' C^-1 d / sqrt(p' C^-1 p),  C = D + F F',  p_i = sum_h P(h) mu_i / |mu|,  |mu|^2 = sum_i mu_i^2 / D_ii
/// where  h  goes over the signatures of the cause whose severity is nearest to 0.4; other symbols as in CauseSearch
/// Lines are excluded, because F contains little of the noise that neighbouring lines share.
class CausePatterns
{
public:
  explicit CausePatterns(std::shared_ptr<const SignatureSet> set);

  PatternScore strongest(const WindowResidual& residual, const OperatingPoint& point) const noexcept;

private:
  std::shared_ptr<const SignatureSet> set_;
  std::array<std::vector<std::size_t>, CAUSE_COUNT> rows_;  // by cause: indices of its signatures in the set
};

/// Probability and severity of each cause, given the signals of a window.
struct CausePosterior
{
  /// Probability of each cause, given that the drive is not sound [-]. NONE: the cause is no fault with a signature.
  std::array<double, CAUSE_COUNT> probability{};
  std::array<double, CAUSE_COUNT> severity{};  ///< mean severity of each fault, if this fault is the cause [-]
  std::array<double, CAUSE_COUNT> severity_deviation{};  ///< standard deviation of the severity [-]
};

/// Searches for the cause by the likelihood of a window's differences from the reference under every signature
/// (docs/indicators.md).
///
/// Law:   d ~ t_v(mu, D_h + F F'),   P(h | d) ~ P(h) p(d | h)^b,   P(h) ~ 1 + O / O_m by cause, ~ w_0 + a in a cause
///        a = exp(-(ln(n / n_h) / N)^2 / 2 - ((q - q_h) / Q)^2 / 2), 1 in ANY_MOTION
///        D_h,ii = D_ii (1 + S^2) + (r^2 + m^2 (1 - a)) mu_i^2 + (l s A_i)^2 / 2
///        b = b_0 (w_1 + (1 - w_1) / f),   f = max(1, (d - mu)' (D + F F')^-1 (d - mu) / k) of the most likely h
/// where  d, h     differences of the window; signature
///        mu, s    change by h, severity of h; each of a phase-locked line's two parts has mean 0, variance mu^2 / 2
///        D, F, v  of WindowResidual
///        O, O_m   rated occurrence of the cause, mean of the rated causes; O = O_m for unrated causes and for NONE
///        r        relative error of each value of a signature, because gears and places of the fault differ
///        S        strength of an unknown change; 0 for a signature
///        m, a     additional relative error in an unlike motion; likeness of the motions of window and signature
///        A        amplitude of the line in the sound drive; 0 if i is no part of a phase-locked line
///        l        share of A that a fault of severity 1 changes, because errors of manufacture differ. For lost motion
///                 the sound value replaces A / sqrt(2), because play depends on the original preload
///        b        factor on the evidence, because the errors of a signature's values are correlated
///        f, k     misfit of the most likely signature, number of compared values. The misfit lowers b, to b_0 w_1 at
///                 least, and widens the severity's error
///        n, q     speed and direction of the window's motion; n_h, q_h: of the signature's motion. Lines depend on the
///                 motion, because they meet resonances of the drive;  N = 0.2, Q = 0.3, w_0 = 0.001
/// Teeth, interface and grease wear together. Therefore h is also a sum of the signatures of two or three of these
/// faults in one motion. The second and third fault have the severity of the first fault, or 0.4 times this severity. A
/// sum counts for the cause of its first fault. The sums of a cause add as much prior as its single signatures have.
/// A stiffness changes by mu = c x^2 / x_h, with c the share in the signature, x the sound value in the motion of the
/// window, and x_h that of SignatureSet::sound. An eccentric encoder then changes the compliance of all drives equally.
/// The cause NONE stands for unknown changes (mu = 0, S = 3, 10, 30, 100) and, with a tenth of the prior weight, for
/// two changes outside the gear. A dragging brake adds 0.05, 0.15, 0.4 or 1 of the sound running torque to running and
/// Coulomb torque (S = 0). Noise of the sensors grows by a share g = 0.12, 0.25, 0.5 or 1: 1 + S^2 = (1 + g)^2, and the
/// kinematic error grows by the share g. The search ignores values that the signatures do not contain.
///
/// A search makes two passes over all signatures, one for their likelihoods and one for the sums over them. The caller
/// chooses into how many parts it divides the passes. Only the constructor allocates.
class CauseSearch
{
public:
  explicit CauseSearch(std::shared_ptr<const SignatureSet> set);

  std::size_t signatures() const noexcept
  {
    return 2 * likelihoods_.size();
  }  ///< number of steps of a search, which passes twice over the signatures

  void start() noexcept;  ///< begins a search for the next window
  bool isDone() const noexcept { return next_ == signatures(); }

  /// Advances the search by up to `count` signatures. `residual` and `point` must be equal in all calls of a search.
  void advance(const WindowResidual& residual, const OperatingPoint& point, std::size_t count) noexcept;

  CausePosterior posterior() const noexcept;  ///< result of the search; valid if isDone

private:
  struct Row
  {
    SignatureParts parts{};
    double prior{ 1.0 };  // prior over the prior of a single signature [-]
  };
  static std::vector<Row> rowsOf(const SignatureSet& set);
  static std::array<double, CAUSE_COUNT> priorsOf(const SignatureSet& set);

  /// Sums over the signatures of one cause.
  struct Sum
  {
    /// Adds a signature. `weighted`: logarithm of its likelihood times b of CauseSearch. `prior`: its prior.
    void add(double weighted, double prior, double severity) noexcept;

    double priors{};  // sum of the priors of single signatures
    double total{};   // sum of prior times likelihood^b
    double first{};   // sum of prior times likelihood^b times severity
    double second{};  // sum of prior times likelihood^b times severity^2
  };

  std::shared_ptr<const SignatureSet> set_;
  std::vector<Row> rows_;
  std::array<double, CAUSE_COUNT> beforehand_;  // priors of the causes, (1 + O / O_m) / 2
  // logarithms of the likelihoods, first of rows_, then of the unknown changes; times b after the first pass
  std::vector<double> likelihoods_;
  double misfit_{ 1.0 };  // misfit f of CauseSearch, valid after the first pass
  std::array<Sum, CAUSE_COUNT> sums_{};
  std::size_t next_{};
};
}  // namespace hjt
