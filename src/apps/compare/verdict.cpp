// SPDX-License-Identifier: BSD-3-Clause
#include "verdict.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "harmonic_joint_twin/gear/angle.hpp"
#include "harmonic_joint_twin/gear/ratio.hpp"

namespace hjt
{
namespace
{
std::string rounded(double value, int digits)
{
  char text[40];
  std::snprintf(text, sizeof(text), "%.*f", digits, value);
  return text;
}

/// `deviation` as a share, beyond `tolerance`: WARN, and beyond `error_factor` times it: ERROR.
HealthLevel levelOf(double deviation, double tolerance, double error_factor)
{
  const double size = std::abs(deviation) / tolerance;
  return size > error_factor ? HealthLevel::ERROR : size > 1.0 ? HealthLevel::WARN : HealthLevel::OK;
}

/// The causes that move a feature this way, in words.
std::string causesOf(Feature feature, Move move)
{
  std::string text;
  for (std::size_t i = 1; i < CAUSE_COUNT; ++i)
  {
    if (expectedMove(static_cast<Cause>(i), feature) == move)
    {
      text += (text.empty() ? "" : ", ") + std::string(causeName(static_cast<Cause>(i)));
    }
  }
  return text;
}

std::string departure(const char* what, double ratio, double tolerance)
{
  return std::string(what) + " is " + rounded(ratio, 2) + " times the twin's; " + rounded(1.0 - tolerance, 2) + " to " +
         rounded(1.0 + tolerance, 2) + " is what sound joints of this kind differ by.";
}

Finding judgeFriction(const Comparison& comparison, const Parameters& parameters)
{
  Finding finding{ HealthLevel::OK, false, "Friction against the twin", "" };
  const std::vector<FrictionPoint> points = comparison.friction().points();
  if (points.empty())
  {
    finding.text = "The joint never moves steadily for long enough to tell its friction.";
    return finding;
  }
  finding.judged = true;
  const double ratio = comparison.friction().ratio();
  const double tolerance = parameters.comparison.friction_tolerance;
  finding.level = levelOf(ratio - 1.0, tolerance, parameters.indicators.error_factor);
  finding.text = departure("Friction", ratio, tolerance) + " Told at " + std::to_string(points.size()) +
                 " speeds from " + rounded(points.front().speed, 2) + " to " + rounded(points.back().speed, 2) + " rad/s.";
  if (finding.level != HealthLevel::OK)
  {
    finding.text += ratio > 1.0 ? " Faults that raise it: " + causesOf(Feature::RUNNING_TORQUE, Move::UP) +
                                      "; cold or other grease, more preload and a wrong gain do so too." :
                                  " Faults that lower it: " + causesOf(Feature::RUNNING_TORQUE, Move::DOWN) +
                                      "; warm or thinner grease, less preload and a wrong gain do so too.";
  }
  return finding;
}

Finding judgeTorsion(const Comparison& comparison, const Parameters& parameters)
{
  Finding finding{ HealthLevel::OK, false, "Torsion against the twin", "" };
  const double compliance = comparison.torsion().compliance();
  if (comparison.torsion().rows() == 0)
  {
    finding.text = "One angle a joint: torsion needs encoders at the motor and at the output.";
    return finding;
  }
  if (!std::isfinite(compliance))
  {
    finding.text = "The load hardly varies, so that nothing tells how stiff the drive is.";
    return finding;
  }
  finding.judged = true;
  // Once a turn an encoder off its axis looks like torsion under a weight.
  const double eccentricity = (parameters.sensors.output_eccentricity +
                               parameters.sensors.motor_eccentricity / nominalRatio(parameters.gear)) /
                              std::sqrt(2.0) / comparison.torsion().twinAmplitude();
  const double tolerance = parameters.comparison.compliance_tolerance + eccentricity;
  finding.level = levelOf(compliance - 1.0, tolerance, parameters.indicators.error_factor);
  finding.text = departure("Torsion", compliance, tolerance);
  if (eccentricity > 0.01)
  {
    finding.text += " Of this, " + rounded(eccentricity, 2) + " for the encoders' eccentricity (sensors).";
  }
  if (finding.level != HealthLevel::OK)
  {
    finding.text += compliance > 1.0 ? " Faults that soften the drive: " + causesOf(Feature::STIFFNESS, Move::DOWN) +
                                           "; a load that is larger than told looks alike." :
                                       " A load that is smaller than told looks like this.";
  }
  return finding;
}

Finding judgeSignals(const Comparison& comparison)
{
  Finding finding{ HealthLevel::OK, false, "Signals against the joint's reference", "" };
  const std::string reference = comparison.baselineGiven() ? "the reference given" :
                                                             "the reference learned from the first windows of this "
                                                             "recording";
  if (!comparison.worst())
  {
    finding.text = comparison.baselineGiven() ?
                       "No window of the recording is at an operating point that the reference given knows." :
                       "No reference was given, and the recording is too short to learn one (" +
                           std::to_string(comparison.assessor().baseline().windowsNeeded()) +
                           " windows at one operating point).";
    return finding;
  }
  finding.judged = true;
  const Assessment& assessment = comparison.worst()->assessment;
  finding.level = assessment.level;
  const std::string windows = std::to_string(comparison.assessedWindows()) + " windows held against " + reference;
  if (assessment.level == HealthLevel::OK)
  {
    finding.text = windows + ": nothing out of the ordinary.";
    return finding;
  }
  finding.text = "From " + rounded(comparison.alarmTime(), 1) + " s on the signals depart from " + reference +
                 ". Most likely cause: " + causeName(comparison.cause()) + ". Strongest: ";
  for (std::size_t i = 0; i < assessment.evidence_count; ++i)
  {
    const Evidence& evidence = assessment.evidence[i];
    char text[200];
    std::snprintf(text, sizeof(text), "%s%s %.3g %s where %.3g is sound", i == 0 ? "" : "; ",
                  indicatorName(evidence.indicator), evidence.value, indicatorUnit(evidence.indicator),
                  evidence.expected);
    finding.text += text;
  }
  finding.text += ".";
  return finding;
}

/// Order of the motor's turn that the rows resolve at the highest speed; 0: the joint does not move.
double highestOrder(const Comparison& comparison, double duration)
{
  constexpr double RESOLVED = 0.4;  // of the rows' rate; half of it is the limit
  double fastest = 0.0;
  for (const FrictionPoint& point : comparison.friction().points())
  {
    fastest = std::max(fastest, std::abs(point.speed));
  }
  const double turns = fastest * comparison.ratio() * duration / TWO_PI;
  return turns > 0.0 ? RESOLVED * static_cast<double>(comparison.reach().rows) / turns : 0.0;
}

std::vector<std::string> cannotShow(const Comparison& comparison, bool has_load, double duration)
{
  const MotionReach& reach = comparison.reach();
  std::vector<std::string> missing;
  if (reach.motor_rows == 0)
  {
    missing.emplace_back("Torsion, stiffness, lost motion, kinematic error, ratcheting: the recording has one angle a "
                         "joint; the motor's is needed too.");
  }
  if (!has_load)
  {
    missing.emplace_back("Whether the load is as configured: no load was recorded, so weight and inertia of the "
                         "configuration are taken; a payload left out looks like current.");
  }
  missing.emplace_back("Temperature: none is recorded; grease at another one changes the friction by some per cent a "
                       "kelvin.");
  if (!comparison.baselineGiven())
  {
    missing.emplace_back("A fault that was there from the first window, unless it is larger than what joints of one kind "
                         "differ by: no reference of this joint was given.");
  }
  if (reach.moving[0] == 0 || reach.moving[1] == 0)
  {
    missing.emplace_back("Friction apart from a load that is wrong: the joint moves one way only.");
  }
  const std::vector<FrictionPoint> points = comparison.friction().points();
  if (points.size() < 3)
  {
    missing.emplace_back("How friction depends on the speed: fewer than three speeds.");
  }
  if (reach.most_load - reach.least_load < 10.0)
  {
    missing.emplace_back("Anything that shows under load only, such as stiffness and cracks: the load varies by " +
                         rounded(reach.most_load - reach.least_load, 1) + " N.m.");
  }
  const double order = highestOrder(comparison, duration);
  if (order > 0.0)
  {
    missing.emplace_back("Lines above order " + rounded(order, 1) +
                         " of the motor's turn at the highest speed: the recording has too few rows a turn to show them; "
                         "slower motion shows more.");
  }
  return missing;
}
}  // namespace

Verdict judge(const Comparison& comparison, const Parameters& parameters, bool has_load, double duration)
{
  Verdict verdict;
  verdict.findings = { judgeSignals(comparison), judgeFriction(comparison, parameters),
                       judgeTorsion(comparison, parameters) };
  // Where the joint's own reference is there, how it differs from others of its kind is no fault.
  const bool own = comparison.baselineGiven() && verdict.findings.front().judged;
  for (std::size_t i = 1; own && i < verdict.findings.size(); ++i)
  {
    Finding& finding = verdict.findings[i];
    if (finding.level != HealthLevel::OK)
    {
      finding.level = HealthLevel::OK;
      finding.text += " Not counted: the joint's own reference is at hand.";
    }
  }
  for (const Finding& finding : verdict.findings)
  {
    verdict.level = std::max(verdict.level, finding.level);
    verdict.judged = verdict.judged || finding.judged;
  }
  verdict.highest_order = highestOrder(comparison, duration);
  verdict.cannot_show = cannotShow(comparison, has_load, duration);
  return verdict;
}
}  // namespace hjt
