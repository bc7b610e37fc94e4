// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/compare.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <utility>

#include <spawn.h>
#include <sys/wait.h>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "output/output_file.hpp"
#include "params/configuration_files.hpp"
#include "recordings/arm_recording.hpp"
#include "recordings/recording_comparison.hpp"
#include "tracking/sound_joint.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

void refuseReferenceAsReport(const ComparisonOptions& options)
{
  for (const std::string& reference : options.references)
  {
    std::error_code error;
    if (fs::equivalent(options.report, reference, error))
    {
      throw InputError("--report and --reference are the same directory: the reference would be lost");
    }
  }
}

/// Refuses a reference that is a report on another shipped arm. A file of the user's own may describe any arm.
void refuseReferenceOfOtherArm(const ComparisonOptions& options)
{
  const auto is_name = [](const std::string& arm) { return arm.find_first_of("./") == std::string::npos; };
  for (const std::string& reference : options.references)
  {
    const std::string arm = armOfReport(reference);
    if (is_name(arm) && is_name(options.arm) && arm != options.arm)
    {
      throw InputError("--reference " + reference + " is a report on the arm " + arm + ", not on " + options.arm);
    }
  }
}

/// `value`, or none if the friction of the joint is not judged.
std::optional<double> number(const ComparedJoint& line, double value)
{
  return line.friction ? std::make_optional(value) : std::nullopt;
}

std::string soundText(const ComparedJoint& line)
{
  return line.friction ? fixedText(line.verdict[Figure::FRICTION_LOWEST], 2) + " to " +
                             fixedText(line.verdict[Figure::FRICTION_HIGHEST], 2) :
                         "-";
}

const std::vector<Column<ComparedJoint>> ARM_COLUMNS{
  { "joint", &ComparedJoint::name, "joint" },
  { "level", [](const ComparedJoint& line) { return levelName(line.verdict.level); }, "verdict" },
  { "verdict", [](const ComparedJoint& line) { return verdictFields(line.verdict); } },
  { "friction_ratio", [](const ComparedJoint& line) { return number(line, line.verdict.friction.factor); } },
  { "friction_low", [](const ComparedJoint& line) { return number(line, line.verdict.friction.lower); } },
  { "friction_high", [](const ComparedJoint& line) { return number(line, line.verdict.friction.upper); } },
  { "friction", [](const ComparedJoint& line) { return line.friction ? factorText(line.verdict.friction) : "-"; },
    "friction [95 %]" },
  { "friction_sound", soundText, "sound" },
  { "friction_shared", [](const ComparedJoint& line) { return number(line, line.verdict[Figure::FRICTION_OF_ARM]); } },
  { "temperature", &ComparedJoint::temperature, "at [degC]" },
  { "temperature_source", [](const ComparedJoint& line) { return line.temperature_source; }, "which is" },
  { "current_rms", &ComparedJoint::current_rms, "current, rms [A]" },
  { "current_residual_rms", &ComparedJoint::residual_rms, "less predicted [A]" }
};

/// Sentence on the common factor of a group's friction; empty if this factor is unknown or close to 1.
std::string groupText(const JointGroup& group, const std::vector<ComparedJoint>& lines)
{
  constexpr double NOTEWORTHY = 0.1;
  constexpr double MOST = 2.5;  // largest factor of friction that temperature or lubricant causes [-]
  if (!group.is_known || std::abs(group.median - 1.0) < NOTEWORTHY)
  {
    return {};
  }
  return "The friction of " + lines[group.begin].name + " to " + lines[group.end - 1].name + " together is " +
         fixedText(group.median, 2) + " times the expected friction. The reason is " +
         (std::abs(std::log(group.median)) < std::log(MOST) ?
              "another temperature or lubricant of these joints" :
              "that arm, gain or unit of the currents is not the configured one") +
         ", not a fault of one joint. ";
}

/// Sentences on every joint that differs from a sound joint or is not judged.
std::string departuresOf(const std::vector<ComparedJoint>& lines)
{
  std::string text;
  std::vector<std::pair<std::string, std::vector<std::string>>> unjudged;  // reason, and joints with this reason
  bool departs = false;
  bool judged = false;
  for (const ComparedJoint& line : lines)
  {
    judged = judged || line.verdict.isJudged();
    if (severityOf(line.verdict.level) != HealthLevel::OK)
    {
      text += line.name + ": " + verdictText(line.verdict) + " ";
      departs = true;
    }
    if (!line.verdict.isJudged())
    {
      const std::string why = findingText(line.verdict, line.verdict.findings.front());
      const auto same =
          std::find_if(unjudged.begin(), unjudged.end(), [&](const auto& one) { return one.first == why; });
      (same == unjudged.end() ? unjudged.emplace_back(why, std::vector<std::string>()) : *same)
          .second.push_back(line.name);
    }
    else if (!line.contact.empty())
    {
      text += line.name + ": " + line.contact + " The verdict uses only the rows without this contact. ";
    }
  }
  text += judged && !departs ? "No joint differs from a sound joint. " : "";
  for (const auto& [why, joints] : unjudged)
  {
    text += "Not judged: " + joined(joints) + ". " + why + " ";
  }
  return text;
}

/// Sentence that names the joints whose friction is judged, but not with the user's reference.
std::string withoutReference(const std::vector<ComparedJoint>& lines)
{
  std::vector<std::string> names;
  for (const ComparedJoint& line : lines)
  {
    if (line.friction && line.friction->reference != FrictionReference::OWN)
    {
      names.push_back(line.name);
    }
  }
  return names.empty() ?
             std::string() :
             "The reference did not judge the friction of " + joined(names) + ". The twin's friction replaces it. ";
}

/// Sentence on the common factors by which the friction of joints is divided before the verdict. The sentence names
/// only the factors that differ from `of_whole_arm`, the factor of the whole arm.
std::string sharedText(const std::vector<ComparedJoint>& lines, double of_whole_arm)
{
  std::vector<std::pair<std::string, std::vector<std::string>>> shares;  // factor, and joints with this factor
  for (const ComparedJoint& line : lines)
  {
    constexpr double NOTEWORTHY = 0.02;
    const double of_arm = line.verdict[Figure::FRICTION_OF_ARM];
    if (line.friction && std::abs(of_arm - 1.0) >= NOTEWORTHY && std::abs(of_arm - of_whole_arm) >= NOTEWORTHY)
    {
      const std::string share = fixedText(of_arm, 2);
      const auto same = std::find_if(shares.begin(), shares.end(), [&](const auto& one) { return one.first == share; });
      (same == shares.end() ? shares.emplace_back(share, std::vector<std::string>()) : *same)
          .second.push_back(line.name);
    }
  }
  const auto one = [](const auto& share) { return share.first + " (" + joined(share.second) + ")"; };
  return shares.empty() ? std::string() :
                          "Before the verdict, the friction of joints is divided by their common factor: " +
                              joined(shares, ", ", one) + " times the reference's friction. ";
}

/// Sentences on common factors of friction, and on each joint that differs from a sound joint or is not judged.
std::string textOf(const std::vector<ComparedJoint>& lines, const ArmFriction& arm, bool has_reference)
{
  std::string text;
  if (arm.median != 1.0)
  {
    text = "The friction of the whole arm is " + shortNumber(0.01 * std::round(100.0 * arm.median)) +
           " times that of the reference. The reason is another temperature or gain than in the reference, "
           "not a fault of one joint. ";
    if (arm.temperature)
    {
      text += "By the twin's law of friction, this factor means " + shortNumber(std::round(*arm.temperature)) +
              " degC in place of " + shortNumber(std::round(lines.front().temperature)) + " degC. ";
    }
  }
  for (const JointGroup& group : arm.groups)
  {
    text += groupText(group, lines);
  }
  text += sharedText(lines, arm.median);
  text += departuresOf(lines) + (has_reference ? withoutReference(lines) : "");
  text.pop_back();
  return text;
}

/// Sets level and text of an arm from those of its joints. `misfits` has the misfit of each joint's rows.
void judgeArm(const std::vector<Misfit>& misfits, bool has_reference, ComparedRecording& compared)
{
  for (const ComparedJoint& joint : compared.joints)
  {
    compared.health = std::max(compared.health, severityOf(joint.verdict.level));
    compared.is_judged = compared.is_judged || joint.verdict.isJudged();
    compared.not_judged += joint.verdict.isJudged() ? 0 : 1;
  }
  compared.level = compared.is_judged ? levelName(compared.health) : levelName(VerdictLevel::NOT_JUDGED);
  const bool same = misfits.front().exists() &&
                    std::all_of(misfits.begin(), misfits.end(),
                                [&](const Misfit& misfit) { return misfit.clause == misfits.front().clause; });
  compared.text = compared.assumed.text() +
                  (same ? sentence(misfits.front().clause) : textOf(compared.joints, compared.friction, has_reference));
}

Json documentOfArm(const ComparisonOptions& options, const ComparedRecording& compared)
{
  double temperatures = 0.0;
  for (const ComparedJoint& joint : compared.joints)
  {
    temperatures += joint.temperature;
  }
  const auto of = [](const auto& found, auto member) { return found ? Json(std::invoke(member, *found)) : Json(); };
  return { { "recording", options.recording },
           { "arm", options.arm },
           { "made_with", MADE_WITH },
           { "level", compared.level },
           { "joints_not_judged", compared.not_judged },
           { "text", compared.text },
           { "load", options.load },
           { "temperature", temperatures / static_cast<double>(compared.joints.size()) },
           { "temperature_estimate", compared.friction.temperature },
           { "rows", compared.found.rows },
           { "duration", compared.found.duration },
           { "friction_ratio", compared.friction.median },
           { "payload_mass", of(compared.assumed.payload, &IdentifiedPayload::mass) },
           { "payload_half_width", of(compared.assumed.payload, &IdentifiedPayload::mass_half_width) },
           { "gravity", of(compared.assumed.mounting, &IdentifiedMounting::gravity) },
           { "gravity_tilt", of(compared.assumed.mounting, &IdentifiedMounting::tilt) },
           { "gravity_half_width", of(compared.assumed.mounting, &IdentifiedMounting::half_width) },
           { "drag", of(compared.assumed.drag, &FoundDrag::force) },
           { "drag_half_width", of(compared.assumed.drag, &FoundDrag::half_width) },
           { "joints", tableOf(compared).rows() } };
}

/// Directory of a joint's report or reference. `whole`: directory of the report or reference of the whole arm.
std::string directoryOf(const ArmRecording& recording, const std::string& whole, std::size_t joint)
{
  return recording.isArm() && !whole.empty() ? (fs::path(whole) / recording.joints()[joint].short_name).string() :
                                               whole;
}

/// Prepares the directories of the reports. The second reading of a recording overwrites files of the first reading.
void prepareReports(const ComparisonOptions& options, const ArmRecording& recording)
{
  if (recording.isArm())
  {
    refuseReferenceOfOtherArm(options);
  }
  if (options.report.empty())
  {
    return;
  }
  if (recording.isArm())
  {
    prepareReport(options.report, ARM_FILE, options.force);
  }
  for (std::size_t i = 0; i < recording.joints().size(); ++i)
  {
    prepareReport(directoryOf(recording, options.report, i), COMPARISON_FILE, options.force);
  }
}

std::unique_ptr<RecordingComparison> prepareJoint(const ComparisonOptions& options, const ArmRecording& recording,
                                                  std::size_t joint)
{
  std::vector<std::string> references;
  for (const std::string& reference : options.references)
  {
    references.push_back(directoryOf(recording, reference, joint));
  }
  return std::make_unique<RecordingComparison>(recording, joint, directoryOf(recording, options.report, joint),
                                               readSoundJoint(references, recording.parameters(joint)));
}

/// Compares the recording. Writes the data of the pages into options.report, unless options.report is empty.
ComparedRecording compareInto(const ComparisonOptions& options)
{
  refuseReferenceAsReport(options);
  ArmRecording recording(options);
  prepareReports(options, recording);
  ComparedRecording compared;
  std::vector<RecordingComparison*> joints(recording.joints().size());  // joints at the last reading of the recording
  AssessmentSettings settings;
  settings.make_joint = [&](std::size_t i)
  {
    std::unique_ptr<RecordingComparison> joint = prepareJoint(options, recording, i);
    joints[i] = joint.get();
    return joint;
  };
  settings.beside_controller = options.beside_controller;
  settings.gives_notice = true;
  RecordingFit fit(recording.parameters());
  const ArmAssessment arm = assess(recording, settings, fit);
  compared.is_arm = recording.isArm();
  compared.found = arm.found;
  compared.friction = arm.judged.common;
  compared.assumed = arm.assumed;
  if (options.watch.stopped())
  {
    return compared;
  }
  for (std::size_t i = 0; i < joints.size(); ++i)
  {
    ComparedJoint& joint = compared.joints.emplace_back(joints[i]->write(arm.found, arm.context(i)));
    joint.name = recording.joints()[i].short_name;
  }
  if (recording.isArm())
  {
    judgeArm(arm.judged.misfits, !options.references.empty(), compared);
    compared.document = documentOfArm(options, compared);
    if (!options.report.empty())
    {
      writeTextFile((fs::path(options.report) / ARM_FILE).string(), compared.document.dump() + "\n");
    }
  }
  else
  {
    const Verdict& verdict = compared.joints.front().verdict;
    compared.level = levelName(verdict.level);
    compared.is_judged = verdict.isJudged();
    compared.not_judged = verdict.isJudged() ? 0 : 1;
    compared.health = severityOf(verdict.level);
    compared.text = verdictText(verdict);
    compared.document = compared.joints.front().document;
  }
  return compared;
}
}  // namespace

void addOptions(OptionTable& table, ComparisonOptions& options)
{
  addRecordingOption(table, options);
  addJointOptions(table, options);
  table
      .add("--report", options.report,
           "directory for the page, its figures and data, with a folder for each joint of an arm; default: no page")
      .type("DIR");
  addReferenceOption(table, options);
}

void addReferenceOption(OptionTable& table, ComparisonOptions& options)
{
  table
      .add("--reference", options.references, "earlier reports of this joint or arm in sound condition, for comparison")
      .follow()
      .type("DIR")
      .existingDirectory();
}

void makePage(const std::string& directory)
{
  constexpr const char* PYTHON = "/usr/bin/python3";
  std::string script = (packageDirectory() / "scripts/comparison_page.py").string();
  std::string python = PYTHON;
  std::string argument = directory;
  std::array<char*, 4> arguments{ python.data(), script.data(), argument.data(), nullptr };
  pid_t child{};
  const int refused = posix_spawn(&child, PYTHON, nullptr, nullptr, arguments.data(), environ);
  int status = 0;
  if (refused == 0)
  {
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
    {
    }
  }
  if (refused != 0 || status != 0)
  {
    throw InputError("the script that makes the page failed" +
                     (refused != 0 ? ": " + std::string(PYTHON) + ": " + std::strerror(refused) : std::string()) +
                     "; the data are in " + directory + ", and `" + python + " " + script + " " + directory +
                     "` makes the page from the data");
  }
}

ComparedRecording compare(const ComparisonOptions& options)
{
  ComparedRecording compared = compareInto(options);
  if (!compared.joints.empty() && !options.report.empty())
  {
    compared.page = (fs::path(options.report) / REPORT_PAGE).string();
    makePage(options.report);
  }
  return compared;
}

Table tableOf(const ComparedRecording& compared)
{
  return Table(ARM_COLUMNS, compared.joints);
}
}  // namespace hjt
