// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/verdict.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/number_text.hpp"
#include "base/text.hpp"

namespace hjt
{
namespace
{
/// By which the friction of a sound drive repeats from one recording to the other, beyond what joints have in common,
/// standard deviation: a share, and a torque, which counts in small drives [-], [N.m].
constexpr double REPEAT_SHARE = 0.03;
constexpr double REPEAT_TORQUE = 0.22;

/// The same from its own earlier one, apart from what the joints of its group, which witness, have in common.
constexpr double WITNESSED_SHARE = 0.025;
constexpr double WITNESSED_TORQUE = 0.1;

/// Of the load: masses of the links, 2 %, and gain, 5 %; standard deviation as a share.
constexpr double LOAD_SHARE = 0.054;

/// Of what a controller expects of a sound joint, standard deviation as a share.
constexpr double CONTROLLER_SHARE = 0.05;

/// No fault of severity 1 leaves less of the friction.
constexpr double LEAST_OF_FAULTS = 0.5;

/// Below it the rows show no friction at all.
constexpr double NO_FRICTION = 0.1;

/// A factor that is known no better than to a half tells nothing; half width of the logarithm's interval.
constexpr double WIDEST = 0.4;

/// No change of temperature makes the friction of grease and contacts larger or smaller by more.
constexpr double MAX_ARM_FRICTION = 2.5;

constexpr std::size_t MIN_POINTS = 3;

/// The mean friction one way is against the motion in every drive. 0: so it is; else the way it is not.
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

using Gap = std::pair<Reason, std::string>;  // and in a sentence

/// Why points show no factor.
Gap whyNone(const std::vector<FrictionPoint>& points, const JointEvidence& evidence, bool is_to_own)
{
  const std::string have_rows = " have " + std::to_string(FrictionPoints::MIN_ROWS) + " rows" +
                                (evidence.reach().touched_rows > 0 ? " apart from contact" : "") +
                                (is_to_own ? " and are in the reference too" : "");
  if (points.empty() && evidence.reach().most_angle - evidence.reach().least_angle < LEAST_MOTION)
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
    return { Reason::ONE_DIRECTION, "The joint moves one way only at the speeds that" + have_rows +
                                        ": friction and load cannot be separated." };
  }
  if (points.size() < MIN_POINTS)
  {
    return { Reason::ONE_SPEED,
             "Fewer than three speeds" + have_rows + ": how sure the joint's friction is cannot be told." };
  }
  if (evidence.friction().blocks().count() < MIN_POINTS)
  {
    return { Reason::TOO_SHORT, "Too few rows show the joint's friction: it moves steadily for less than " +
                                    fixedText(MIN_POINTS * FrictionBlocks::LENGTH, 0) + " s." };
  }
  return { Reason::SOUND, "" };
}

/// Why a factor that the points show is not that of a drive.
Gap whyImpossible(const FrictionFactor& factor, const std::vector<FrictionPoint>& points, LoadOrigin load)
{
  if (factor.is_below_faults && factor.value < -LEAST_OF_FAULTS)
  {
    return { Reason::EFFORT_NOT_CURRENT, "Friction pushes the joint along (" + fixedText(factor.value, 2) +
                                             " times the expected one): effort or angle of this joint is of the "
                                             "opposite sign." };
  }
  if (factor.is_below_faults && std::abs(factor.value) < NO_FRICTION)
  {
    return { Reason::NO_FRICTION,
             "The effort holds no friction (" + fixedText(factor.value, 2) +
                 " times the expected one): it is a modelled or commanded torque, or something else carries the "
                 "joint." };
  }
  if (factor.is_below_faults)
  {
    return { Reason::LESS_THAN_FAULTS,
             "Friction is " + factorText(factor) +
                 " times the expected one, less than any fault leaves of it: the arm is led by hand or held, or "
                 "gain, ratio or sign are others than configured." };
  }
  if (const double way = impossibleWay(points); way != 0.0)
  {
    return { Reason::LOAD_WRONG, std::string("Friction would push the joint along in ") +
                                     (way > 0.0 ? "positive" : "negative") +
                                     " motion, which it cannot: " + wrongLoad(load) };
  }
  if (!(factor.high() < factor.value * std::exp(WIDEST)))
  {
    return { Reason::FRICTION_SCATTER, "The rows scatter too much to know the friction: " + factorText(factor) +
                                           " times the expected one. Too few of them are steady, or " +
                                           wrongLoad(load) };
  }
  return { Reason::SOUND, "" };
}

/// The joint's own rows do not show its friction; those of the whole arm may.
bool isUnshown(Reason reason)
{
  return reason == Reason::NO_STEADY_MOTION || reason == Reason::NO_REFERENCE || reason == Reason::ONE_DIRECTION ||
         reason == Reason::ONE_SPEED || reason == Reason::TOO_SHORT || reason == Reason::FRICTION_SCATTER;
}

/// Of the ratio to the mean of the reference's recordings. `stated`: of one recording to another; it counts like as
/// many recordings as STATED_COUNT beside the difference of those that there are.
double repeatDeviation(double stated, const OwnReference& own)
{
  constexpr double STATED_COUNT = 3.0;
  const auto count = static_cast<double>(own.recordings);
  const double of_one =
      (STATED_COUNT * 0.5 * stated * stated + (count - 1.0) * own.recordings_deviation * own.recordings_deviation) /
      (STATED_COUNT + count - 1.0);
  return std::sqrt(of_one * (1.0 + 1.0 / count));
}

/// Of the friction over its own earlier one, by the scatter of the rows of both, as a share: by leaving out one speed
/// of both after the other, or of the blocks of each, whichever is larger. Half of the blocks' variance counts: the
/// rest is where the twin's friction does not rise with the speed as the joint's does, which both recordings share.
double scatterToOwn(const FrictionRatio& ratio, const FrictionBlocks& blocks, const OwnReference& own)
{
  const double of_blocks = std::sqrt(0.5) * std::hypot(blocks.deviation(), own.friction_deviation);
  return std::max(ratio.of_points / std::max(std::abs(ratio.value), NO_FRICTION), of_blocks);
}

/// Standard deviation of the logarithm, of all that the factor is uncertain by.
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

/// Distance of the factor from 1 over that at which its interval clears the bound; > 1 is a departure.
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
      return "the load is not the one that was recorded.";
    case LoadOrigin::ARM:
      return "the load is not that of the arm's links and payload, something touched the arm, or angles, stamps or "
             "currents are disturbed.";
  }
  return "the load is not the one that is configured. Give the load of the whole arm (docs/arm.md), or record it.";
}

const char* referenceName(FrictionReference reference) noexcept
{
  switch (reference)
  {
    case FrictionReference::CONTROLLER:
      return "controller";
    case FrictionReference::OWN:
      return "own";
    case FrictionReference::TWIN:
      break;
  }
  return "twin";
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
  constexpr double SURE = 2.0;  // standard deviations
  factor.is_below_faults = factor.value / context.arm_friction < LEAST_OF_FAULTS &&
                           factor.value + SURE * factor.deviation * std::max(factor.value, NO_FRICTION) < 1.0;
  std::tie(factor.reason, factor.why_not) = whyImpossible(factor, ratio.points, evidence.loadOrigin());
  return factor;
}

namespace
{
const char* referenceText(FrictionReference reference)
{
  switch (reference)
  {
    case FrictionReference::CONTROLLER:
      return "what the arm's controller expects";
    case FrictionReference::OWN:
      return "this joint's own when it was sound";
    case FrictionReference::TWIN:
      break;
  }
  return "the twin's";
}

Figure figureOf(FrictionReference reference)
{
  return reference == FrictionReference::OWN        ? Figure::FRICTION_OF_OWN :
         reference == FrictionReference::CONTROLLER ? Figure::FRICTION_OF_CONTROLLER :
                                                      Figure::FRICTION_OF_TWIN;
}

/// `verdict`: with the friction that was judged, and its bounds.
std::string frictionText(const FrictionFactor& factor, bool is_fitted, const JointEvidence& evidence,
                         const JointContext& context, const Finding& finding, const Verdict& verdict)
{
  const double shared = context.arm_friction;
  std::string text =
      "Friction is " + factorText(verdict.friction) + " times " + referenceText(factor.reference) +
      (is_fitted     ? " in a fit of the currents of all joints, apart from what they share" :
       shared == 1.0 ? "" :
                       ", apart from the " + fixedText(shared, 2) + " times that the arm's joints share") +
      " (an interval that reaches into " + fixedText(verdict[Figure::FRICTION_LOWEST], 2) + " to " +
      fixedText(verdict[Figure::FRICTION_HIGHEST], 2) + " counts as sound).";
  if (finding.level != VerdictLevel::OK)
  {
    const auto name = [](const WeightedCause& cause) { return causeName(cause.cause); };
    text += (evidence.assessor().signatures().signatures.empty() ? std::string() :
             finding.causes.empty() ? std::string(" No fault in the list has this effect.") :
                                      " Possible faults: " + joined(finding.causes, ", ", name) + ".") +
            " Other causes: grease at another temperature, another preload" +
            (GainEvidence(evidence).isExcluded() ? "." : ", or a wrong gain: the load shows too little to tell.");
  }
  if (context.own.is_unjudged)
  {
    text += " The reference did not judge this joint's friction; the twin is taken in its place.";
  }
  text += " At " + fixedText(evidence.temperature(), 0) + " degC (" + temperatureSource(evidence) + ")";
  text += std::isfinite(context.own.temperature) ?
              ", the reference at " + fixedText(context.own.temperature, 0) +
                  " degC; the twin's law of friction makes up for the difference." :
              ".";
  const std::vector<FrictionPoint> points = evidence.friction().points();
  return points.empty() ?
             text :
             text + " Measured at " + std::to_string(points.size()) + " speeds from " +
                 fixedText(points.front().speed, 2) + " to " + fixedText(points.back().speed, 2) + " rad/s.";
}
}  // namespace

void nameCauses(const JointEvidence& evidence, ScalarIndicator indicator, double way, Finding& finding)
{
  constexpr double MIN_CHANGE = 0.02;  // share by which a fault of severity 1 must change it to be named
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
  const std::vector<FrictionPoint> points = evidence.friction().points();
  verdict[Figure::SPEEDS] = static_cast<double>(points.size());
  if (!points.empty())
  {
    verdict[Figure::LOWEST_SPEED] = points.front().speed;
    verdict[Figure::HIGHEST_SPEED] = points.back().speed;
  }
  verdict[Figure::FRICTION_OF_ARM] = context.arm_friction;
  const FrictionFactor factor = frictionFactor(evidence, context);
  const double of_kind = evidence.parameters().comparison.friction_tolerance;
  // Where others of the arm are held against themselves, the fit is of two kinds of joints.
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
                            " times the reference's, more than temperature makes: gain or unit of the currents are not "
                            "the configured ones.";
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
    verdict[figureOf(factor.reference)] = factor.value;
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
