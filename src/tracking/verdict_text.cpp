// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <string>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
namespace
{
std::string whole(double value)
{
  return fixedText(value, 0);
}

std::string wrongLoadText(const Verdict& verdict)
{
  return "Of " + fixedText(verdict[Figure::CURRENT], 2) + " A rms " +
         fixedText(verdict[Figure::CURRENT_UNEXPLAINED], 2) +
         " A are neither predicted nor explained by another friction or a constant: " + wrongLoad(verdict.load);
}

std::string wrongEffortText(double current, double predicted, Reason reason)
{
  if (reason == Reason::EFFORT_NOT_CURRENT)
  {
    if (current > 0.5 * predicted)
    {
      return "The recorded effort goes against the current that this motion takes: effort or angle of this joint is "
             "of the opposite sign, or its load is another than configured (mounting, payload).";
    }
    return "The recorded effort is " + fixedText(current, 2) + " A rms where this motion takes some " +
           fixedText(predicted, 2) + " A: it is not the motor's current.";
  }
  return "The recorded effort is " + fixedText(current / predicted, 1) +
         " times the current that this motion takes: it is expected in A, not in N.m; or telemetry.torque_per_current "
         "is wrong.";
}

/// Of torsion or signals that are not judged, or of all.
std::string reasonText(const Verdict& verdict, Reason reason)
{
  switch (reason)
  {
    case Reason::LOAD_WRONG:
      return verdict.misfit.empty() ? wrongLoadText(verdict) : sentence(verdict.misfit);
    case Reason::EFFORT_NOT_CURRENT:
    case Reason::EFFORT_TOO_LARGE:
      return wrongEffortText(verdict[Figure::CURRENT], verdict[Figure::CURRENT_PREDICTED], reason);
    case Reason::COMMON_FRICTION:
      return "The friction of the whole arm is " + fixedText(verdict[Figure::FRICTION_OF_ARM], 2) +
             " times that of the reference: its signals are of another temperature or gain.";
    case Reason::NO_MOTOR_ANGLE:
      return "One angle a joint: torsion needs encoders at the motor and at the output.";
    case Reason::LOAD_CONSTANT:
      return "The load hardly varies, so the stiffness of the drive cannot be measured.";
    case Reason::TOO_FEW_WINDOWS:
      return "Too few windows: a verdict needs " + whole(verdict[Figure::WINDOWS_NEEDED]) +
             " at one operating point, has " + whole(verdict[Figure::WINDOWS_HERE]) + ".";
    case Reason::NO_REFERENCE:
      return "No window of the recording is at an operating point that the reference knows.";
    case Reason::TOO_SHORT:
      return "No reference was given, and the recording is too short to learn one (" +
             whole(verdict[Figure::WINDOWS_NEEDED]) + " windows at one operating point).";
    case Reason::TORSION_NO_DRIVE:
      return "Torsion is " + fixedText(verdict[Figure::TORSION_OF_TWIN], 2) +
             " times the twin's, which no fault makes: load, or the angles of motor and joint, are not this joint's, "
             "or "
             "of other signs.";
    case Reason::SOLVER_FAILED:
      return "The solver did not converge: the last good state is held.";
    case Reason::LOAD_UNKNOWN:
      return "The load is unknown.";
    case Reason::TELEMETRY_UNSETTLED:
      return "Whether angles and efforts fit is not known yet.";
    case Reason::SOUND:
    case Reason::FRICTION:
    case Reason::TORSION:
    case Reason::SIGNALS:
    case Reason::CONTACT:
    case Reason::ROW_RATE:
    case Reason::STAMPS:
    case Reason::ANGLE_UNIT:
    case Reason::EFFORT_UNIT:
    case Reason::EFFORT_CONSTANT:
    case Reason::VELOCITY_SIGN:
    case Reason::VELOCITY_SCALE:
    case Reason::VELOCITY_LAG:
    case Reason::TWO_SOURCES:
    case Reason::GEAR_RATIO:
    case Reason::NO_FRICTION:
    case Reason::LESS_THAN_FAULTS:
    case Reason::FRICTION_SCATTER:
    case Reason::NO_STEADY_MOTION:
    case Reason::AT_REST:
    case Reason::ONE_SPEED:
    case Reason::ONE_DIRECTION:
      break;
  }
  return sentence(verdict.misfit);
}

std::string causeNames(const Finding& finding, const char* separator)
{
  return joined(finding.causes, separator, [](const WeightedCause& cause) { return causeName(cause.cause); });
}

std::string torsionText(const Verdict& verdict, const Finding& finding)
{
  const double to_own = verdict[Figure::TORSION_OF_OWN];
  const bool known = std::isfinite(to_own);
  const double value = known ? to_own : verdict[Figure::TORSION_OF_TWIN];
  // As many digits as it takes to see on which side of the bound the value lies.
  const double lowest = std::max(0.0, 1.0 - verdict[Figure::TORSION_TOLERANCE]);
  const double highest = 1.0 + verdict[Figure::TORSION_TOLERANCE];
  int digits = 2;
  while (
      digits < 6 && finding.level != VerdictLevel::OK &&
      (fixedText(value, digits) == fixedText(lowest, digits) || fixedText(value, digits) == fixedText(highest, digits)))
  {
    ++digits;
  }
  std::string text = "Torsion is " + fixedText(verdict[Figure::TORSION_OF_TWIN], digits) + " times the twin's" +
                     (known ? " and " + fixedText(to_own, digits) + " times this joint's own when it was sound" : "") +
                     " (" + fixedText(lowest, digits) + " to " + fixedText(highest, digits) + " counts as sound).";
  if (finding.level != VerdictLevel::OK)
  {
    text += (!verdict.has_signatures ? std::string() :
             finding.causes.empty()  ? std::string(" No fault in the list has this effect.") :
                                       " Possible faults: " + causeNames(finding, ", ") + ".") +
            " Other causes: a wrong load, eccentric encoders.";
  }
  const double alike = verdict[Figure::ENCODER_ERROR];
  const double share = verdict[Figure::ENCODER_SHARE];
  if (std::isfinite(alike) && finding.level != VerdictLevel::OK)
  {
    text += " An error of the output encoder once a turn, of amplitude " + fixedText(1e3 * alike, 2) +
            " mrad or more, would look the same: sensors.output_eccentricity is " +
            fixedText(1e3 * verdict[Figure::ENCODER_ECCENTRICITY], 2) + " mrad.";
  }
  if (share > 0.01)
  {
    text += " " + fixedText(share, 2) +
            " of the tolerance is for the encoders' eccentricity; a recording of "
            "the sound joint (--reference) would narrow it.";
  }
  return text;
}

std::string signalsText(const Verdict& verdict, const Finding& finding)
{
  const std::string reference = verdict.is_reference_given ?
                                    "the reference given" :
                                    "the reference learned from the first windows of this recording";
  if (finding.level == VerdictLevel::OK)
  {
    return whole(verdict[Figure::WINDOWS]) + " windows compared with " + reference + ": nothing out of the ordinary.";
  }
  std::string text =
      "From " + fixedText(verdict[Figure::ALARM_TIME], 1) + " s on the signals depart from " + reference +
      (finding.causes.empty() ? ", cause not known" : ". Most likely cause: " + causeNames(finding, ", ")) +
      ". Strongest: ";
  const auto describe = [](const Evidence& evidence)
  {
    return std::string(indicatorName(evidence.indicator)) + ' ' + roundedText(evidence.value, 3) + ' ' +
           indicatorUnit(evidence.indicator) + " where " + roundedText(evidence.expected, 3) + " is sound";
  };
  return text + joined(verdict.evidence, "; ", describe) + ".";
}

std::string lowerFirst(std::string text)
{
  if (!text.empty())
  {
    text.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(text.front())));
  }
  return text;
}

std::string hiddenText(const Verdict& verdict, Hidden hidden)
{
  switch (hidden)
  {
    case Hidden::TORSION:
      break;
    case Hidden::PAYLOAD:
      return "Whether the payload is as configured, and what presses on the arm all the time: no torque was recorded; "
             "both look like current.";
    case Hidden::LOAD:
      return "Whether the load is as configured: no load was recorded, so weight and inertia of the configuration are "
             "taken; a payload left out looks like current.";
    case Hidden::TEMPERATURE:
      return "Temperature: none is recorded; grease at another one changes the friction by some per cent a kelvin.";
    case Hidden::EARLY_FAULT:
      return "A fault that was there from the first window, unless it is larger than what joints of one kind differ "
             "by: no reference of this joint was given.";
    case Hidden::CONTACT:
      return "What the joint did while something touched the arm, and shortly after: " +
             whole(verdict[Figure::TOUCHED_ROWS]) + " of " + whole(verdict[Figure::ROWS]) +
             " rows are left out. The strongest: " +
             contactText({ verdict[Figure::LARGEST_CONTACT_SINCE], verdict[Figure::LARGEST_CONTACT_LASTED],
                           verdict[Figure::LARGEST_CONTACT_TORQUE] }) +
             ".";
    case Hidden::FRICTION_FROM_LOAD:
      return "Friction apart from a load that is wrong: the joint moves one way only.";
    case Hidden::FRICTION_OVER_SPEED:
      return "How friction depends on the speed: fewer than three speeds.";
    case Hidden::LOADED:
      return "Anything that shows under load only, such as stiffness and cracks: the load varies by " +
             fixedText(verdict[Figure::MOST_LOAD] - verdict[Figure::LEAST_LOAD], 1) + " N.m.";
    case Hidden::HIGH_ORDERS:
      return "Lines above order " + fixedText(verdict[Figure::HIGHEST_ORDER], 1) +
             " of the motor's turn at the highest speed: the recording has too few rows a turn to show them; "
             "slower motion shows more.";
  }
  return "Torsion, stiffness, lost motion, kinematic error, ratcheting: the recording has one angle a joint; the "
         "motor's is needed too.";
}

struct FigureEntry
{
  const char* name;
  const char* unit;
};

/// In the order of Figure.
constexpr std::array<FigureEntry, FIGURE_COUNT> FIGURES{ { { "rows", "-" },
                                                           { "rows_touched", "-" },
                                                           { "span", "s" },
                                                           { "current_rms", "A" },
                                                           { "current_predicted_rms", "A" },
                                                           { "current_residual_rms", "A" },
                                                           { "current_unexplained_rms", "A" },
                                                           { "least_load", "N.m" },
                                                           { "most_load", "N.m" },
                                                           { "temperature", "degC" },
                                                           { "reference_temperature", "degC" },
                                                           { "highest_order", "-" },
                                                           { "friction_speeds", "-" },
                                                           { "lowest_speed", "rad/s" },
                                                           { "highest_speed", "rad/s" },
                                                           { "friction_of_twin", "-" },
                                                           { "friction_of_controller", "-" },
                                                           { "friction_of_own", "-" },
                                                           { "friction_of_arm", "-" },
                                                           { "friction_scatter", "-" },
                                                           { "friction_lowest_sound", "-" },
                                                           { "friction_highest_sound", "-" },
                                                           { "torsion_of_twin", "-" },
                                                           { "torsion_of_own", "-" },
                                                           { "torsion_tolerance", "-" },
                                                           { "torsion_tolerance_of_encoders", "-" },
                                                           { "encoder_error_alike", "rad" },
                                                           { "output_eccentricity", "rad" },
                                                           { "windows", "-" },
                                                           { "windows_here", "-" },
                                                           { "windows_needed", "-" },
                                                           { "alarm_time", "s" },
                                                           { "contact_since", "s" },
                                                           { "contact_lasted", "s" },
                                                           { "contact_torque", "N.m" },
                                                           { "largest_contact_since", "s" },
                                                           { "largest_contact_lasted", "s" },
                                                           { "largest_contact_torque", "N.m" } } };

/// In the order of Reason.
constexpr std::array<const char*, REASON_COUNT> REASONS{ "SOUND",
                                                         "FRICTION",
                                                         "TORSION",
                                                         "SIGNALS",
                                                         "SOLVER_FAILED",
                                                         "NO_STEADY_MOTION",
                                                         "ONE_DIRECTION",
                                                         "LOAD_UNKNOWN",
                                                         "LOAD_WRONG",
                                                         "CONTACT",
                                                         "EFFORT_NOT_CURRENT",
                                                         "EFFORT_TOO_LARGE",
                                                         "COMMON_FRICTION",
                                                         "TELEMETRY_UNSETTLED",
                                                         "ROW_RATE",
                                                         "STAMPS",
                                                         "ANGLE_UNIT",
                                                         "EFFORT_UNIT",
                                                         "EFFORT_CONSTANT",
                                                         "VELOCITY_SIGN",
                                                         "VELOCITY_SCALE",
                                                         "VELOCITY_LAG",
                                                         "NO_MOTOR_ANGLE",
                                                         "LOAD_CONSTANT",
                                                         "TOO_FEW_WINDOWS",
                                                         "NO_REFERENCE",
                                                         "TOO_SHORT",
                                                         "TWO_SOURCES",
                                                         "GEAR_RATIO",
                                                         "AT_REST",
                                                         "ONE_SPEED",
                                                         "NO_FRICTION",
                                                         "LESS_THAN_FAULTS",
                                                         "FRICTION_SCATTER",
                                                         "TORSION_NO_DRIVE" };
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

std::string findingText(const Verdict& verdict, const Finding& finding)
{
  if (verdict.fits && finding.subject == FindingSubject::FRICTION)
  {
    return verdict.friction_text;
  }
  if (finding.level == VerdictLevel::NOT_JUDGED)
  {
    return reasonText(verdict, finding.reason);
  }
  switch (finding.subject)
  {
    case FindingSubject::FRICTION:
      break;
    case FindingSubject::TORSION:
      return torsionText(verdict, finding);
    case FindingSubject::SIGNALS:
      return signalsText(verdict, finding);
  }
  return verdict.friction_text;
}

std::string verdictText(const Verdict& verdict)
{
  if (!verdict.fits)
  {
    const std::string text = reasonText(verdict, verdict.reason);
    return verdict.isJudged() ? text : "Not judged: " + lowerFirst(text);
  }
  std::vector<std::string> departing;
  std::vector<std::string> sound;
  std::vector<std::string> open;
  for (const Finding& finding : verdict.findings)
  {
    const std::string title = lowerFirst(subjectTitle(finding.subject));
    if (severityOf(finding.level) != HealthLevel::OK)
    {
      departing.push_back(
          title + " (" + (finding.causes.empty() ? "no fault in the list does this" : causeNames(finding, " or ")) +
          (finding.subject == FindingSubject::FRICTION && verdict.may_be_gain ? ", or a wrong gain" : "") + ")");
    }
    else
    {
      (finding.level == VerdictLevel::NOT_JUDGED ? open : sound).push_back(title);
    }
  }
  if (!departing.empty())
  {
    return "Not as in a sound joint: " + joined(departing, "; ") + ".";
  }
  return sound.empty() ? "The motion does not show whether the joint is sound. " + verdict.friction_text :
                         "As in a sound joint: " + joined(sound) + "." +
                             (open.empty() ? "" : " The motion does not show: " + joined(open) + ".");
}

std::vector<std::string> hiddenTexts(const Verdict& verdict)
{
  std::vector<std::string> texts;
  for (const Hidden hidden : verdict.cannot_show)
  {
    texts.push_back(hiddenText(verdict, hidden));
  }
  return texts;
}

const char* reasonName(Reason reason) noexcept
{
  return REASONS[static_cast<std::size_t>(reason)];
}

const char* figureName(Figure figure) noexcept
{
  return FIGURES[static_cast<std::size_t>(figure)].name;
}

const char* figureUnit(Figure figure) noexcept
{
  return FIGURES[static_cast<std::size_t>(figure)].unit;
}

const char* levelName(VerdictLevel level) noexcept
{
  return level == VerdictLevel::NOT_JUDGED ? "NOT JUDGED" : levelName(static_cast<HealthLevel>(level));
}

const char* subjectTitle(FindingSubject subject)
{
  switch (subject)
  {
    case FindingSubject::FRICTION:
      break;
    case FindingSubject::TORSION:
      return "Torsion";
    case FindingSubject::SIGNALS:
      return "Signals by windows";
  }
  return "Friction";
}

std::vector<NamedFigure> evidenceOf(const Verdict& verdict)
{
  std::vector<NamedFigure> all;
  for (std::size_t i = 0; i < FIGURE_COUNT; ++i)
  {
    if (std::isfinite(verdict.figures[i]))
    {
      all.push_back({ FIGURES[i].name, verdict.figures[i], FIGURES[i].unit });
    }
  }
  for (const Evidence& evidence : verdict.evidence)
  {
    const std::string name = indicatorName(evidence.indicator);
    all.push_back({ name, evidence.value, indicatorUnit(evidence.indicator) });
    all.push_back({ name + "_sound", evidence.expected, indicatorUnit(evidence.indicator) });
  }
  return all;
}
}  // namespace hjt
