// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/number_text.hpp"
#include "base/statistics.hpp"
#include "tracking/common_friction.hpp"
#include "tracking/joint_evidence.hpp"
#include "tracking/reason.hpp"

namespace hjt
{
/// Change of a joint's friction from its own that a verdict ignores, however certain it is. The bound for less friction
/// is twice as wide, since no fault takes away a fifth of the friction.
constexpr double MORE_THAN_OWN = 0.05;
constexpr double LESS_THAN_OWN = 0.10;

/// Reference of which the friction of a joint is a multiple.
enum class FrictionReference : std::uint8_t
{
  TWIN,
  CONTROLLER,  ///< the friction that the arm's controller expects
  OWN          ///< the joint's own friction when it was sound
};

const char* referenceName(FrictionReference reference) noexcept;  ///< "controller"

/// Friction of a joint as a multiple of its reference, with its uncertainty (docs/compare.md).
struct FrictionFactor
{
  double value{
    std::numeric_limits<double>::quiet_NaN()
  };                   ///< the friction factor; NaN: the rows do not show the friction
  double deviation{};  ///< standard deviation of the factor's logarithm [-]
  double scatter{};    ///< part of `deviation` by the rows' scatter [-]
  FrictionReference reference{ FrictionReference::TWIN };
  bool is_below_faults{};          ///< the friction is less than any fault leaves
  Reason reason{ Reason::SOUND };  ///< why the friction is not judged; SOUND: it is judged
  std::string why_not;             ///< that reason in a sentence; empty: the friction is judged

  bool isJudged() const { return reason == Reason::SOUND; }
  /// Ends of the 95 % interval.
  double low() const { return value * std::exp(-halfWidth()); }
  double high() const { return value * std::exp(halfWidth()); }

private:
  double halfWidth() const { return NORMAL_95 * deviation; }
};

/// Figures of the same joint when it was sound.
struct OwnReference
{
  std::vector<FrictionPoint> friction;  ///< measured friction by speed; empty: not known
  double compliance_ratio{ std::numeric_limits<double>::quiet_NaN() };  ///< NaN: not known
  double temperature{
    std::numeric_limits<double>::quiet_NaN()
  };                              ///< temperature of the recordings; NaN: not known [degC]
  double friction_deviation{};    ///< standard deviation of the friction by its scatter, as a share [-]
  std::size_t recordings{ 1 };    ///< number of recordings of the friction
  double recordings_deviation{};  ///< standard deviation from one recording to the next, as a share [-]
  bool is_unjudged{};             ///< there is a recording, but it did not show the joint's friction
};

/// What a verdict on a joint uses beside its evidence.
struct JointContext
{
  OwnReference own;
  bool is_identified{};  ///< the twin's friction was identified from this joint
  bool
      has_controller{};  ///< without `own` the friction is compared with the friction that the arm's controller expects
  /// Common factor of the joints' friction divided by that of the reference [-]. Its cause is temperature or gain, not
  /// a fault.
  double arm_friction{ 1.0 };
  Misfit misfit{};  ///< why the rows of the joint are not judged
  /// Standard deviation of the logarithm of `arm_friction`; 0 if the other joints of the group confirm the factor.
  double arm_deviation{ UNWITNESSED };
  FittedFriction fitted{};
};

/// Numbers are those of Verdict.msg; the first three those of HealthLevel.
enum class VerdictLevel : std::uint8_t
{
  OK = 0,
  WARN = 1,
  ERROR = 2,
  NOT_JUDGED = 3
};

const char* levelName(VerdictLevel level) noexcept;  ///< "WARN", "NOT JUDGED"

/// The level as a HealthLevel, which is OK where nothing was judged.
inline HealthLevel severityOf(VerdictLevel level)
{
  return level == VerdictLevel::NOT_JUDGED ? HealthLevel::OK : static_cast<HealthLevel>(level);
}

/// A number behind a verdict.
enum class Figure : std::uint8_t
{
  ROWS,                    ///< all rows
  TOUCHED_ROWS,            ///< rows left out because something touched the arm
  SPAN,                    ///< time from the first to the last row [s]
  CURRENT,                 ///< measured current, rms [A]
  CURRENT_PREDICTED,       ///< predicted current, rms [A]
  CURRENT_RESIDUAL,        ///< measured less predicted current, rms [A]
  CURRENT_UNEXPLAINED,     ///< residual less the best constant and the best multiple of the friction, rms [A]
  LEAST_LOAD,              ///< least load [N.m]
  MOST_LOAD,               ///< largest load [N.m]
  TEMPERATURE,             ///< mean temperature of the rows [degC]
  REFERENCE_TEMPERATURE,   ///< temperature of the joint's own reference [degC]
  HIGHEST_ORDER,           ///< order of the motor's turn that the rows resolve at the highest speed [-]
  SPEEDS,                  ///< number of speeds at which the friction was measured [-]
  LOWEST_SPEED,            ///< lowest of these speeds, with its sign [rad/s]
  HIGHEST_SPEED,           ///< highest of these speeds, with its sign [rad/s]
  FRICTION_OF_TWIN,        ///< friction over the twin's [-]
  FRICTION_OF_CONTROLLER,  ///< friction over the friction that the arm's controller expects [-]
  FRICTION_OF_OWN,         ///< friction over the joint's own when it was sound [-]
  FRICTION_OF_ARM,         ///< common factor of the friction of all joints of the arm [-]
  FRICTION_SCATTER,        ///< standard deviation of the friction's logarithm by the scatter of the rows [-]
  FRICTION_LOWEST,         ///< lowest friction of a sound joint, over the reference [-]
  FRICTION_HIGHEST,        ///< highest friction of a sound joint, over the reference [-]
  TORSION_OF_TWIN,         ///< torsion over the twin's [-]
  TORSION_OF_OWN,          ///< torsion over the drive's own when it was sound [-]
  TORSION_TOLERANCE,       ///< deviation from 1 that the torsion of a sound drive may have [-]
  ENCODER_SHARE,           ///< part of that tolerance for the encoders' eccentricity [-]
  ENCODER_ERROR,  ///< error of the output encoder once a turn that would have the effect of the found torsion [rad]
  ENCODER_ECCENTRICITY,    ///< configured eccentricity of the output encoder [rad]
  WINDOWS,                 ///< windows of the signals that were compared [-]
  WINDOWS_HERE,            ///< windows at one operating point, if they are too few [-]
  WINDOWS_NEEDED,          ///< windows that a verdict needs at one operating point [-]
  ALARM_TIME,              ///< time from which on the signals depart from the reference [s]
  CONTACT_SINCE,           ///< beginning of the last contact [s]
  CONTACT_LASTED,          ///< duration of the last contact [s]
  CONTACT_TORQUE,          ///< largest torque of the last contact [N.m]
  LARGEST_CONTACT_SINCE,   ///< beginning of the strongest contact [s]
  LARGEST_CONTACT_LASTED,  ///< duration of the strongest contact [s]
  LARGEST_CONTACT_TORQUE   ///< torque of the strongest contact [N.m]
};
constexpr std::size_t FIGURE_COUNT = 38;

/// A kind of fault as a possible cause.
struct WeightedCause
{
  Cause cause{};
  double weight{};  ///< share of the windows in alarm that name it, or an equal share for causes that look alike [-]
};

/// Quantities of a joint that are judged.
enum class FindingSubject
{
  FRICTION,
  TORSION,
  SIGNALS
};

const char* subjectTitle(FindingSubject subject);  ///< "Signals by windows"

struct Finding
{
  FindingSubject subject{};
  VerdictLevel level{ VerdictLevel::NOT_JUDGED };
  Reason reason{};                    ///< SOUND at level OK
  std::vector<WeightedCause> causes;  ///< faults that have this effect; none at level OK
};

/// Friction of the joint as a multiple of its FrictionReference, and in an arm of the joints' common factor too.
struct JudgedFriction
{
  double factor{ std::numeric_limits<double>::quiet_NaN() };  ///< friction over the reference's; NaN: not measured [-]
  double lower{ std::numeric_limits<double>::quiet_NaN() };   ///< lower end of its interval [-]
  double upper{ std::numeric_limits<double>::quiet_NaN() };   ///< upper end of its interval [-]
  bool has_interval{};
};

/// Verdict on a measured joint: its findings as data. `verdictText` and `findingText` make the sentences.
struct Verdict
{
  Verdict() { figures.fill(std::numeric_limits<double>::quiet_NaN()); }

  bool isJudged() const { return level != VerdictLevel::NOT_JUDGED; }
  double operator[](Figure figure) const { return figures[static_cast<std::size_t>(figure)]; }  ///< NaN: not known
  /// Changes the verdict to one in which nothing is judged.
  void dismiss(const Misfit& why_not);
  double& operator[](Figure figure) { return figures[static_cast<std::size_t>(figure)]; }

  VerdictLevel level{ VerdictLevel::NOT_JUDGED };
  Reason reason{ Reason::NO_STEADY_MOTION };  ///< reason of the worst finding; if none is judged, of the first
  std::string joint;
  JudgedFriction friction;
  std::string friction_text;             ///< sentences on the friction, or why it is not judged
  std::vector<Finding> findings;         ///< findings on friction, torsion and signals
  std::vector<Evidence> evidence;        ///< evidence of the worst window of the signals, strongest first
  std::vector<std::string> cannot_show;  ///< sentences on what these rows cannot show
  bool may_be_gain{};                    ///< a wrong gain would show like the friction that departs
  bool fits{ true };                     ///< false: telemetry or load are why nothing is judged
  std::string misfit;                    ///< clause on why nothing is judged; empty: none
  LoadOrigin load{};
  bool is_reference_given{};  ///< whether the signals have a given reference
  bool has_signatures{};      ///< signatures of faults are known, so that causes can be named
  std::array<double, FIGURE_COUNT> figures{};
};

/// Causes of all findings, each kind of fault once, the one with the largest weight first.
std::vector<WeightedCause> causesOf(const Verdict& verdict);

/// A number with its name and unit.
struct NamedFigure
{
  std::string name;
  double value;
  const char* unit;
};

/// The known figures of a verdict, and the indicators of its evidence with their sound values.
std::vector<NamedFigure> evidenceOf(const Verdict& verdict);

// Sentences for people and documents.
std::string verdictText(const Verdict& verdict);
std::string findingText(const Verdict& verdict, const Finding& finding);
/// The rows of the evidence cannot show these things. `verdict`: with its figures.
std::vector<std::string> cannotShow(const JointEvidence& evidence, const Verdict& verdict);

/// Sentence on the causes of a finding; empty: without signatures of faults nothing is known of them.
std::string possibleFaults(const Verdict& verdict, const Finding& finding);

/// A clause as a sentence.
std::string sentence(std::string clause);

/// WARN if the magnitude of `deviation` is larger than `tolerance`, ERROR if it is larger than `error_factor` times
/// that.
VerdictLevel levelOf(double deviation, double tolerance, double error_factor);

Verdict judge(const JointEvidence& evidence, const JointContext& context);

/// Source of the temperature of a joint, in a word.
inline const char* temperatureSource(const JointEvidence& evidence)
{
  return evidence.isTemperatureReceived() ? "received" : "configured";
}

/// Friction of the rows as a multiple of its FrictionReference. The evidence must outlive the result.
MeasuredFriction measuredFriction(const JointEvidence& evidence, const JointContext& context);

/// "1.18 [1.05, 1.32]"
std::string factorText(const FrictionFactor& factor);
std::string factorText(const JudgedFriction& friction);

/// Whether the friction that an arm's controller expects can be the reference: the friction of most joints agrees with
/// it, so that it is that of sound joints.
bool controllerIsReference(const std::vector<const JointEvidence*>& joints);

/// Standard deviation of a sound joint's friction from its own earlier friction, apart from the common factor of its
/// group, as a share [-]. `friction` [N.m]
double repeatOfOwn(double friction);

/// Friction factor of the rows in the evidence.
FrictionFactor frictionFactor(const JointEvidence& evidence, const JointContext& context);

/// Friction of a sound joint in one recording.
struct SoundFriction
{
  std::vector<FrictionPoint> points;
  double deviation{};  ///< standard deviation by the scatter of the rows, as a share [-]
};

/// Reference of several recordings: the mean friction at each speed, and how much the recordings differ. Without
/// recordings the reference is not known.
OwnReference ownReference(const std::vector<SoundFriction>& recordings);

/// Judges the friction: WARN if the whole interval lies beyond the bound. Puts factor, text and figures into the
/// verdict.
Finding judgeFriction(const JointEvidence& evidence, const JointContext& context, Verdict& verdict);

/// Adds the faults that move the indicator in the direction `way`, +1 or -1, to the finding.
void nameCauses(const JointEvidence& evidence, ScalarIndicator indicator, double way, Finding& finding);

/// Clause on a load that does not fit the joint.
const char* wrongLoad(LoadOrigin load);

/// Distinguishes a wrong gain of the current from friction. With a wrong gain the current of load and inertia departs
/// from the prediction by the same factor as the friction does.
struct GainEvidence
{
  explicit GainEvidence(const JointEvidence& evidence)
    : load(evidence.loadFactor()), friction(evidence.friction().ratio().value)
  {
  }

  /// The friction departs alone, so the gain is right.
  bool isExcluded() const
  {
    return load.value > 0.0 && !isAlike() && std::abs(load.value - friction) > DEVIATIONS * load.uncertainty;
  }

  /// The factor of the friction is nearer to that of the load than to 1. If not, another load is as likely as a gain.
  bool isOfFriction() const { return std::abs(std::log(load.value / friction)) < std::abs(std::log(friction)); }

  /// Misfit by a wrong gain; none: both factors do not depart alike, or the load tells too little.
  Misfit misfit() const
  {
    constexpr double NOTEWORTHY = 0.2;  // gains of one type differ by less
    if (!(load.value > 0.0 && isAlike()) ||
        std::abs(load.value - 1.0) < std::max(NOTEWORTHY, DEVIATIONS * load.uncertainty))
    {
      return {};
    }
    return { Reason::EFFORT_UNIT, "the current is " + roundedText(load.value, 2) +
                                      " times what load and inertia take, and " + roundedText(friction, 2) +
                                      " times what friction takes: not the friction but the gain "
                                      "(telemetry.torque_per_current) or the unit is not as configured" };
  }

  FittedFactor load;
  double friction;

private:
  static constexpr double DEVIATIONS = 3.0;

  bool isAlike() const
  {
    constexpr double ALIKE = 1.25;
    return std::abs(std::log(load.value / friction)) < std::log(ALIKE);
  }
};
}  // namespace hjt
