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
constexpr double LEAST_MOTION = 0.02;  ///< a joint whose angles differ by less does not move [rad]

/// Bound of a joint's own friction: a smaller change is of no interest however certain. Less friction counts half as
/// much, since no fault takes a fifth of it.
constexpr double MORE_THAN_OWN = 0.05;
constexpr double LESS_THAN_OWN = 0.10;

/// What the friction of a joint is a multiple of.
enum class FrictionReference : std::uint8_t
{
  TWIN,
  CONTROLLER,  ///< what the arm's controller expects
  OWN          ///< its own when it was sound
};

const char* referenceName(FrictionReference reference) noexcept;  ///< "controller"

/// Friction of a joint as a multiple of its reference, with what is known of its error
/// (docs/compare.md).
struct FrictionFactor
{
  double value{ std::numeric_limits<double>::quiet_NaN() };  ///< NaN: the rows show none
  double deviation{};                                        ///< standard deviation of its logarithm [-]
  double scatter{};                                          ///< the part of it that the rows' scatter makes [-]
  FrictionReference reference{ FrictionReference::TWIN };
  bool is_below_faults{};          ///< less than any fault leaves of it
  Reason reason{ Reason::SOUND };  ///< why it is not judged; SOUND: it is
  std::string why_not;             ///< the same in a sentence; empty: it is judged

  bool isJudged() const { return reason == Reason::SOUND; }
  /// Ends of the 95 % interval.
  double low() const { return value * std::exp(-halfWidth()); }
  double high() const { return value * std::exp(halfWidth()); }

private:
  double halfWidth() const { return NORMAL_95 * deviation; }
};

/// Figures of the same joint in sound condition.
struct OwnReference
{
  std::vector<FrictionPoint> friction;                                  ///< none: not known
  double compliance_ratio{ std::numeric_limits<double>::quiet_NaN() };  ///< NaN: not known
  double temperature{ std::numeric_limits<double>::quiet_NaN() };       ///< judged at; NaN: not known [degC]
  double friction_deviation{};    ///< of the friction, by its scatter, standard deviation as a share [-]
  std::size_t recordings{ 1 };    ///< that it is of
  double recordings_deviation{};  ///< standard deviation of one of them, as a share [-]
  bool is_unjudged{};             ///< there is a recording, but it did not show the joint's friction
};

/// Context of a joint besides its samples.
struct JointContext
{
  OwnReference own;
  bool is_identified{};   ///< the twin's friction is that of this joint
  bool has_controller{};  ///< without `own` the friction is held against what the arm's controller expects
  /// Multiple of the reference's friction by what the joints of an arm have in common: temperature or gain, no fault.
  double arm_friction{ 1.0 };
  Misfit misfit{};  ///< of its rows
  /// Of `arm_friction`, standard deviation of its logarithm; 0: the joints of its group are its witnesses.
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

/// How bad: OK where nothing was judged.
inline HealthLevel severityOf(VerdictLevel level)
{
  return level == VerdictLevel::NOT_JUDGED ? HealthLevel::OK : static_cast<HealthLevel>(level);
}

/// A number that a verdict rests on.
enum class Figure : std::uint8_t
{
  ROWS,                    ///< that count
  TOUCHED_ROWS,            ///< left out: something touched the arm
  SPAN,                    ///< of the rows [s]
  CURRENT,                 ///< measured, rms [A]
  CURRENT_PREDICTED,       ///< rms [A]
  CURRENT_RESIDUAL,        ///< measured less predicted, rms [A]
  CURRENT_UNEXPLAINED,     ///< left by the best constant and the best multiple of the friction, rms [A]
  LEAST_LOAD,              ///< [N.m]
  MOST_LOAD,               ///< [N.m]
  TEMPERATURE,             ///< judged at [degC]
  REFERENCE_TEMPERATURE,   ///< of the joint's own reference [degC]
  HIGHEST_ORDER,           ///< of the motor's turn that the rows resolve at the highest speed [-]
  SPEEDS,                  ///< at which the friction was measured [-]
  LOWEST_SPEED,            ///< with its sign [rad/s]
  HIGHEST_SPEED,           ///< [rad/s]
  FRICTION_OF_TWIN,        ///< over the twin's [-]
  FRICTION_OF_CONTROLLER,  ///< over what the arm's controller expects [-]
  FRICTION_OF_OWN,         ///< over the joint's own when it was sound [-]
  FRICTION_OF_ARM,         ///< common factor of all joints of the arm [-]
  FRICTION_SCATTER,        ///< standard deviation of its logarithm by the scatter of the rows [-]
  FRICTION_LOWEST,         ///< of a sound joint [-]
  FRICTION_HIGHEST,        ///< of a sound joint [-]
  TORSION_OF_TWIN,         ///< torsion over the twin's [-]
  TORSION_OF_OWN,          ///< over the drive's own when it was sound [-]
  TORSION_TOLERANCE,       ///< by which a sound drive's may differ from 1 [-]
  ENCODER_SHARE,           ///< of the tolerance, for the encoders' eccentricity [-]
  ENCODER_ERROR,           ///< of the output encoder once a turn, that would look the same [rad]
  ENCODER_ECCENTRICITY,    ///< of the output encoder as configured [rad]
  WINDOWS,                 ///< of the signals, compared [-]
  WINDOWS_HERE,            ///< windows at one operating point, if those are too few [-]
  WINDOWS_NEEDED,          ///< at one operating point [-]
  ALARM_TIME,              ///< from which on the signals depart [s]
  CONTACT_SINCE,           ///< of the last contact [s]
  CONTACT_LASTED,          ///< [s]
  CONTACT_TORQUE,          ///< [N.m]
  LARGEST_CONTACT_SINCE,   ///< of the strongest contact [s]
  LARGEST_CONTACT_LASTED,  ///< [s]
  LARGEST_CONTACT_TORQUE   ///< [N.m]
};
constexpr std::size_t FIGURE_COUNT = 38;

const char* figureName(Figure figure) noexcept;  ///< "rows"
const char* figureUnit(Figure figure) noexcept;

/// A kind of fault and how much speaks for it.
struct WeightedCause
{
  Cause cause{};
  double weight{};  ///< of the windows in alarm that name it; of causes that cannot be told apart an equal share [-]
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
  std::vector<WeightedCause> causes;  ///< that would show like this; none at level OK
};

/// Friction of the joint: a multiple of its own when sound where that is known, else of what the controller expects or
/// of the twin's; in an arm over what all joints have in common.
struct JudgedFriction
{
  double factor{ std::numeric_limits<double>::quiet_NaN() };  ///< NaN: not measured [-]
  double lower{ std::numeric_limits<double>::quiet_NaN() };   ///< of its interval; without one the factor [-]
  double upper{ std::numeric_limits<double>::quiet_NaN() };   ///< [-]
  bool has_interval{};
};

/// Limits of a recording.
enum class Hidden
{
  TORSION,             ///< no angle of the motor
  PAYLOAD,             ///< no torque recorded, load of the arm
  LOAD,                ///< as configured
  TEMPERATURE,         ///< none received
  EARLY_FAULT,         ///< no reference
  CONTACT,             ///< rows left out
  FRICTION_FROM_LOAD,  ///< one way only
  FRICTION_OVER_SPEED,
  LOADED,  ///< the load hardly varies
  HIGH_ORDERS
};

/// Findings of a measured joint, as data: `verdictText` and `findingText` make the sentences.
struct Verdict
{
  Verdict() { figures.fill(std::numeric_limits<double>::quiet_NaN()); }

  bool isJudged() const { return level != VerdictLevel::NOT_JUDGED; }
  double operator[](Figure figure) const { return figures[static_cast<std::size_t>(figure)]; }  ///< NaN: not known
  /// Nothing is judged.
  void dismiss(const Misfit& why_not);
  double& operator[](Figure figure) { return figures[static_cast<std::size_t>(figure)]; }

  VerdictLevel level{ VerdictLevel::NOT_JUDGED };
  Reason reason{ Reason::NO_STEADY_MOTION };  ///< reason of the worst finding; if none is judged, of the first
  std::string joint;
  JudgedFriction friction;
  std::string friction_text;        ///< finding, or why it is not judged, in sentences
  std::vector<Finding> findings;    ///< none: nothing was looked at
  std::vector<Evidence> evidence;   ///< of the worst window of the signals, strongest first
  std::vector<Hidden> cannot_show;  ///< by these rows
  bool may_be_gain{};               ///< a wrong gain would show like the friction that departs
  bool fits{ true };                ///< false: telemetry or load are why nothing is judged
  std::string misfit;               ///< a clause of contact or telemetry that does not fit; empty: none
  LoadOrigin load{};
  bool is_temperature_received{};
  bool is_reference_given{};  ///< of the signals
  bool has_signatures{};      ///< of faults: causes can be named
  std::array<double, FIGURE_COUNT> figures{};
};

/// Of all findings, each kind once, the heaviest first.
std::vector<WeightedCause> causesOf(const Verdict& verdict);

/// One number with its unit.
struct NamedFigure
{
  std::string name;
  double value;
  const char* unit;
};

/// The known figures of a verdict, and the indicators of the worst window with their sound values.
std::vector<NamedFigure> evidenceOf(const Verdict& verdict);

// Sentences for people and documents.
std::string verdictText(const Verdict& verdict);
std::string findingText(const Verdict& verdict, const Finding& finding);
std::vector<std::string> hiddenTexts(const Verdict& verdict);

/// A clause as a sentence.
std::string sentence(std::string clause);

/// `deviation` as a share, beyond `tolerance`: WARN, and beyond `error_factor` times it: ERROR.
VerdictLevel levelOf(double deviation, double tolerance, double error_factor);

/// Live and offline alike.
Verdict judge(const JointEvidence& evidence, const JointContext& context);

/// Where the temperature that a joint was judged at is from, for people and documents.
inline const char* temperatureSource(const JointEvidence& evidence)
{
  return evidence.isTemperatureReceived() ? "received" : "configured";
}

/// Friction that the rows show, as a multiple of the joint's own when sound, else of the twin's. The evidence
/// must outlive it.
MeasuredFriction measuredFriction(const JointEvidence& evidence, const JointContext& context);

/// "1.18 [1.05, 1.32]"
std::string factorText(const FrictionFactor& factor);
std::string factorText(const JudgedFriction& friction);

/// Whether the friction of the joints of an arm can be held against what its controller expects: most of them agree
/// with it, and so it is that of sound joints.
bool controllerIsReference(const std::vector<const JointEvidence*>& joints);

/// By which the friction of a sound joint repeats from its own earlier one, apart from what the joints of its group
/// have in common: standard deviation as a share [-]. `friction` [N.m]
double repeatOfOwn(double friction);

/// Of the rows that the evidence holds, apart from what the joints of the arm have in common.
FrictionFactor frictionFactor(const JointEvidence& evidence, const JointContext& context);

/// Friction of a sound joint in one recording.
struct SoundFriction
{
  std::vector<FrictionPoint> points;
  double deviation{};  ///< by the scatter, standard deviation as a share [-]
};

/// Means at the speeds of all, and by how much the recordings differ. None: it is not known.
OwnReference ownReference(const std::vector<SoundFriction>& recordings);

/// WARN where the interval clears the bound. Factor, text and figures go into the verdict.
Finding judgeFriction(const JointEvidence& evidence, const JointContext& context, Verdict& verdict);

/// Faults that move the indicator that way, +1 or -1.
void nameCauses(const JointEvidence& evidence, ScalarIndicator indicator, double way, Finding& finding);

/// What to say of a load that is not the joint's.
const char* wrongLoad(LoadOrigin load);

/// How what the motion takes beside friction departs: as the friction does, then the current as a whole is another.
struct GainEvidence
{
  explicit GainEvidence(const JointEvidence& evidence)
    : load(evidence.loadFactor()), friction(evidence.friction().ratio().value)
  {
  }

  /// Friction departs alone.
  bool isExcluded() const
  {
    return load.value > 0.0 && !isAlike() && std::abs(load.value - friction) > DEVIATIONS * load.uncertainty;
  }

  /// The friction is nearer to what the load says than to the twin's; else another load is as likely.
  bool isOfFriction() const { return std::abs(std::log(load.value / friction)) < std::abs(std::log(friction)); }

  /// Both depart alike; none: they do not, or it cannot be told.
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
                                      " times what friction takes: another gain (telemetry.torque_per_current) or unit "
                                      "than configured, not friction" };
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
