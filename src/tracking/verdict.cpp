// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "gear/angle.hpp"

namespace hjt
{
namespace
{
/// Mean of the product of measured and predicted current over the rows [A^2].
double agreement(const JointEvidence& evidence)
{
  return 0.5 * (std::pow(evidence.currentRms(), 2) + std::pow(evidence.predictedRms(), 2) -
                std::pow(evidence.residualRms(), 2));
}

/// Says why the recorded current shows nothing of the drive: it is not the current of the motor, or not the current
/// under the assumed load. Returns none if the current fits.
std::optional<Reason> whyRowsDoNotFit(const JointEvidence& evidence)
{
  constexpr double MIN_RATIO = 0.02;  // least rms of the measured current over rms of the predicted current [-]
  constexpr double MAX_RATIO = 4.0;
  constexpr double MAX_UNEXPLAINED = 0.5;
  constexpr double SPREAD = 2.0;  // least standard deviation of the residual over rms of the predicted current [-]
  constexpr double AGREES = 0.7;  // least correlation of measured and predicted current [-]
  const double noticeable = 2.0 * evidence.parameters().telemetry.current_deviation;
  const double measured = evidence.currentRms();
  const double predicted = evidence.predictedRms();
  if (evidence.reach().isAtRest() && evidence.friction().points().empty())
  {
    return std::nullopt;  // stiction holds the joint at any current
  }
  if (predicted > noticeable && measured < MIN_RATIO * predicted)
  {
    return Reason::EFFORT_NOT_CURRENT;
  }
  if (predicted > noticeable && measured > 0.5 * predicted && -agreement(evidence) > AGREES * measured * predicted)
  {
    return Reason::EFFORT_NOT_CURRENT;  // the effort has the opposite sign
  }
  // Currents by spikes, noise or external loads can be as large, but they are no multiple of the predicted current.
  if (measured > noticeable && measured > MAX_RATIO * predicted && evidence.residualSpread() > SPREAD * predicted &&
      agreement(evidence) > AGREES * measured * predicted)
  {
    return Reason::EFFORT_TOO_LARGE;
  }
  const double unexplained = evidence.unexplainedRms();
  if (unexplained > noticeable && unexplained > MAX_UNEXPLAINED * measured)
  {
    return Reason::LOAD_WRONG;
  }
  return std::nullopt;
}

Finding judgeTorsion(const JointEvidence& evidence, const OwnReference& own, Verdict& verdict)
{
  const EvidenceParameters& parameters = evidence.parameters();
  Finding finding;
  finding.subject = FindingSubject::TORSION;
  if (evidence.torsion().rows() == 0)
  {
    finding.reason = Reason::NO_MOTOR_ANGLE;
    return finding;
  }
  const double compliance = evidence.torsion().compliance();
  if (!std::isfinite(compliance))
  {
    finding.reason = Reason::LOAD_CONSTANT;
    return finding;
  }
  constexpr double MAX_COMPLIANCE = 20.0;  // largest compliance over the twin's; a softer drive cannot turn [-]
  if (compliance < 0.0 || compliance > MAX_COMPLIANCE)
  {
    verdict[Figure::TORSION_OF_TWIN] = compliance;
    finding.reason = Reason::TORSION_NO_DRIVE;
    return finding;
  }
  // An eccentric encoder at the output has the effect of a torsion once per turn, as weight has. The error of the
  // motor's encoder counts with its rms, because the motor makes many turns.
  const double twin = evidence.torsion().twinAmplitude();
  const double turn = evidence.torsion().turnAmplitude();
  const double eccentricity = (parameters.sensors.output_eccentricity * turn +
                               parameters.sensors.motor_eccentricity / evidence.ratio() / std::sqrt(2.0)) /
                              twin;
  const double to_own = compliance / own.compliance_ratio;
  const bool is_own_known = std::isfinite(to_own);
  const double ratio = is_own_known ? to_own : compliance;
  const ComparisonParameters& comparison = parameters.comparison;
  const double tolerance = is_own_known ? comparison.repeat_tolerance : comparison.compliance_tolerance + eccentricity;
  verdict[Figure::TORSION_OF_TWIN] = compliance;
  verdict[Figure::TORSION_OF_OWN] = to_own;
  verdict[Figure::TORSION_TOLERANCE] = tolerance;
  finding.level = levelOf(ratio - 1.0, tolerance, parameters.indicators.error_factor);
  finding.reason = finding.level == VerdictLevel::OK ? Reason::SOUND : Reason::TORSION;
  if (finding.level != VerdictLevel::OK)
  {
    nameCauses(evidence, ScalarIndicator::TORSIONAL_STIFFNESS, ratio > 1.0 ? -1.0 : 1.0, finding);
  }
  constexpr double MIN_TURN = 0.01;  // least turnAmplitude() with which ENCODER_ERROR has a meaning [-]
  if (!is_own_known)
  {
    verdict[Figure::ENCODER_SHARE] = eccentricity;
    verdict[Figure::ENCODER_ECCENTRICITY] = parameters.sensors.output_eccentricity;
    if (turn > MIN_TURN)
    {
      verdict[Figure::ENCODER_ERROR] = std::abs(compliance - 1.0) * twin / turn;
    }
  }
  return finding;
}

Finding judgeSignals(const JointEvidence& evidence, const JointContext& context, Verdict& verdict)
{
  Finding finding;
  finding.subject = FindingSubject::SIGNALS;
  verdict[Figure::WINDOWS] = static_cast<double>(evidence.assessedWindows());
  if (!evidence.worst())
  {
    if (evidence.tooFew())
    {
      verdict[Figure::WINDOWS_HERE] = evidence.tooFew()->windows_here;
      verdict[Figure::WINDOWS_NEEDED] = evidence.tooFew()->windows_needed;
    }
    else
    {
      verdict[Figure::WINDOWS_NEEDED] = evidence.assessor().baseline().windowsNeeded();
    }
    finding.reason = evidence.tooFew()        ? Reason::TOO_FEW_WINDOWS :
                     evidence.baselineGiven() ? Reason::NO_REFERENCE :
                                                Reason::TOO_SHORT;
    return finding;
  }
  const Assessment& assessment = evidence.worst()->assessment;
  if (assessment.level != HealthLevel::OK && evidence.baselineGiven() && context.arm_friction != 1.0)
  {
    finding.reason = Reason::COMMON_FRICTION;
    return finding;
  }
  finding.level = static_cast<VerdictLevel>(assessment.level);
  if (assessment.level == HealthLevel::OK)
  {
    return finding;
  }
  finding.reason = Reason::SIGNALS;
  if (evidence.cause() != Cause::NONE)
  {
    finding.causes = { { evidence.cause(), evidence.causeShare() } };
  }
  verdict[Figure::ALARM_TIME] = evidence.alarmTime();
  verdict.evidence.assign(assessment.evidence.begin(),
                          assessment.evidence.begin() + static_cast<std::ptrdiff_t>(assessment.evidence_count));
  return finding;
}

/// Highest order per turn of the motor that the rows resolve at the highest speed [-]; 0: the joint does not move.
double highestOrder(const JointEvidence& evidence, const Verdict& verdict)
{
  constexpr double RESOLVED = 0.4;  // highest resolved frequency over the rate of the rows; in theory 0.5 [-]
  const double fastest = std::max(-verdict[Figure::LOWEST_SPEED], verdict[Figure::HIGHEST_SPEED]);
  const double turns = std::abs(fastest * evidence.ratio()) * evidence.reach().sampled / TWO_PI;
  return turns > 0.0 ? RESOLVED * static_cast<double>(evidence.reach().rows) / turns : 0.0;
}

/// Sets the figures of the verdict that do not depend on its findings.
void setFigures(const JointEvidence& evidence, const JointContext& context, Verdict& verdict)
{
  const MotionReach& reach = evidence.reach();
  const std::vector<FrictionPoint> points = evidence.friction().points();
  verdict[Figure::SPEEDS] = static_cast<double>(points.size());
  if (!points.empty())
  {
    verdict[Figure::LOWEST_SPEED] = points.front().speed;
    verdict[Figure::HIGHEST_SPEED] = points.back().speed;
  }
  verdict[Figure::FRICTION_OF_ARM] = context.arm_friction;
  verdict[Figure::ROWS] = static_cast<double>(reach.rows);
  verdict[Figure::TOUCHED_ROWS] = static_cast<double>(reach.touched_rows);
  verdict[Figure::SPAN] = reach.end - reach.begin;
  verdict[Figure::CURRENT] = evidence.currentRms();
  verdict[Figure::CURRENT_PREDICTED] = evidence.predictedRms();
  verdict[Figure::CURRENT_RESIDUAL] = evidence.residualRms();
  verdict[Figure::CURRENT_UNEXPLAINED] = evidence.unexplainedRms();
  verdict[Figure::LEAST_LOAD] = reach.least_load;
  verdict[Figure::MOST_LOAD] = reach.most_load;
  verdict[Figure::TEMPERATURE] = evidence.temperature();
  verdict[Figure::REFERENCE_TEMPERATURE] = context.own.temperature;
  verdict[Figure::HIGHEST_ORDER] = highestOrder(evidence, verdict);
  if (evidence.contact().hasSeen() || reach.touched_rows > 0)
  {
    const Contact& last = evidence.contact().last();
    const Contact& largest = evidence.contact().largest();
    verdict[Figure::CONTACT_SINCE] = last.since;
    verdict[Figure::CONTACT_LASTED] = last.lasted;
    verdict[Figure::CONTACT_TORQUE] = last.largest;
    verdict[Figure::LARGEST_CONTACT_SINCE] = largest.since;
    verdict[Figure::LARGEST_CONTACT_LASTED] = largest.lasted;
    verdict[Figure::LARGEST_CONTACT_TORQUE] = largest.largest;
  }
  verdict.load = evidence.loadOrigin();
  verdict.is_reference_given = evidence.baselineGiven();
  verdict.has_signatures = !evidence.assessor().signatures().signatures.empty();
}

/// Derives level and reason of the verdict from its findings.
void sumUp(Verdict& verdict)
{
  verdict.reason = verdict.findings.front().reason;
  for (const Finding& finding : verdict.findings)
  {
    const bool is_worse = !verdict.isJudged() || severityOf(finding.level) > severityOf(verdict.level);
    if (finding.level != VerdictLevel::NOT_JUDGED && is_worse)
    {
      verdict.level = finding.level;
      verdict.reason = finding.reason;
    }
  }
}
}  // namespace

VerdictLevel levelOf(double deviation, double tolerance, double error_factor)
{
  const double size = std::abs(deviation) / tolerance;
  return size > error_factor ? VerdictLevel::ERROR : size > 1.0 ? VerdictLevel::WARN : VerdictLevel::OK;
}

MeasuredFriction measuredFriction(const JointEvidence& evidence, const JointContext& context)
{
  const FrictionFactor factor = frictionFactor(evidence, context);
  const std::optional<Reason> why_not = whyRowsDoNotFit(evidence);
  const bool is_open = !context.misfit.exists();
  return { is_open && !why_not && factor.isJudged() ? std::make_optional(factor.value) : std::nullopt,
           evidence.temperature(),
           evidence.reach().temperature_rows > 0,
           [&evidence](double temperature) { return evidence.twinFrictionAt(temperature); },
           is_open && factor.is_below_faults,
           is_open && factor.reason == Reason::NO_FRICTION,
           factor.reason == Reason::EFFORT_NOT_CURRENT || (why_not == Reason::EFFORT_NOT_CURRENT && factor.value < 0.0),
           is_open && (why_not == Reason::LOAD_WRONG || factor.reason == Reason::LOAD_WRONG),
           !context.own.friction.empty() };
}

std::vector<WeightedCause> causesOf(const Verdict& verdict)
{
  std::vector<WeightedCause> causes;
  for (const Finding& finding : verdict.findings)
  {
    for (const WeightedCause& found : finding.causes)
    {
      const auto known = std::find_if(causes.begin(), causes.end(),
                                      [&](const WeightedCause& cause) { return cause.cause == found.cause; });
      if (known == causes.end())
      {
        causes.push_back(found);
      }
      else
      {
        known->weight = std::max(known->weight, found.weight);
      }
    }
  }
  std::stable_sort(causes.begin(), causes.end(),
                   [](const WeightedCause& a, const WeightedCause& b) { return a.weight > b.weight; });
  return causes;
}

Verdict judge(const JointEvidence& evidence, const JointContext& context)
{
  Verdict verdict;
  verdict.joint = evidence.parameters().joint.name;
  setFigures(evidence, context, verdict);
  verdict.findings = { judgeFriction(evidence, context, verdict), judgeTorsion(evidence, context.own, verdict),
                       judgeSignals(evidence, context, verdict) };
  if (context.misfit.exists())
  {
    verdict.dismiss(context.misfit);
  }
  else if (const std::optional<Reason> why_not = whyRowsDoNotFit(evidence))
  {
    verdict.dismiss({ *why_not, "" });
  }
  else if (verdict.findings.front().level != VerdictLevel::NOT_JUDGED)
  {
    // A reference of the same joint may have the same wrong gain. Then only a change of the friction shows the gain.
    const bool departs = severityOf(verdict.findings.front().level) != HealthLevel::OK;
    const bool is_to_own = context.is_identified || !context.own.friction.empty();
    const GainEvidence gain(evidence);
    const Misfit misfit = departs || (!is_to_own && gain.isOfFriction()) ? gain.misfit() : Misfit();
    const std::string& doubt = verdict.friction.factor > 1.0 ? context.fitted.not_more : context.fitted.not_less;
    if (misfit.exists())
    {
      verdict.dismiss(misfit);
    }
    else if (departs && !doubt.empty())
    {
      verdict.dismiss({ Reason::LOAD_WRONG, doubt });
    }
  }
  sumUp(verdict);
  verdict.cannot_show = cannotShow(evidence, verdict);
  return verdict;
}

void Verdict::dismiss(const Misfit& why_not)
{
  fits = false;
  level = VerdictLevel::NOT_JUDGED;
  reason = why_not.reason;
  misfit = why_not.clause;
  friction = JudgedFriction();
  evidence.clear();
  for (Finding& finding : findings)
  {
    finding = { finding.subject, VerdictLevel::NOT_JUDGED, why_not.reason, {} };
  }
}
}  // namespace hjt
