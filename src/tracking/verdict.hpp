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
/// Relative increase and decrease of a joint's friction from its own earlier friction that a verdict ignores, even if
/// the change is certain [-]. The bound for a decrease is wider, because no fault takes away a fifth of the friction.
constexpr double MORE_THAN_OWN = 0.05;
constexpr double LESS_THAN_OWN = 0.10;

/// Reference with which the friction of a joint is compared.
enum class FrictionReference : std::uint8_t
{
  TWIN,
  CONTROLLER,  ///< friction that the arm's controller expects
  OWN          ///< friction of this joint when the joint was sound
};

const char* referenceName(FrictionReference reference) noexcept;  ///< name in files, for example "controller"

/// Measured friction of a joint over the friction of its reference, with an interval (docs/compare.md).
struct FrictionFactor
{
  double value{
    std::numeric_limits<double>::quiet_NaN()
  };                   ///< friction factor; NaN: the rows do not show the friction [-]
  double deviation{};  ///< standard deviation of the factor's logarithm [-]
  double scatter{};    ///< part of `deviation` by the scatter of the rows [-]
  FrictionReference reference{ FrictionReference::TWIN };
  bool is_below_faults{};          ///< whether the joint has less friction than any fault leaves
  Reason reason{ Reason::SOUND };  ///< reason why the friction is not judged; SOUND: it is judged
  std::string why_not;             ///< `reason` as a sentence; empty: the friction is judged

  bool isJudged() const { return reason == Reason::SOUND; }
  double low() const { return value * std::exp(-halfWidth()); }  ///< lower end of the 95 % interval
  double high() const { return value * std::exp(halfWidth()); }  ///< upper end of the 95 % interval

private:
  double halfWidth() const { return NORMAL_95 * deviation; }
};

/// Reference of a joint from its own recordings when it was sound.
struct OwnReference
{
  std::vector<FrictionPoint> friction;  ///< measured friction at each speed; empty: not known
  double compliance_ratio{ std::numeric_limits<double>::quiet_NaN() };  ///< torsion over the twin's; NaN: not known [-]
  double temperature{
    std::numeric_limits<double>::quiet_NaN()
  };                              ///< temperature of the recordings; NaN: not known [degC]
  double friction_deviation{};    ///< relative standard deviation of the friction by the scatter of the rows [-]
  std::size_t recordings{ 1 };    ///< number of recordings that show the friction
  double recordings_deviation{};  ///< relative standard deviation of the friction between recordings [-]
  bool is_unjudged{};             ///< whether recordings were given, but none of them shows the joint's friction
};

/// Values that a verdict on a joint needs in addition to the joint's evidence.
struct JointContext
{
  OwnReference own;
  bool is_identified{};   ///< whether the twin's friction was identified from recordings of this joint
  bool has_controller{};  ///< whether the friction that the controller expects is the reference without `own`
  /// Common friction factor of the joints [-]. Its cause is temperature or gain, not a fault.
  double arm_friction{ 1.0 };
  Misfit misfit{};  ///< why the rows of the joint are not judged; empty: they are judged
  /// Standard deviation of the logarithm of `arm_friction` [-]; 0: other joints of the group confirm the factor.
  double arm_deviation{ UNWITNESSED };
  FittedFriction fitted{};
};

/// Level of a verdict. The numbers are those of Verdict.msg. OK, WARN and ERROR have the same numbers in HealthLevel.
enum class VerdictLevel : std::uint8_t
{
  OK = 0,
  WARN = 1,
  ERROR = 2,
  NOT_JUDGED = 3
};

const char* levelName(VerdictLevel level) noexcept;  ///< name, for example "WARN" or "NOT JUDGED"

/// The level as a HealthLevel; NOT_JUDGED becomes OK.
inline HealthLevel severityOf(VerdictLevel level)
{
  return level == VerdictLevel::NOT_JUDGED ? HealthLevel::OK : static_cast<HealthLevel>(level);
}

/// Numbers that a verdict is based on.
enum class Figure : std::uint8_t
{
  ROWS,                    ///< number of all rows
  TOUCHED_ROWS,            ///< number of rows that do not count, because something touched the arm
  SPAN,                    ///< time from the first to the last row [s]
  CURRENT,                 ///< measured current, rms [A]
  CURRENT_PREDICTED,       ///< predicted current, rms [A]
  CURRENT_RESIDUAL,        ///< measured - predicted current, rms [A]
  CURRENT_UNEXPLAINED,     ///< JointEvidence::unexplainedRms() [A]
  LEAST_LOAD,              ///< least load [N.m]
  MOST_LOAD,               ///< largest load [N.m]
  TEMPERATURE,             ///< mean temperature of the rows [degC]
  REFERENCE_TEMPERATURE,   ///< temperature of the joint's own reference [degC]
  HIGHEST_ORDER,           ///< highest order per turn of the motor that the rows resolve at the highest speed [-]
  SPEEDS,                  ///< number of speeds at which the friction was measured [-]
  LOWEST_SPEED,            ///< lowest speed with a friction point, with its sign [rad/s]
  HIGHEST_SPEED,           ///< highest speed with a friction point, with its sign [rad/s]
  FRICTION_OF_TWIN,        ///< measured friction over the twin's friction [-]
  FRICTION_OF_CONTROLLER,  ///< measured friction over the friction that the arm's controller expects [-]
  FRICTION_OF_OWN,         ///< measured friction over the joint's friction when it was sound [-]
  FRICTION_OF_ARM,         ///< common factor of the friction of all joints of the arm [-]
  FRICTION_SCATTER,        ///< standard deviation of the friction's logarithm by the scatter of the rows [-]
  FRICTION_LOWEST,         ///< lowest friction over the reference's friction that counts as sound [-]
  FRICTION_HIGHEST,        ///< highest friction over the reference's friction that counts as sound [-]
  TORSION_OF_TWIN,         ///< measured torsion over the twin's torsion [-]
  TORSION_OF_OWN,          ///< TORSION_OF_TWIN over its value when this drive was sound [-]
  TORSION_TOLERANCE,       ///< largest deviation from 1 of the torsion over its reference that counts as sound [-]
  ENCODER_SHARE,           ///< part of TORSION_TOLERANCE that eccentric encoders need [-]
  ENCODER_ERROR,           ///< once-per-turn error of the output encoder that would look like the found torsion [rad]
  ENCODER_ECCENTRICITY,    ///< configured eccentricity of the output encoder [rad]
  WINDOWS,                 ///< number of windows of the signals that were compared with the reference [-]
  WINDOWS_HERE,            ///< number of windows at one operating point, if too few for a verdict [-]
  WINDOWS_NEEDED,          ///< number of windows at one operating point that a verdict needs [-]
  ALARM_TIME,              ///< time from which on the signals differ from the reference [s]
  CONTACT_SINCE,           ///< beginning of the last contact [s]
  CONTACT_LASTED,          ///< duration of the last contact [s]
  CONTACT_TORQUE,          ///< largest torque of the last contact [N.m]
  LARGEST_CONTACT_SINCE,   ///< beginning of the strongest contact [s]
  LARGEST_CONTACT_LASTED,  ///< duration of the strongest contact [s]
  LARGEST_CONTACT_TORQUE   ///< largest torque of the strongest contact [N.m]
};
constexpr std::size_t FIGURE_COUNT = 38;

/// A kind of fault that may be the cause of a finding.
struct WeightedCause
{
  Cause cause{};
  double weight{};  ///< share of the windows in alarm with this cause; else 1 / number of the finding's causes [-]
};

/// Quantities of a joint on which a verdict has findings.
enum class FindingSubject
{
  FRICTION,
  TORSION,
  SIGNALS
};

const char* subjectTitle(FindingSubject subject);  ///< title in reports, for example "Signals by windows"

struct Finding
{
  FindingSubject subject{};
  VerdictLevel level{ VerdictLevel::NOT_JUDGED };
  Reason reason{};                    ///< reason of the level; SOUND at level OK
  std::vector<WeightedCause> causes;  ///< faults that can cause the finding; empty at level OK
};

/// Friction of a joint over the friction of its reference, in an arm divided by the common factor of the joints.
struct JudgedFriction
{
  double factor{ std::numeric_limits<double>::quiet_NaN() };  ///< friction factor; NaN: not measured [-]
  double lower{ std::numeric_limits<double>::quiet_NaN() };   ///< lower end of the interval of `factor` [-]
  double upper{ std::numeric_limits<double>::quiet_NaN() };   ///< upper end of the interval of `factor` [-]
  bool has_interval{};
};

/// Verdict on a measured joint: its findings as data. verdictText() and findingText() make sentences of the findings.
struct Verdict
{
  Verdict() { figures.fill(std::numeric_limits<double>::quiet_NaN()); }

  bool isJudged() const { return level != VerdictLevel::NOT_JUDGED; }
  double operator[](Figure figure) const { return figures[static_cast<std::size_t>(figure)]; }  ///< NaN: not known
  /// Changes all findings and the verdict to NOT_JUDGED, with the reason `why_not`.
  void dismiss(const Misfit& why_not);
  double& operator[](Figure figure) { return figures[static_cast<std::size_t>(figure)]; }

  VerdictLevel level{ VerdictLevel::NOT_JUDGED };
  Reason reason{ Reason::NO_STEADY_MOTION };  ///< reason of the worst finding; if none is judged, of the first finding
  std::string joint;
  JudgedFriction friction;
  std::string friction_text;             ///< sentences on the friction, or on why it is not judged
  std::vector<Finding> findings;         ///< findings on friction, torsion and signals
  std::vector<Evidence> evidence;        ///< evidence of the worst window of the signals, the strongest evidence first
  std::vector<std::string> cannot_show;  ///< sentences on what the rows of the joint cannot show
  bool may_be_gain{};                    ///< whether a wrong gain would explain the friction that departs
  bool fits{ true };                     ///< whether telemetry and load fit; if not, nothing is judged
  std::string misfit;                    ///< clause that says why nothing is judged; empty: see `reason`
  LoadOrigin load{};
  bool is_reference_given{};  ///< whether the user gave a reference of the signals
  bool has_signatures{};      ///< whether signatures of faults are known, so that findings can name causes
  std::array<double, FIGURE_COUNT> figures{};
};

/// Causes of all findings, each once, in the order of their weights, the largest first.
std::vector<WeightedCause> causesOf(const Verdict& verdict);

/// A number with its name and unit.
struct NamedFigure
{
  std::string name;
  double value;
  const char* unit;
};

/// The known figures of a verdict, and the indicators of its evidence with their values in a sound joint.
std::vector<NamedFigure> evidenceOf(const Verdict& verdict);

// Sentences on a verdict, and on one of its findings, for messages and reports.
std::string verdictText(const Verdict& verdict);
std::string findingText(const Verdict& verdict, const Finding& finding);
/// Sentences on what the rows of `evidence` cannot show. `verdict` must already hold its figures.
std::vector<std::string> cannotShow(const JointEvidence& evidence, const Verdict& verdict);

/// Sentence on the causes of a finding; empty: no signatures of faults are known.
std::string possibleFaults(const Verdict& verdict, const Finding& finding);

std::string sentence(std::string clause);  ///< the clause with a capital letter and a full stop

/// ERROR if |deviation| > `tolerance` x `error_factor`, otherwise WARN if |deviation| > `tolerance`, otherwise OK.
VerdictLevel levelOf(double deviation, double tolerance, double error_factor);

Verdict judge(const JointEvidence& evidence, const JointContext& context);

/// Source of a joint's temperature, as a word for messages.
inline const char* temperatureSource(const JointEvidence& evidence)
{
  return evidence.isTemperatureReceived() ? "received" : "configured";
}

/// Friction of a joint's rows, with its ratio to the friction of the reference. `evidence` must outlive the result.
MeasuredFriction measuredFriction(const JointEvidence& evidence, const JointContext& context);

/// Value with its 95 % interval, for example "1.18 [1.05, 1.32]".
std::string factorText(const FrictionFactor& factor);
std::string factorText(const JudgedFriction& friction);

/// Whether the friction that the arm's controller expects can be the reference. The condition is that it agrees with
/// the measured friction of three joints or more and of most joints, and so belongs to sound joints.
bool controllerIsReference(const std::vector<const JointEvidence*>& joints);

/// Relative standard deviation of the change of a sound joint's friction from recording to recording, apart from the
/// common factor of the joint's group [-]. `friction`: friction of the joint [N.m].
double repeatOfOwn(double friction);

/// Friction factor of the rows in the evidence.
FrictionFactor frictionFactor(const JointEvidence& evidence, const JointContext& context);

/// Friction of a sound joint in one recording.
struct SoundFriction
{
  std::vector<FrictionPoint> points;
  double deviation{};  ///< relative standard deviation of the friction by the scatter of the rows [-]
};

/// Makes a reference of several recordings of a joint: mean friction at each speed, and standard deviation between the
/// recordings. Without recordings the reference is empty.
OwnReference ownReference(const std::vector<SoundFriction>& recordings);

/// Judges the friction: WARN if its whole interval lies beyond the bound. Sets the friction's factor, text and figures.
Finding judgeFriction(const JointEvidence& evidence, const JointContext& context, Verdict& verdict);

/// Adds to the causes of `finding` the faults that move the indicator in the direction `way`, +1 or -1.
void nameCauses(const JointEvidence& evidence, ScalarIndicator indicator, double way, Finding& finding);

const char* wrongLoad(LoadOrigin load);  ///< clause that says what may be wrong with a load of this origin

/// Distinguishes a wrong gain of the current from a change of friction. With a wrong gain, the current for load and
/// inertia and the current for friction differ from their predictions by the same factor.
struct GainEvidence
{
  explicit GainEvidence(const JointEvidence& evidence)
    : load(evidence.loadFactor()), friction(evidence.friction().ratio().value)
  {
  }

  /// Whether the factors of load and friction differ significantly, so that a wrong gain does not explain the friction.
  bool isExcluded() const
  {
    return load.value > 0.0 && !isAlike() && std::abs(load.value - friction) > DEVIATIONS * load.uncertainty;
  }

  /// Whether the friction's factor is nearer to the load's factor than to 1. If not, a wrong load is as likely.
  bool isOfFriction() const { return std::abs(std::log(load.value / friction)) < std::abs(std::log(friction)); }

  /// Misfit by a wrong gain. Empty: the factors of load and friction differ, the factor of the load is near 1, or the
  /// load is too small to show a factor.
  Misfit misfit() const
  {
    constexpr double NOTEWORTHY = 0.2;  // least deviation of a gain that counts; gains of one type deviate by less [-]
    if (!(load.value > 0.0 && isAlike()) ||
        std::abs(load.value - 1.0) < std::max(NOTEWORTHY, DEVIATIONS * load.uncertainty))
    {
      return {};
    }
    return { Reason::EFFORT_UNIT, "the current is " + roundedText(load.value, 2) +
                                      " times the current that load and inertia need, and " + roundedText(friction, 2) +
                                      " times the current that friction needs: the gain "
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
