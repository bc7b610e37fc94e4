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

std::string causeNames(const Finding& finding, const char* separator)
{
  return joined(finding.causes, separator, [](const WeightedCause& cause) { return causeName(cause.cause); });
}

std::string wrongEffortText(double current, double predicted, Reason reason)
{
  if (reason == Reason::EFFORT_NOT_CURRENT)
  {
    if (current > 0.5 * predicted)
    {
      return "The recorded effort has the opposite sign of the current that this motion needs: the sign of effort or "
             "angle is wrong, or the load (mounting, payload) is not as configured.";
    }
    return "The recorded effort is " + fixedText(current, 2) + " A rms, but this motion needs some " +
           fixedText(predicted, 2) + " A: the effort is not the motor's current.";
  }
  return "The recorded effort is " + fixedText(current / predicted, 1) +
         " times the current that this motion needs: the effort is in N.m in place of A, or "
         "telemetry.torque_per_current is wrong.";
}

/// Sentence that says why the torsion, the signals or all subjects of a joint are not judged.
std::string reasonText(const Verdict& verdict, Reason reason)
{
  switch (reason)
  {
    case Reason::LOAD_WRONG:
      if (!verdict.misfit.empty())
      {
        break;
      }
      return "The current is " + fixedText(verdict[Figure::CURRENT], 2) +
             " A rms. The prediction, another friction "
             "and a constant load do not explain " +
             fixedText(verdict[Figure::CURRENT_UNEXPLAINED], 2) + " A rms of it: " + wrongLoad(verdict.load);
    case Reason::EFFORT_NOT_CURRENT:
    case Reason::EFFORT_TOO_LARGE:
      return wrongEffortText(verdict[Figure::CURRENT], verdict[Figure::CURRENT_PREDICTED], reason);
    case Reason::COMMON_FRICTION:
      return "The friction of the whole arm is " + fixedText(verdict[Figure::FRICTION_OF_ARM], 2) +
             " times that of the reference: the signals have another temperature or gain than those of the reference.";
    case Reason::NO_MOTOR_ANGLE:
      return "The recording has one angle for each joint, but torsion needs encoders at the motor and at the output.";
    case Reason::LOAD_CONSTANT:
      return "The load hardly varies, so the stiffness of the drive cannot be measured.";
    case Reason::TOO_FEW_WINDOWS:
      return "A verdict needs " + whole(verdict[Figure::WINDOWS_NEEDED]) +
             " windows at one operating point, but the recording has " + whole(verdict[Figure::WINDOWS_HERE]) + ".";
    case Reason::NO_REFERENCE:
      return "No window of the recording is at an operating point of the reference.";
    case Reason::TOO_SHORT:
      return "No reference was given, and the recording is too short to learn a reference, which needs " +
             whole(verdict[Figure::WINDOWS_NEEDED]) + " windows at one operating point.";
    case Reason::TORSION_NO_DRIVE:
      return "The torsion is " + fixedText(verdict[Figure::TORSION_OF_TWIN], 2) +
             " times that of the twin, which no fault explains: the load or the angles are not those of this joint, "
             "or a sign is wrong.";
    case Reason::SOLVER_FAILED:
      return "The solver did not converge, so the twin holds its last good state.";
    case Reason::LOAD_UNKNOWN:
      return "The load is unknown.";
    case Reason::TELEMETRY_UNSETTLED:
      return "The program does not know yet whether angles and efforts fit together.";
    default:  // verdict.misfit describes all other reasons
      break;
  }
  return sentence(verdict.misfit);
}

std::string torsionText(const Verdict& verdict, const Finding& finding)
{
  const double to_own = verdict[Figure::TORSION_OF_OWN];
  const bool known = std::isfinite(to_own);
  const double value = known ? to_own : verdict[Figure::TORSION_OF_TWIN];
  // At least two digits, and as many as show on which side of the bound the value lies.
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
    text += possibleFaults(verdict, finding) + " Other possible causes: a wrong load, eccentric encoders.";
  }
  const double alike = verdict[Figure::ENCODER_ERROR];
  const double share = verdict[Figure::ENCODER_SHARE];
  if (std::isfinite(alike) && finding.level != VerdictLevel::OK)
  {
    text += " An error of the output encoder once a turn, of amplitude " + fixedText(1e3 * alike, 2) +
            " mrad or more, would have the same effect: sensors.output_eccentricity is " +
            fixedText(1e3 * verdict[Figure::ENCODER_ECCENTRICITY], 2) + " mrad.";
  }
  if (share > 0.01)
  {
    text += " " + fixedText(share, 2) +
            " of the tolerance covers the encoders' eccentricity. A recording of the sound joint (--reference) would "
            "make the tolerance narrower.";
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
    return whole(verdict[Figure::WINDOWS]) + " windows were compared with " + reference +
           ", and no window differs from it by more than sound windows do.";
  }
  std::string text =
      "From " + fixedText(verdict[Figure::ALARM_TIME], 1) + " s on the signals depart from " + reference +
      (finding.causes.empty() ? ". The cause is not known" : ". The likeliest cause is " + causeNames(finding, ", ")) +
      ". The strongest deviations are: ";
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

struct FigureEntry
{
  const char* name;
  const char* unit;
};

/// Names and units of the figures, in the order of Figure.
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

/// Names of the reasons, in the order of Reason.
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

std::string possibleFaults(const Verdict& verdict, const Finding& finding)
{
  return !verdict.has_signatures ? "" :
         finding.causes.empty()  ? " No fault that the program knows has this effect." :
                                   " Possible faults: " + causeNames(finding, ", ") + ".";
}

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
          title + " (" + (finding.causes.empty() ? "no known fault causes this change" : causeNames(finding, " or ")) +
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
                         "These are as in a sound joint: " + joined(sound) + "." +
                             (open.empty() ? "" : " The motion does not show: " + joined(open) + ".");
}

std::vector<std::string> cannotShow(const JointEvidence& evidence, const Verdict& verdict)
{
  constexpr double MIN_LOADING = 0.035;  // least range of the load that shows faults under load, over the limit [-]
  const MotionReach& reach = evidence.reach();
  const double speeds = verdict[Figure::SPEEDS];
  const bool is_both_ways = verdict[Figure::LOWEST_SPEED] < 0.0 && verdict[Figure::HIGHEST_SPEED] > 0.0;
  const double loading = reach.most_load - reach.least_load;
  std::vector<std::string> texts;
  const auto add = [&](bool is_hidden, const std::string& text)
  {
    if (is_hidden)
    {
      texts.push_back(text);
    }
  };
  add(reach.motor_rows == 0,
      "Torsion, stiffness, lost motion, kinematic error and ratcheting. The recording has one angle for each joint, "
      "but these results need the angle of the motor too.");
  add(evidence.loadOrigin() == LoadOrigin::ARM,
      "Whether the payload is as configured, and whether something presses on the arm all the time. No torque was "
      "recorded, and a wrong payload or this pressing only changes the current.");
  add(evidence.loadOrigin() == LoadOrigin::CONFIGURED,
      "Whether the load is as configured, because no load was recorded. The twin uses the configured weight and "
      "inertia. A payload that the configuration lacks only changes the current.");
  add(!evidence.isTemperatureReceived(),
      "Whether the temperature changed the friction, because no temperature was recorded. Each kelvin changes the "
      "friction of the grease by some per cent.");
  add(!evidence.baselineGiven(),
      "A fault that existed from the first window, because no reference of this joint was given. An effect larger "
      "than the differences between sound joints of one kind is still found.");
  add(reach.touched_rows > 0,
      "What the joint did during a contact and shortly after it: " + whole(verdict[Figure::TOUCHED_ROWS]) + " of " +
          whole(verdict[Figure::ROWS]) + " rows do not count. In the strongest contact " +
          contactText(evidence.contact().largest()) + ".");
  add(speeds > 0.0 && !is_both_ways,
      "Whether friction or a wrong load explains the current, because the joint moves in one direction only.");
  add(speeds < 3.0, "How friction depends on the speed, because the rows have fewer than three speeds.");
  add(loading < MIN_LOADING * evidence.parameters().output.load_torque_limit,
      "Faults that show under load only, such as softening and cracks, because the load varies by no more than " +
          fixedText(loading, 1) + " N.m.");
  add(verdict[Figure::HIGHEST_ORDER] > 0.0,
      "Lines above order " + fixedText(verdict[Figure::HIGHEST_ORDER], 1) +
          " per turn of the motor at the highest speed, because the recording has too few rows in a turn. Slower "
          "motion would show more of these lines.");
  return texts;
}

const char* reasonName(Reason reason) noexcept
{
  return REASONS[static_cast<std::size_t>(reason)];
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
