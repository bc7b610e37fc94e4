// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/verdict.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>

#include "base/joined.hpp"
#include "base/number_text.hpp"
#include "gear/angle.hpp"

namespace hjt
{
namespace
{
std::string rounded(double value, int digits)
{
  return fixedText(value, digits);
}

/// Share of the largest load by which the load must vary to show anything that load alone shows.
constexpr double MIN_LOADING = 0.035;

/// Share of its sound value by which a fault of severity 1 must change an indicator to be named.
constexpr double MIN_CHANGE = 0.02;

/// One quantity as a multiple of the twin's.
struct Ratio
{
  const char* what;
  double value;
  double to_own;              ///< the same of the joint's own when it was sound; NaN: not known
  double of_kind;             ///< share by which sound joints differ from the twin
  ScalarIndicator indicator;  ///< that says the same
  double when_larger;         ///< the indicator moves up: +1, down: -1
  const char* besides;        ///< what else moves it
  const SignatureSet& signatures;
};

/// Against the joint's own when sound where that is known, else against the twin.
void judgeRatio(const Ratio& ratio, const Parameters& parameters, Finding& finding)
{
  const bool known = std::isfinite(ratio.to_own);
  const double tolerance = known ? parameters.comparison.repeat_tolerance : ratio.of_kind;
  const double value = known ? ratio.to_own : ratio.value;
  finding.judged = true;
  finding.level = levelOf(value - 1.0, tolerance, parameters.indicators.error_factor);
  // As many digits as it takes to see on which side of the bound the value lies.
  const double lowest = std::max(0.0, 1.0 - tolerance);
  const double highest = 1.0 + tolerance;
  int digits = 2;
  while (digits < 6 && finding.level != HealthLevel::OK &&
         (rounded(value, digits) == rounded(lowest, digits) || rounded(value, digits) == rounded(highest, digits)))
  {
    ++digits;
  }
  const std::string sound = rounded(lowest, digits) + " to " + rounded(highest, digits) + " counts as sound";
  finding.text = std::string(ratio.what) + " is " + rounded(ratio.value, digits) + " times the twin's" +
                 (known ? " and " + rounded(ratio.to_own, digits) + " times this joint's own when it was sound" : "") +
                 " (" + sound + ").";
  if (finding.level != HealthLevel::OK)
  {
    finding.causes = causesThatMove(ratio.signatures, ratio.indicator,
                                    value > 1.0 ? ratio.when_larger : -ratio.when_larger, MIN_CHANGE);
    finding.text += (ratio.signatures.signatures.empty() ? std::string() :
                     finding.causes.empty()              ? std::string(" No fault in the list has this effect.") :
                                              " Possible faults: " + joined(finding.causes, ", ", causeName) + ".") +
                    " Other causes: " + ratio.besides + ".";
  }
}

bool movesBothWays(const std::vector<FrictionPoint>& points)
{
  return points.front().speed < 0.0 && points.back().speed > 0.0;
}

/// Why the recorded current says nothing about the drive: not that of its motor, or of another load; empty: it fits.
std::string whyItDoesNotFit(const JointEvidence& evidence, const Parameters& parameters, const JointContext& context)
{
  if (!context.misfit.empty())
  {
    return context.misfit;
  }
  constexpr double MIN_RATIO = 0.02;  // of the predicted current, rms
  constexpr double MAX_RATIO = 4.0;
  constexpr double MAX_UNEXPLAINED = 0.5;
  constexpr double SPREAD = 2.0;  // of the residual over the predicted current: a constant load has none
  const double noticeable = 2.0 * parameters.telemetry.current_deviation;
  const double measured = evidence.currentRms();
  const double predicted = evidence.predictedRms();
  if (predicted > noticeable && measured < MIN_RATIO * predicted)
  {
    return "The recorded effort is " + rounded(measured, 2) + " A rms where this motion takes some " +
           rounded(predicted, 2) + " A: it is not the motor's current.";
  }
  if (measured > noticeable && measured > MAX_RATIO * predicted && evidence.residualSpread() > SPREAD * predicted)
  {
    return "The recorded effort is " + rounded(measured / predicted, 1) +
           " times the current that this motion takes: it is expected in A, not in N.m; or "
           "telemetry.torque_per_current is wrong.";
  }
  const double unexplained = evidence.unexplainedRms();
  if (unexplained > noticeable && unexplained > MAX_UNEXPLAINED * measured)
  {
    return "Of " + rounded(measured, 2) + " A rms " + rounded(unexplained, 2) +
           " A are neither predicted nor explained by another friction or a constant: " +
           wrongLoad(evidence.loadOrigin());
  }
  constexpr std::uint64_t MIN_BLOCKS = 3;  // of friction, apart from what was touched
  const MotionReach& reach = evidence.reach();
  if (reach.touched_rows > 0 && reach.most_angle - reach.least_angle > LEAST_MOTION &&
      evidence.friction().blocks().count() < MIN_BLOCKS)
  {
    return sentence(contactText(evidence.contact().largest()));
  }
  return {};
}

Finding judgeTorsion(const JointEvidence& evidence, const Parameters& parameters, const OwnReference& own)
{
  Finding finding{ HealthLevel::OK, false, "Torsion", "", {} };
  if (evidence.torsion().rows() == 0)
  {
    finding.text = "One angle a joint: torsion needs encoders at the motor and at the output.";
    return finding;
  }
  const double compliance = evidence.torsion().compliance();
  if (!std::isfinite(compliance))
  {
    finding.text = "The load hardly varies, so the stiffness of the drive cannot be measured.";
    return finding;
  }
  constexpr double MAX_COMPLIANCE = 20.0;  // no drive is so soft that still turns
  if (compliance < 0.0 || compliance > MAX_COMPLIANCE)
  {
    finding.text = "Torsion is " + rounded(compliance, 2) +
                   " times the twin's, which no fault makes: load, or the angles of motor and joint, are not this "
                   "joint's, or of other signs.";
    return finding;
  }
  // Once a turn an encoder off its axis looks like torsion under a weight. The motor turns often.
  const double twin = evidence.torsion().twinAmplitude();
  const double turn = evidence.torsion().turnAmplitude();
  const double eccentricity = (parameters.sensors.output_eccentricity * turn +
                               parameters.sensors.motor_eccentricity / evidence.ratio() / std::sqrt(2.0)) /
                              twin;
  judgeRatio({ "Torsion", compliance, compliance / own.compliance_ratio,
               parameters.comparison.compliance_tolerance + eccentricity, ScalarIndicator::TORSIONAL_STIFFNESS, -1.0,
               "a wrong load, eccentric encoders", evidence.assessor().signatures() },
             parameters, finding);
  constexpr double MIN_TURN = 0.01;  // below it the joint hardly turns
  if (!std::isfinite(own.compliance_ratio) && finding.level != HealthLevel::OK && turn > MIN_TURN)
  {
    finding.text += " An error of the output encoder once a turn, of amplitude " +
                    rounded(1e3 * std::abs(compliance - 1.0) * twin / turn, 2) +
                    " mrad or more, would look the same: sensors.output_eccentricity is " +
                    rounded(1e3 * parameters.sensors.output_eccentricity, 2) + " mrad.";
  }
  if (!std::isfinite(own.compliance_ratio) && eccentricity > 0.01)
  {
    finding.text += " Of the tolerance " + rounded(eccentricity, 2) +
                    " is for the encoders' eccentricity: a recording of "
                    "the sound joint (--reference) would narrow it.";
  }
  return finding;
}

Finding judgeSignals(const JointEvidence& evidence, const JointContext& context)
{
  Finding finding{ HealthLevel::OK, false, "Signals by windows", "", {} };
  const std::string reference = evidence.baselineGiven() ? "the reference given" :
                                                           "the reference learned from the first windows of this "
                                                           "recording";
  if (!evidence.worst())
  {
    finding.text = evidence.tooFew() ? sentence(whyNotJudged(*evidence.tooFew())) :
                   evidence.baselineGiven() ?
                                       "No window of the recording is at an operating point that the reference knows." :
                                       "No reference was given, and the recording is too short to learn one (" +
                                           std::to_string(evidence.assessor().baseline().windowsNeeded()) +
                                           " windows at one operating point).";
    return finding;
  }
  const Assessment& assessment = evidence.worst()->assessment;
  if (assessment.level != HealthLevel::OK && evidence.baselineGiven() && context.arm_friction != 1.0)
  {
    finding.text = "The friction of the whole arm is " + rounded(context.arm_friction, 2) +
                   " times that of the reference: its signals are of another temperature or gain.";
    return finding;
  }
  finding.judged = true;
  finding.level = assessment.level;
  const std::string windows = std::to_string(evidence.assessedWindows()) + " windows compared with " + reference;
  if (assessment.level == HealthLevel::OK)
  {
    finding.text = windows + ": nothing out of the ordinary.";
    return finding;
  }
  const bool known = evidence.cause() != Cause::NONE;
  if (known)
  {
    finding.causes = { evidence.cause() };
  }
  finding.text = "From " + rounded(evidence.alarmTime(), 1) + " s on the signals depart from " + reference +
                 (known ? std::string(". Most likely cause: ") + causeName(evidence.cause()) : ", cause not known") +
                 ". Strongest: ";
  for (std::size_t i = 0; i < assessment.evidence_count; ++i)
  {
    const Evidence& evidence = assessment.evidence[i];
    finding.text += (i == 0 ? "" : "; ") + std::string(indicatorName(evidence.indicator)) + ' ' +
                    roundedText(evidence.value, 3) + ' ' + indicatorUnit(evidence.indicator) + " where " +
                    roundedText(evidence.expected, 3) + " is sound";
  }
  finding.text += ".";
  return finding;
}

/// Order of the motor's turn that the rows resolve at the highest speed; 0: the joint does not move.
double highestOrder(const JointEvidence& evidence, double duration)
{
  constexpr double RESOLVED = 0.4;  // of the rows' rate; half of it is the limit
  double fastest = 0.0;
  for (const FrictionPoint& point : evidence.friction().points())
  {
    fastest = std::max(fastest, std::abs(point.speed));
  }
  const double turns = fastest * evidence.ratio() * duration / TWO_PI;
  return turns > 0.0 ? RESOLVED * static_cast<double>(evidence.reach().rows) / turns : 0.0;
}

std::vector<std::string> cannotShow(const JointEvidence& evidence, const Parameters& parameters,
                                    const JointContext& context)
{
  const MotionReach& reach = evidence.reach();
  std::vector<std::string> missing;
  if (reach.motor_rows == 0)
  {
    missing.emplace_back(
        "Torsion, stiffness, lost motion, kinematic error, ratcheting: the recording has one angle a "
        "joint; the motor's is needed too.");
  }
  if (evidence.loadOrigin() == LoadOrigin::ARM)
  {
    missing.emplace_back(
        "Whether the payload is as configured, and what presses on the arm all the time: no torque was recorded; both "
        "look like current.");
  }
  if (evidence.loadOrigin() == LoadOrigin::CONFIGURED)
  {
    missing.emplace_back(
        "Whether the load is as configured: no load was recorded, so weight and inertia of the "
        "configuration are taken; a payload left out looks like current.");
  }
  if (!evidence.isTemperatureReceived())
  {
    missing.emplace_back(
        "Temperature: none is recorded; grease at another one changes the friction by some per cent a "
        "kelvin.");
  }
  if (!evidence.baselineGiven())
  {
    missing.emplace_back(
        "A fault that was there from the first window, unless it is larger than what joints of one kind "
        "differ by: no reference of this joint was given.");
  }
  if (reach.touched_rows > 0)
  {
    missing.emplace_back("What the joint did while something touched the arm, and shortly after: " +
                         std::to_string(reach.touched_rows) + " of " + std::to_string(reach.rows) +
                         " rows are left out. The strongest: " + contactText(evidence.contact().largest()) + ".");
  }
  const std::vector<FrictionPoint> points = evidence.friction().points();
  if (!points.empty() && !movesBothWays(points))
  {
    missing.emplace_back("Friction apart from a load that is wrong: the joint moves one way only.");
  }
  if (points.size() < 3)
  {
    missing.emplace_back("How friction depends on the speed: fewer than three speeds.");
  }
  if (reach.most_load - reach.least_load < MIN_LOADING * parameters.output.load_torque_limit)
  {
    missing.emplace_back("Anything that shows under load only, such as stiffness and cracks: the load varies by " +
                         rounded(reach.most_load - reach.least_load, 1) + " N.m.");
  }
  const double order = highestOrder(evidence, context.duration);
  if (order > 0.0)
  {
    missing.emplace_back(
        "Lines above order " + rounded(order, 1) +
        " of the motor's turn at the highest speed: the recording has too few rows a turn to show them; "
        "slower motion shows more.");
  }
  return missing;
}
std::string lowerTitle(const Finding& finding)
{
  std::string title = finding.title;
  title.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(title.front())));
  return title;
}

/// The deviations with possible faults, or that there are none.
std::string reasonOf(const Verdict& verdict)
{
  std::vector<std::string> departing;
  std::vector<std::string> sound;
  std::vector<std::string> open;
  for (const Finding& finding : verdict.findings)
  {
    if (finding.level != HealthLevel::OK)
    {
      departing.push_back(
          lowerTitle(finding) + " (" +
          (finding.causes.empty() ? "no fault in the list does this" : joined(finding.causes, " or ", causeName)) +
          ")");
    }
    else
    {
      (finding.judged ? sound : open).push_back(lowerTitle(finding));
    }
  }
  if (!departing.empty())
  {
    return "Not as in a sound joint: " + joined(departing, "; ") + ".";
  }
  return sound.empty() ? "The motion does not show whether the joint is sound. " + verdict.findings.front().text :
                         "As in a sound joint: " + joined(sound) + "." +
                             (open.empty() ? "" : " The motion does not show: " + joined(open) + ".");
}
}  // namespace

std::string sentence(std::string clause)
{
  if (!clause.empty())
  {
    clause[0] = static_cast<char>(std::toupper(clause[0]));
    clause += ".";
  }
  return clause;
}

/// `deviation` as a share, beyond `tolerance`: WARN, and beyond `error_factor` times it: ERROR.
HealthLevel levelOf(double deviation, double tolerance, double error_factor)
{
  const double size = std::abs(deviation) / tolerance;
  return size > error_factor ? HealthLevel::ERROR : size > 1.0 ? HealthLevel::WARN : HealthLevel::OK;
}

MeasuredFriction measuredFriction(const JointEvidence& evidence, const Parameters& parameters,
                                  const JointContext& context)
{
  const FrictionFactor factor = frictionFactor(evidence, context);
  const bool fits = whyItDoesNotFit(evidence, parameters, context).empty();
  return { fits && factor.isJudged() ? std::make_optional(factor.value) : std::nullopt,
           evidence.temperature(),
           evidence.reach().temperature_rows > 0,
           [&evidence](double temperature) { return evidence.twinFrictionAt(temperature); },
           context.misfit.empty() && factor.is_below_faults,
           context.misfit.empty() && factor.gap == FrictionGap::NO_FRICTION };
}

Verdict judge(const JointEvidence& evidence, const Parameters& parameters, const JointContext& context)
{
  Verdict verdict;
  verdict.findings = { judgeFriction(evidence, parameters, context), judgeTorsion(evidence, parameters, context.own),
                       judgeSignals(evidence, context) };
  const std::string why_not = whyItDoesNotFit(evidence, parameters, context);
  for (Finding& finding : verdict.findings)
  {
    if (!why_not.empty())
    {
      finding = { HealthLevel::OK, false, finding.title, why_not, {} };
    }
    verdict.level = std::max(verdict.level, finding.level);
    verdict.judged = verdict.judged || finding.judged;
  }
  verdict.reason = reasonOf(verdict);
  verdict.highest_order = highestOrder(evidence, context.duration);
  verdict.cannot_show = cannotShow(evidence, parameters, context);
  return verdict;
}
}  // namespace hjt
