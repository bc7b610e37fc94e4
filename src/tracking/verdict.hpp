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
/// Increase of a joint's friction over its own that a verdict ignores, however certain it is [-]. The bound for a
/// decrease is twice as wide, because no fault takes away a fifth of the friction.
constexpr double MORE_THAN_OWN = 0.05;
constexpr double LESS_THAN_OWN = 0.10;

/// Reference with which the friction of a joint is compared.
enum class FrictionReference : std::uint8_t
{
  TWIN,
  CONTROLLER,  ///< friction that the arm's controller expects
  OWN          ///< own friction of the joint when it was sound
};

const char* referenceName(FrictionReference reference) noexcept;  ///< "controller"

/// Friction of a joint as a multiple of its reference, with an interval (docs/compare.md).
struct FrictionFactor
{
  double value{
    std::numeric_limits<double>::quiet_NaN()
  };                   ///< friction factor; NaN: the rows do not show the friction [-]
  double deviation{};  ///< standard deviation of the factor's logarithm [-]
  double scatter{};    ///< part of `deviation` by the scatter of the rows [-]
  FrictionReference reference{ FrictionReference::TWIN };
  bool is_below_faults{};          ///< the joint has less friction than any fault leaves
  Reason reason{ Reason::SOUND };  ///< reason why the friction is not judged; SOUND: it is judged
  std::string why_not;             ///< the same reason as a sentence; empty: the friction is judged

  bool isJudged() const { return reason == Reason::SOUND; }
  /// Ends of the 95 % interval.
  double low() const { return value * std::exp(-halfWidth()); }
  double high() const { return value * std::exp(halfWidth()); }

private:
  double halfWidth() const { return NORMAL_95 * deviation; }
};

/// Reference of a joint from its own recordings when it was sound.
struct OwnReference
{
  std::vector<FrictionPoint> friction;  ///< measured friction by speed; empty: not known
  double compliance_ratio{ std::numeric_limits<double>::quiet_NaN() };  ///< NaN: not known
  double temperature{
    std::numeric_limits<double>::quiet_NaN()
  };                              ///< temperature of the recordings; NaN: not known [degC]
  double friction_deviation{};    ///< standard deviation of the friction by the scatter of the rows, as a share [-]
  std::size_t recordings{ 1 };    ///< number of recordings that show the friction
  double recordings_deviation{};  ///< standard deviation of the friction from recording to recording, as a share [-]
  bool is_unjudged{};             ///< true: there are recordings, but none shows the joint's friction
};

/// What a verdict on a joint needs besides its evidence.
struct JointContext
{
  OwnReference own;
  bool is_identified{};   ///< the twin's friction was identified by recordings of this joint
  bool has_controller{};  ///< true: without `own` the reference is the friction that the arm's controller expects
  /// Common factor of the joints' friction divided by that of the reference [-]. Its cause is temperature or gain, not
  /// a fault.
  double arm_friction{ 1.0 };
  Misfit misfit{};  ///< why the rows of the joint are not judged
  /// Standard deviation of the logarithm of `arm_friction` [-]; 0: other joints of the group confirm the factor.
  double arm_deviation{ UNWITNESSED };
  FittedFriction fitted{};
};

/// Level of a verdict. The numbers are those of Verdict.msg, the first three also those of HealthLevel.
enum class VerdictLevel : std::uint8_t
{
  OK = 0,
  WARN = 1,
  ERROR = 2,
  NOT_JUDGED = 3
};

const char* levelName(VerdictLevel level) noexcept;  ///< "WARN", "NOT JUDGED"

/// The level as a HealthLevel; OK if nothing was judged.
inline HealthLevel severityOf(VerdictLevel level)
{
  return level == VerdictLevel::NOT_JUDGED ? HealthLevel::OK : static_cast<HealthLevel>(level);
}

/// Numbers on which a verdict is based.
enum class Figure : std::uint8_t
{
  ROWS,                    ///< number of all rows
  TOUCHED_ROWS,            ///< number of rows that do not count, because something touched the arm
  SPAN,                    ///< time from the first to the last row [s]
  CURRENT,                 ///< measured current, rms [A]
  CURRENT_PREDICTED,       ///< predicted current, rms [A]
  CURRENT_RESIDUAL,        ///< measured - predicted current, rms [A]
  CURRENT_UNEXPLAINED,     ///< residual without the best constant and the best multiple of the friction, rms [A]
  LEAST_LOAD,              ///< least load [N.m]
  MOST_LOAD,               ///< largest load [N.m]
  TEMPERATURE,             ///< mean temperature of the rows [degC]
  REFERENCE_TEMPERATURE,   ///< temperature of the joint's own reference [degC]
  HIGHEST_ORDER,           ///< highest order per turn of the motor that the rows resolve at the highest speed [-]
  SPEEDS,                  ///< number of speeds at which the friction was measured [-]
  LOWEST_SPEED,            ///< lowest speed with a friction point, with its sign [rad/s]
  HIGHEST_SPEED,           ///< highest speed with a friction point, with its sign [rad/s]
  FRICTION_OF_TWIN,        ///< friction over the twin's friction [-]
  FRICTION_OF_CONTROLLER,  ///< friction over the friction that the arm's controller expects [-]
  FRICTION_OF_OWN,         ///< friction over the joint's own friction when it was sound [-]
  FRICTION_OF_ARM,         ///< common factor of the friction of all joints of the arm [-]
  FRICTION_SCATTER,        ///< standard deviation of the friction's logarithm by the scatter of the rows [-]
  FRICTION_LOWEST,         ///< lowest friction of a sound joint, over the reference [-]
  FRICTION_HIGHEST,        ///< highest friction of a sound joint, over the reference [-]
  TORSION_OF_TWIN,         ///< torsion over the twin's torsion [-]
  TORSION_OF_OWN,          ///< torsion over the drive's own torsion when it was sound [-]
  TORSION_TOLERANCE,       ///< largest deviation of a sound drive's torsion from 1 [-]
  ENCODER_SHARE,           ///< part of the tolerance of the torsion for eccentric encoders [-]
  ENCODER_ERROR,  ///< error of the output encoder once a turn that would have the effect of the found torsion [rad]
  ENCODER_ECCENTRICITY,    ///< configured eccentricity of the output encoder [rad]
  WINDOWS,                 ///< number of windows of the signals that were compared [-]
  WINDOWS_HERE,            ///< number of windows at one operating point, if there are too few [-]
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
  double weight{};  ///< share of the windows in alarm that name the cause, or an equal share for each cause [-]
};

/// Quantities of a joint on which a verdict has findings.
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
  Reason reason{};                    ///< reason of the level; SOUND at level OK
  std::vector<WeightedCause> causes;  ///< faults with the effect that was found; empty at level OK
};

/// Friction of a joint over its reference, and in an arm also over the common factor of the joints.
struct JudgedFriction
{
  double factor{ std::numeric_limits<double>::quiet_NaN() };  ///< friction over the reference; NaN: not measured [-]
  double lower{ std::numeric_limits<double>::quiet_NaN() };   ///< lower end of the interval of `factor` [-]
  double upper{ std::numeric_limits<double>::quiet_NaN() };   ///< upper end of the interval of `factor` [-]
  bool has_interval{};
};

/// Verdict on a measured joint: its findings as data. `verdictText` and `findingText` turn them into sentences.
struct Verdict
{
  Verdict() { figures.fill(std::numeric_limits<double>::quiet_NaN()); }

  bool isJudged() const { return level != VerdictLevel::NOT_JUDGED; }
  double operator[](Figure figure) const { return figures[static_cast<std::size_t>(figure)]; }  ///< NaN: not known
  /// Changes all findings and the verdict to NOT_JUDGED.
  void dismiss(const Misfit& why_not);
  double& operator[](Figure figure) { return figures[static_cast<std::size_t>(figure)]; }

  VerdictLevel level{ VerdictLevel::NOT_JUDGED };
  Reason reason{ Reason::NO_STEADY_MOTION };  ///< reason of the worst finding, or of the first if none is judged
  std::string joint;
  JudgedFriction friction;
  std::string friction_text;             ///< sentences on the friction, or on why it is not judged
  std::vector<Finding> findings;         ///< findings on friction, torsion and signals
  std::vector<Evidence> evidence;        ///< evidence of the worst window of the signals, the strongest evidence first
  std::vector<std::string> cannot_show;  ///< sentences on what these rows cannot show
  bool may_be_gain{};                    ///< a wrong gain could have the effect of the friction that departs
  bool fits{ true };                     ///< false: nothing is judged, because telemetry or load are wrong
  std::string misfit;                    ///< clause that says why nothing is judged; empty: no such reason
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

// Functions that return sentences for messages and documents.
std::string verdictText(const Verdict& verdict);
std::string findingText(const Verdict& verdict, const Finding& finding);
/// Sentences on what the rows of the evidence cannot show. `verdict` must have its figures already.
std::vector<std::string> cannotShow(const JointEvidence& evidence, const Verdict& verdict);

/// Sentence on the causes of a finding; empty: no signatures of faults are known.
std::string possibleFaults(const Verdict& verdict, const Finding& finding);

/// Makes a sentence of a clause.
std::string sentence(std::string clause);

/// WARN if the magnitude of `deviation` exceeds `tolerance`, ERROR if it exceeds `tolerance` times `error_factor`.
VerdictLevel levelOf(double deviation, double tolerance, double error_factor);

Verdict judge(const JointEvidence& evidence, const JointContext& context);

/// One word for the source of a joint's temperature.
inline const char* temperatureSource(const JointEvidence& evidence)
{
  return evidence.isTemperatureReceived() ? "received" : "configured";
}

/// Friction of the rows as a multiple of its reference. The evidence must outlive the result.
MeasuredFriction measuredFriction(const JointEvidence& evidence, const JointContext& context);

/// "1.18 [1.05, 1.32]"
std::string factorText(const FrictionFactor& factor);
std::string factorText(const JudgedFriction& friction);

/// Whether the friction that the arm's controller expects can be the reference: it agrees with that of most joints, so
/// it belongs to sound joints.
bool controllerIsReference(const std::vector<const JointEvidence*>& joints);

/// Standard deviation of a sound joint's friction from its own earlier friction, as a share, apart from the common
/// factor of its group [-]. `friction`: friction of the joint [N.m].
double repeatOfOwn(double friction);

/// Friction factor of the rows in the evidence.
FrictionFactor frictionFactor(const JointEvidence& evidence, const JointContext& context);

/// Friction of a sound joint in one recording.
struct SoundFriction
{
  std::vector<FrictionPoint> points;
  double deviation{};  ///< standard deviation of the friction by the scatter of the rows, as a share [-]
};

/// Makes a reference of several recordings: mean friction at each speed, and difference between the recordings. Without
/// recordings the reference is empty.
OwnReference ownReference(const std::vector<SoundFriction>& recordings);

/// Judges the friction: WARN if its whole interval lies beyond the bound. Sets factor, text and figures of the verdict.
Finding judgeFriction(const JointEvidence& evidence, const JointContext& context, Verdict& verdict);

/// Adds the faults that move the indicator in the direction `way`, +1 or -1, to the causes of the finding.
void nameCauses(const JointEvidence& evidence, ScalarIndicator indicator, double way, Finding& finding);

/// Clause that says how the load may be wrong.
const char* wrongLoad(LoadOrigin load);

/// Distinguishes a wrong gain of the current from a change of friction. With a wrong gain the current for load and
/// inertia departs from the prediction by the same factor as that for friction.
struct GainEvidence
{
  explicit GainEvidence(const JointEvidence& evidence)
    : load(evidence.loadFactor()), friction(evidence.friction().ratio().value)
  {
  }

  /// Whether only the friction departs, so that the gain is right.
  bool isExcluded() const
  {
    return load.value > 0.0 && !isAlike() && std::abs(load.value - friction) > DEVIATIONS * load.uncertainty;
  }

  /// Whether the factor of the friction is nearer to that of the load than to 1. If not, a wrong load is as likely.
  bool isOfFriction() const { return std::abs(std::log(load.value / friction)) < std::abs(std::log(friction)); }

  /// Misfit by a wrong gain; none if both factors differ, or if the load is too small to show its factor.
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
