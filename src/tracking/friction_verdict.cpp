// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/verdict.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/number_text.hpp"

namespace hjt
{
namespace
{
/// Standard deviation of a sound drive's friction from one recording to the next, apart from the joints' common factor.
/// It has two parts: REPEAT_SHARE, relative to the friction [-], and REPEAT_TORQUE, which counts in small drives [N.m].
constexpr double REPEAT_SHARE = 0.03;
constexpr double REPEAT_TORQUE = 0.22;

/// As REPEAT_SHARE [-] and REPEAT_TORQUE [N.m], if the other joints of the drive's group confirm the common factor.
constexpr double WITNESSED_SHARE = 0.025;
constexpr double WITNESSED_TORQUE = 0.1;

/// Relative standard deviation of the load: 2 % by the masses of the links and 5 % by the gain [-].
constexpr double LOAD_SHARE = 0.054;

/// Relative standard deviation of the friction that a controller expects of a sound joint [-].
constexpr double CONTROLLER_SHARE = 0.05;

constexpr double LEAST_OF_FAULTS = 0.5;  // least friction factor that a fault of severity 1 causes [-]

constexpr double NO_FRICTION = 0.1;  // friction factor below which a joint has no friction [-]

/// Largest half width of the interval of a friction factor's logarithm with which the friction can be judged [-].
constexpr double WIDEST = 0.4;

constexpr double MAX_ARM_FRICTION = 2.5;  // largest common friction factor that a change of temperature can cause [-]

constexpr std::size_t MIN_POINTS = 3;

struct ReferenceRow
{
  const char* name;
  const char* text;  // name of the reference within a sentence
  Figure figure;     // figure for friction / friction of this reference
};

/// Rows for the references, in the order of FrictionReference.
constexpr std::array<ReferenceRow, 3> REFERENCES{
  { { "twin", "the twin's", Figure::FRICTION_OF_TWIN },
    { "controller", "the friction that the arm's controller expects", Figure::FRICTION_OF_CONTROLLER },
    { "own", "this joint's own when it was sound", Figure::FRICTION_OF_OWN } }
};

/// Direction of motion, +1 or -1, in which the mean friction would push the joint along, which no drive does. 0: none.
double impossibleWay(const std::vector<FrictionPoint>& points)
{
  for (const double way : { -1.0, 1.0 })
  {
    if (FrictionPoints::meanOf(points, way).measured < 0.0)
    {
      return way;
    }
  }
  return 0.0;
}

using Gap = std::pair<Reason, std::string>;  // a reason for a missing verdict, and this reason as a sentence

/// Says why the points give no friction factor; SOUND: they give one. `is_to_own`: whether the reference is that of
/// this joint when it was sound.
Gap whyNone(const std::vector<FrictionPoint>& points, const JointEvidence& evidence, bool is_to_own)
{
  const std::string have_rows = " have at least " + std::to_string(FrictionPoints::MIN_ROWS) + " rows" +
                                (evidence.reach().touched_rows > 0 ? " without a contact" : "") +
                                (is_to_own ? " and are in the reference too" : "");
  if (points.empty() && evidence.reach().isAtRest())
  {
    return { Reason::AT_REST, "The joint does not move." };
  }
  if (points.empty() && !evidence.friction().points().empty())
  {
    return { Reason::NO_REFERENCE, "The reference has none of the speeds of this recording." };
  }
  if (points.empty())
  {
    return { Reason::NO_STEADY_MOTION, "The joint never moves steadily for long enough to measure its friction." };
  }
  if (!(points.front().speed < 0.0 && points.back().speed > 0.0))
  {
    return { Reason::ONE_DIRECTION,
             "Friction and load cannot be separated, because all speeds that" + have_rows + " are in one direction." };
  }
  if (points.size() < MIN_POINTS)
  {
    return { Reason::ONE_SPEED, "Fewer than three speeds" + have_rows +
                                    ". The uncertainty of the joint's friction is therefore unknown." };
  }
  if (evidence.friction().blocks().count() < MIN_POINTS)
  {
    return { Reason::TOO_SHORT, "The joint moves steadily for less than " +
                                    fixedText(MIN_POINTS * FrictionBlocks::LENGTH, 0) +
                                    " s, which is too short to measure its friction." };
  }
  return { Reason::SOUND, "" };
}

/// Says why no drive can have this friction factor; SOUND: a drive can have the factor.
Gap whyImpossible(const FrictionFactor& factor, const std::vector<FrictionPoint>& points, LoadOrigin load)
{
  if (factor.is_below_faults && factor.value < -LEAST_OF_FAULTS)
  {
    return { Reason::EFFORT_NOT_CURRENT, "The measured friction is " + fixedText(factor.value, 2) +
                                             " times the expected friction and would push the joint along: the effort "
                                             "or the angle of this joint has the wrong sign." };
  }
  if (factor.is_below_faults && std::abs(factor.value) < NO_FRICTION)
  {
    return { Reason::NO_FRICTION,
             "The effort shows no friction (" + fixedText(factor.value, 2) +
                 " times the expected friction): the effort is a modelled or commanded torque, or something else "
                 "carries the joint." };
  }
  if (factor.is_below_faults)
  {
    return { Reason::LESS_THAN_FAULTS,
             "The friction is " + factorText(factor) +
                 " times the expected friction, less than any fault leaves: a hand leads or holds the arm, or the "
                 "gain, the ratio or a sign is not as configured." };
  }
  if (const double way = impossibleWay(points); way != 0.0)
  {
    return { Reason::LOAD_WRONG,
             std::string("In ") + (way > 0.0 ? "positive" : "negative") +
                 " motion the friction would have to push the joint along, which is impossible: " + wrongLoad(load) };
  }
  if (!(factor.high() < factor.value * std::exp(WIDEST)))
  {
    return { Reason::FRICTION_SCATTER, "The rows scatter too much to measure the friction (" + factorText(factor) +
                                           " times the expected friction): too few rows are steady, or " +
                                           wrongLoad(load) };
  }
  return { Reason::SOUND, "" };
}

/// Whether `reason` means that a joint's own rows do not show its friction, although the fit of the arm may show it.
bool isUnshown(Reason reason)
{
  return reason == Reason::NO_STEADY_MOTION || reason == Reason::NO_REFERENCE || reason == Reason::ONE_DIRECTION ||
         reason == Reason::ONE_SPEED || reason == Reason::TOO_SHORT || reason == Reason::FRICTION_SCATTER;
}

/// Relative standard deviation of the ratio of a sound joint's friction in one recording to its mean in the recordings
/// of the reference [-]. `stated`: assumed value for two recordings [-], with the weight of STATED_COUNT recordings.
double repeatDeviation(double stated, const OwnReference& own)
{
  constexpr double STATED_COUNT = 3.0;
  const auto count = static_cast<double>(own.recordings);
  const double of_one =
      (STATED_COUNT * 0.5 * stated * stated + (count - 1.0) * own.recordings_deviation * own.recordings_deviation) /
      (STATED_COUNT + count - 1.0);
  return std::sqrt(of_one * (1.0 + 1.0 / count));
}

/// Relative standard deviation, by the scatter of the rows, of the ratio of friction to the joint's own earlier
/// friction [-]: the larger of that by the jackknife over the speeds and that by the blocks of both recordings. Only
/// half of the blocks' variance counts. The other half comes from the twin, whose friction rises differently with the
/// speed than the joint's; this half is the same in both recordings.
double scatterToOwn(const FrictionRatio& ratio, const FrictionBlocks& blocks, const OwnReference& own)
{
  const double of_blocks = std::sqrt(0.5) * std::hypot(blocks.deviation(), own.friction_deviation);
  return std::max(ratio.of_points / std::max(std::abs(ratio.value), NO_FRICTION), of_blocks);
}

/// Standard deviation of the logarithm of the friction factor by all sources of its uncertainty [-].
double deviationOf(const FrictionRatio& ratio, const FrictionBlocks& blocks, const JointContext& context,
                   FrictionReference reference)
{
  const bool is_to_own = !context.own.friction.empty();
  const bool is_witnessed = is_to_own && context.arm_deviation < NO_WITNESS;
  const FrictionPoint backward = FrictionPoints::meanOf(ratio.points, -1.0);
  const FrictionPoint forward = FrictionPoints::meanOf(ratio.points, 1.0);
  const double twin = backward.twin + forward.twin;
  const double load = LOAD_SHARE * std::abs(forward.load - backward.load) / twin;
  const double stated = is_witnessed ? repeatOfOwn(0.5 * twin) : std::hypot(REPEAT_SHARE, REPEAT_TORQUE / (0.5 * twin));
  const double repeat = repeatDeviation(stated, is_to_own ? context.own : OwnReference());
  const double of_controller = reference == FrictionReference::CONTROLLER ? CONTROLLER_SHARE : 0.0;
  const double size = std::max(std::abs(ratio.value), NO_FRICTION);
  const double scatter = is_to_own ? scatterToOwn(ratio, blocks, context.own) : ratio.deviation / size;
  return std::sqrt(scatter * scatter + repeat * repeat + std::pow(load / size, 2) + of_controller * of_controller +
                   context.arm_deviation * context.arm_deviation);
}

/// Distance of (friction factor / arm_friction) from 1, over the distance at which its whole interval would lie beyond
/// the bound 1 + more or 1 - less [-]. If the result is larger than 1, the friction departs.
double departure(const FrictionFactor& factor, double arm_friction, double more, double less)
{
  const double distance = factor.value / arm_friction - 1.0;
  const double width = factor.high() / factor.value;
  return std::max(distance / ((1.0 + more) * width - 1.0), -distance / (1.0 - (1.0 - less) / width));
}
}  // namespace

double repeatOfOwn(double friction)
{
  return std::hypot(WITNESSED_SHARE, WITNESSED_TORQUE / friction);
}

std::string factorText(const FrictionFactor& factor)
{
  return factorText(JudgedFriction{ factor.value, factor.low(), factor.high(), true });
}

std::string factorText(const JudgedFriction& friction)
{
  return fixedText(friction.factor, 2) + " [" + fixedText(friction.lower, 2) + ", " + fixedText(friction.upper, 2) +
         "]";
}

const char* wrongLoad(LoadOrigin load)
{
  switch (load)
  {
    case LoadOrigin::CONFIGURED:
      break;
    case LoadOrigin::RECORDED:
      return "the load differs from the recorded load.";
    case LoadOrigin::ARM:
      return "the load is not that of the arm's links and payload, something touched the arm, or angles, stamps or "
             "currents are disturbed.";
  }
  return "the load is not as configured. Give the load of the whole arm (docs/arm.md), or record the load.";
}

const char* referenceName(FrictionReference reference) noexcept
{
  return REFERENCES[static_cast<std::size_t>(reference)].name;
}

bool controllerIsReference(const std::vector<const JointEvidence*>& joints)
{
  constexpr double AGREES = 0.2;
  constexpr std::ptrdiff_t MIN_JOINTS = 3;
  JointContext context;
  context.has_controller = true;
  const auto agrees = [&](const JointEvidence* joint)
  {
    const FrictionFactor factor = frictionFactor(*joint, context);
    return factor.isJudged() && std::abs(factor.value - 1.0) < AGREES;
  };
  const auto agree = std::count_if(joints.begin(), joints.end(), agrees);
  return agree >= MIN_JOINTS && 2 * agree > static_cast<std::ptrdiff_t>(joints.size());
}

FrictionFactor frictionFactor(const JointEvidence& evidence, const JointContext& context)
{
  const bool has_own = !context.own.friction.empty();
  FrictionFactor factor;
  factor.reference = has_own || context.is_identified ? FrictionReference::OWN :
                     context.has_controller           ? FrictionReference::CONTROLLER :
                                                        FrictionReference::TWIN;
  const FrictionRatio ratio = has_own ? evidence.friction().ratioTo(context.own.friction) :
                              factor.reference == FrictionReference::CONTROLLER ? evidence.besideController().ratio() :
                                                                                  evidence.friction().ratio();
  std::tie(factor.reason, factor.why_not) = whyNone(ratio.points, evidence, has_own);
  if (!factor.isJudged())
  {
    return factor;
  }
  factor.value = ratio.value;
  factor.deviation = deviationOf(ratio, evidence.friction().blocks(), context, factor.reference);
  factor.scatter = ratio.deviation / std::max(std::abs(ratio.value), NO_FRICTION);
  constexpr double SURE = 2.0;  // number of standard deviations by which the factor must be below 1 [-]
  factor.is_below_faults = factor.value / context.arm_friction < LEAST_OF_FAULTS &&
                           factor.value + SURE * factor.deviation * std::max(factor.value, NO_FRICTION) < 1.0;
  std::tie(factor.reason, factor.why_not) = whyImpossible(factor, ratio.points, evidence.loadOrigin());
  return factor;
}

namespace
{
/// Sentences on the friction of a joint. `verdict` must already hold the friction and its bounds.
std::string frictionText(const FrictionFactor& factor, bool is_fitted, const JointEvidence& evidence,
                         const JointContext& context, const Finding& finding, const Verdict& verdict)
{
  const double shared = context.arm_friction;
  std::string text =
      "Friction is " + factorText(verdict.friction) + " times " +
      REFERENCES[static_cast<std::size_t>(factor.reference)].text +
      (is_fitted     ? " in a fit of the currents of all joints, apart from their common factor" :
       shared == 1.0 ? "" :
                       ", apart from the common factor " + fixedText(shared, 2) + " of the arm's joints") +
      " (an interval that reaches into " + fixedText(verdict[Figure::FRICTION_LOWEST], 2) + " to " +
      fixedText(verdict[Figure::FRICTION_HIGHEST], 2) + " counts as sound).";
  if (finding.level != VerdictLevel::OK)
  {
    text += possibleFaults(verdict, finding) +
            " Other possible causes: another temperature of the grease, another preload" +
            (verdict.may_be_gain ? ", or a wrong gain, because the load varies too little to exclude it." : ".");
  }
  if (context.own.is_unjudged)
  {
    text += " The reference did not judge this joint's friction, so the program compares it with the twin's friction.";
  }
  text += " The joint has " + fixedText(evidence.temperature(), 0) + " degC (" + temperatureSource(evidence) + ")";
  text += std::isfinite(context.own.temperature) ?
              ", the reference " + fixedText(context.own.temperature, 0) +
                  " degC; the twin's law of friction compensates for the difference." :
              ".";
  return verdict[Figure::SPEEDS] > 0.0 ?
             text + " Its friction was measured at " + fixedText(verdict[Figure::SPEEDS], 0) + " speeds from " +
                 fixedText(verdict[Figure::LOWEST_SPEED], 2) + " to " + fixedText(verdict[Figure::HIGHEST_SPEED], 2) +
                 " rad/s." :
             text;
}
}  // namespace

void nameCauses(const JointEvidence& evidence, ScalarIndicator indicator, double way, Finding& finding)
{
  constexpr double MIN_CHANGE = 0.02;  // least relative change of the indicator by a named fault of severity 1 [-]
  for (const Cause cause : causesThatMove(evidence.assessor().signatures(), indicator, way, MIN_CHANGE))
  {
    finding.causes.push_back({ cause, 0.0 });
  }
  for (WeightedCause& cause : finding.causes)
  {
    cause.weight = 1.0 / static_cast<double>(finding.causes.size());
  }
}

Finding judgeFriction(const JointEvidence& evidence, const JointContext& context, Verdict& verdict)
{
  Finding finding;
  finding.subject = FindingSubject::FRICTION;
  const FrictionFactor factor = frictionFactor(evidence, context);
  const double of_kind = evidence.parameters().comparison.friction_tolerance;
  // If the reference shows the friction of the other joints but not of this joint, the fit of the arm does not count.
  const FittedFriction fitted = context.own.is_unjudged ? FittedFriction() : context.fitted;
  bool is_fitted = isUnshown(factor.reason) && (fitted.departs() || fitted.isWithin(of_kind));
  verdict.friction_text = factor.why_not;
  finding.reason = factor.reason;
  if (!factor.isJudged() && !is_fitted)
  {
    return finding;
  }
  if (std::abs(std::log(context.arm_friction)) > std::log(MAX_ARM_FRICTION))
  {
    finding.reason = Reason::COMMON_FRICTION;
    verdict.friction_text = "The friction of the whole arm is " + fixedText(context.arm_friction, 2) +
                            " times that of the reference. No temperature explains this factor: the gain or the unit "
                            "of the currents is not as configured.";
    return finding;
  }
  const bool is_to_twin = factor.reference == FrictionReference::TWIN;
  double more = is_to_twin ? of_kind : MORE_THAN_OWN;
  double less = is_to_twin ? of_kind : LESS_THAN_OWN;
  const double shared = context.arm_friction;
  verdict.friction = { factor.value / shared, factor.low() / shared, factor.high() / shared, true };
  finding.level = VerdictLevel::OK;
  finding.reason = Reason::SOUND;
  if (factor.isJudged())
  {
    finding.level = levelOf(departure(factor, shared, more, less), 1.0, evidence.parameters().indicators.error_factor);
    verdict[REFERENCES[static_cast<std::size_t>(factor.reference)].figure] = factor.value;
    verdict[Figure::FRICTION_SCATTER] = factor.scatter;
    const bool is_better = is_to_twin || fitted.upper * factor.low() < fitted.lower * factor.high();
    is_fitted = finding.level == VerdictLevel::OK && fitted.departs() && is_better;
  }
  if (is_fitted)
  {
    finding.level = fitted.departs() ? VerdictLevel::WARN : VerdictLevel::OK;
    more = less = fitted.departs() ? FittedFriction::BOUND : of_kind;
    verdict.friction = { fitted.factor, fitted.lower, fitted.upper, true };
  }
  verdict[Figure::FRICTION_LOWEST] = 1.0 - less;
  verdict[Figure::FRICTION_HIGHEST] = 1.0 + more;
  if (finding.level != VerdictLevel::OK)
  {
    finding.reason = Reason::FRICTION;
    verdict.may_be_gain = !GainEvidence(evidence).isExcluded();
    nameCauses(evidence, ScalarIndicator::RUNNING_TORQUE, verdict.friction.factor > 1.0 ? 1.0 : -1.0, finding);
  }
  verdict.friction_text = frictionText(factor, is_fitted, evidence, context, finding, verdict);
  return finding;
}

OwnReference ownReference(const std::vector<SoundFriction>& recordings)
{
  OwnReference own;
  if (recordings.empty())
  {
    return own;
  }
  std::vector<FrictionPoint> all;
  double variance = 0.0;
  for (const SoundFriction& recording : recordings)
  {
    all.insert(all.end(), recording.points.begin(), recording.points.end());
    variance += recording.deviation * recording.deviation;
  }
  const auto count = static_cast<double>(recordings.size());
  own.friction = FrictionPoints::merged(all);
  own.friction_deviation = std::sqrt(variance) / count;
  std::vector<double> logarithms;
  for (const SoundFriction& recording : recordings)
  {
    const double ratio = FrictionPoints::ratioOf(FrictionPoints::common(recording.points, own.friction));
    if (ratio > 0.0)
    {
      logarithms.push_back(std::log(ratio));
    }
  }
  own.recordings = std::max<std::size_t>(logarithms.size(), 1);
  double sum = 0.0;
  double squares = 0.0;
  for (const double logarithm : logarithms)
  {
    sum += logarithm;
    squares += logarithm * logarithm;
  }
  const auto known = static_cast<double>(own.recordings);
  own.recordings_deviation =
      own.recordings > 1 ? std::sqrt(std::max(0.0, squares - sum * sum / known) / (known - 1.0)) : 0.0;
  return own;
}
}  // namespace hjt
