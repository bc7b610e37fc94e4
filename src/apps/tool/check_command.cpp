// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "apps/common/library_command.hpp"
#include "output/process_end.hpp"
#include "output/report.hpp"
#include "recordings/recording_check.hpp"

#include "base/number_text.hpp"
#include "base/text.hpp"

namespace hjt
{
namespace
{
bool stops(const std::vector<RecordingFinding>& findings)
{
  return std::any_of(findings.begin(), findings.end(),
                     [](const RecordingFinding& finding) { return finding.stops.has_value(); });
}

/// Text of a percentage, never in scientific notation.
std::string percentText(double share)
{
  const double percent = 100.0 * share;
  return (percent < 99.5 ? roundedText(percent, 2) : fixedText(percent, 0)) + " %";
}

std::string textOfLoad(const CheckedArm& arm)
{
  if (!arm.missing.empty())
  {
    return "unknown: the recording lacks the angle or the effort of " + joined(arm.missing);
  }
  if (arm.taken.empty())
  {
    return "unknown: no arm in config/arms has these joints; name the file of your own arm with --arm (docs/arm.md)";
  }
  return std::string("computed from the angles of all joints, the arm's links and the payload") +
         (arm.found.has_load ? "; the recording has a load too" : "");
}

std::string textOfArm(const RecordingOptions& options, const CheckedContents& contents, const CheckedArm& arm)
{
  const std::string names = arm.affixes.empty() ? "" : ", its joints with" + optionsOf(arm.affixes);
  if (!options.arm.empty())
  {
    return options.arm + names;
  }
  if (arm.taken.empty())
  {
    return "not known; the recording has the joints " + joined(contents.named);
  }
  std::string text = arm.taken + names + " of " + std::to_string(arm.fitting.size()) + " arms that fit";
  const auto left = [](const ArmFit& fit) { return percentText(fit.left); };
  const auto taken =
      std::find_if(arm.ranked.begin(), arm.ranked.end(), [&](const ArmFit& fit) { return fit.arm == arm.taken; });
  const auto other =
      std::find_if(arm.ranked.begin(), arm.ranked.end(), [&](const ArmFit& fit) { return fit.arm != arm.taken; });
  text += ": its best load leaves " + left(*taken) + " of the currents unexplained";
  text += other == arm.ranked.end() ? "" : ", that of " + other->arm + " " + left(*other);
  const std::vector<std::string> alike = arm.alike();
  return text + (alike.empty() ?
                     "" :
                     ". The currents do not distinguish this arm from " + joined(alike) + ". Name your arm with --arm");
}

std::string textOfEffort(const CheckedContents& contents, const CheckedArm& arm)
{
  if (arm.joints.empty())
  {
    const bool names_them =
        std::any_of(arm.missing.begin(), arm.missing.end(),
                    [&](const std::string& name)
                    { return std::find(contents.named.begin(), contents.named.end(), name) != contents.named.end(); });
    return contents.usable.empty() || names_them ?
               "none: " +
                   (contents.named.empty() ? std::string() :
                    contents.has_angles    ? "the messages name joints, but their effort is empty; " :
                                             "the messages name joints, but their position is empty; ") +
                   "the angles have to be recorded as position, the motors' currents as effort" :
               "none for the joints of the arm; the messages name the joints " + joined(contents.usable) +
                   ". The arm's file must have the joint names of the messages (docs/arm.md)";
  }
  const EffortFit& effort = arm.effort;
  const std::string factor = roundedText(effort.factor.value, 3);
  if (!std::isfinite(effort.factor.value))
  {
    return std::string("assumed to be ") + effortUnitName(arm.configured_effort) +
           ", as configured, because the load varies too little to determine the unit";
  }
  return effort.is_known && effort.unit == arm.configured_effort ?
             std::string(effortUnitName(effort.unit)) + "; with the load it changes " + factor +
                 " times as much as predicted" :
             "changes with the load " + factor + " times as much as " + effortUnitName(arm.configured_effort) +
                 " would";
}

/// Text with the gains that the recording states.
std::string textOfGains(const CheckedArm& arm)
{
  std::string text;
  for (const CheckedJoint& joint : arm.joints)
  {
    if (std::isfinite(joint.stated_gain))
    {
      text += (text.empty() ? "" : ", ") + joint.name + " " + roundedText(joint.stated_gain, 4);
    }
  }
  return text + " N.m/A, as the controller states them";
}

std::string textOfStamps(const CheckedArm& arm)
{
  const std::string rate = arm.timing.period > 0.0 ? roundedText(1.0 / arm.timing.period, 4) + " Hz" :
                           arm.found.rows == 0     ? std::string("no usable row") :
                                                     std::string("one row");
  return rate + ", " + std::to_string(arm.timing.missing) + " missing, " + std::to_string(arm.found.gaps) + " gaps, " +
         std::to_string(arm.found.refused) + " repeated or out of order, " + std::to_string(arm.found.corrupt) +
         " unreadable";
}

std::string textOfVelocities(const CheckedArm& arm)
{
  if (std::isfinite(arm.stamps.value))
  {
    const bool fit = std::none_of(arm.findings.begin(), arm.findings.end(),
                                  [](const RecordingFinding& finding) { return finding.kind == "stamps"; });
    return (fit ? "fit: " : "do not fit: ") + std::string("the angles change ") + roundedText(arm.stamps.value, 4) +
           " times as fast as the velocities say";
  }
  const bool has =
      std::any_of(arm.joints.begin(), arm.joints.end(), [](const CheckedJoint& joint) { return joint.has_velocity; });
  const bool is_known = std::any_of(arm.joints.begin(), arm.joints.end(),
                                    [](const CheckedJoint& joint) { return std::isfinite(joint.time_factor.value); });
  return !has     ? "none are recorded, so the stamps cannot be checked" :
         is_known ? "do not fit the angles; the table of the joints says how" :
                    "too little motion to compare them with the angles";
}

void printLine(const char* label, const std::string& text)
{
  printWrapped(std::string(label) + std::string(12 - std::string(label).size(), ' ') + text, 0);
}

/// Text of a finding on the joint; "fits" if the joint has no finding.
std::string textOfFinding(const CheckedArm& arm, const CheckedJoint& joint)
{
  const auto first = std::find_if(joint.findings.begin(), joint.findings.end(),
                                  [](const RecordingFinding& finding) { return finding.stops.has_value(); });
  if (first != joint.findings.end())
  {
    return first->text;
  }
  if (stops(arm.findings))
  {
    return "see ERROR above";
  }
  return joint.findings.empty() ? (joint.verdict.isJudged() ? "fits" : "not judged, see below") :
                                  joint.findings.front().text;
}

void printJoints(const CheckedArm& arm)
{
  std::size_t width = 7;
  for (const CheckedJoint& joint : arm.joints)
  {
    width = std::max(width, joint.name.size());
  }
  const int columns = static_cast<int>(width);
  std::printf("\n%-*s  %15s  %7s  %16s  velocity  finding\n", columns, "joint", "moves [rad]", "[rad/s]",
              "current [A]");
  for (const CheckedJoint& joint : arm.joints)
  {
    const JointReach& reach = joint.reach;
    const auto number = [](double value) { return fixedText(value, 2); };
    std::printf("%-*s  %6s to %5s  %7s  %6s to %6s  %-8s  %s\n", columns, joint.name.c_str(),
                number(reach.least_angle).c_str(), number(reach.most_angle).c_str(),
                number(std::max(reach.most_speed, -reach.least_speed)).c_str(), number(reach.least_current).c_str(),
                number(reach.most_current).c_str(), joint.has_velocity ? "yes" : "no",
                textOfFinding(arm, joint).c_str());
  }
  std::cout << '\n';
}

/// Joints that are not judged, all for the same reason.
struct OpenJoints
{
  std::vector<std::string> names;
  std::string text;  ///< text of the reason; without numbers if the joints have different ones
};

/// Prints which joints will have a verdict, and why the other joints will have none.
void printJudged(const CheckedArm& arm)
{
  std::vector<std::string> judged;
  std::map<std::string, OpenJoints> open;
  for (const CheckedJoint& joint : arm.joints)
  {
    if (joint.verdict.isJudged())
    {
      judged.push_back(joint.name);
      continue;
    }
    const Finding& finding = joint.verdict.findings.front();
    const bool is_said = stops(arm.findings) || stops(joint.findings);
    const std::string text = is_said ? "for the reason above" : findingText(joint.verdict, finding);
    OpenJoints& alike = open[is_said ? "" : reasonName(finding.reason)];
    const bool differs = !alike.names.empty() && alike.text != text;
    alike.text = differs ? text.substr(0, text.find(": ")) : text;
    alike.names.push_back(joint.name);
  }
  printLine("judged", judged.empty() ? "nothing" : "friction and current of " + joined(judged));
  for (const auto& [reason, joints] : open)
  {
    printLine("not judged", joined(joints.names) + ": " + joints.text);
  }
}

void printArm(const RecordingCheck& check, const CheckedArm& arm)
{
  const RecordingOptions& options = check.options;
  const CheckedContents& contents = check.contents;
  std::cout << std::flush;
  printLine("recording", options.recording + ": " + std::to_string(arm.found.rows) + " rows in " +
                             roundedText(arm.found.duration, 4) + " s" + (contents.is_csv ? "" : ", " + options.topic));
  printLine("arm", textOfArm(options, contents, arm));
  printLine("rows", textOfStamps(arm));
  for (const std::string& remark : arm.found.remarks)
  {
    printLine("read", remark);
  }
  printLine("velocities", textOfVelocities(arm));
  printLine("effort", textOfEffort(contents, arm));
  if (std::any_of(arm.joints.begin(), arm.joints.end(),
                  [](const CheckedJoint& joint) { return std::isfinite(joint.stated_gain); }))
  {
    printLine("gains", textOfGains(arm));
  }
  printLine("load", textOfLoad(arm));
  printLine("temperature", contents.temperature.empty() ?
                               (arm.joints.empty() ? std::string("not recorded") :
                                                     "not recorded; " + roundedText(arm.temperature, 3) +
                                                         " degC is assumed, as configured") :
                               contents.temperature);
  for (const RecordingFinding& finding : arm.findings)
  {
    printLine(finding.stops ? "ERROR" : "NOTE", finding.text);
  }
  if (const std::string assumed = arm.assumed.text(); !assumed.empty())
  {
    printLine("NOTE", assumed);
  }
  for (const TriedRemedy& remedy : arm.tried)
  {
    printLine("tried", remedy.options.substr(1) + ": the load leaves " + percentText(remedy.after) +
                           " of the currents unexplained" +
                           (std::isfinite(remedy.before) ? " instead of " + percentText(remedy.before) : "") +
                           (remedy.helps ? "" : "; the tried options do not help"));
  }
  std::cout << std::flush;
  if (!arm.joints.empty())
  {
    printJoints(arm);
    std::fflush(stdout);
  }
  printJudged(arm);
  const std::vector<std::string> next = nextCommands(check, arm);
  for (const std::string& command : next)
  {
    std::cout << (&command == &next.front() ? "next        " : "            ") << command << '\n';
  }
}

int check(const Printed<RecordingOptions>& given)
{
  Printed<RecordingOptions> options = given;
  options.watch = readingWatch();
  const RecordingCheck check = checkRecording(options);
  if (given.json)
  {
    std::cout << documentOf(check).dump() << '\n';
  }
  else
  {
    for (const CheckedArm& arm : check.arms)
    {
      std::cout << (&arm == &check.arms.front() ? "" : "\n");
      printArm(check, arm);
    }
  }
  return check.isUsable() ? EXIT_DONE : EXIT_FAILED;
}

const Subcommand CHECK{ Subject::RECORDING, "check",
                        "show usable and contradictory signals of an arm's recording, and the next command",
                        declarePrinted<RecordingOptions>, check };
}  // namespace
}  // namespace hjt
