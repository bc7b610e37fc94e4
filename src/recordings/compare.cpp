// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/compare.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "output/temporary_directory.hpp"
#include "output/text_table.hpp"
#include "recordings/comparison_pass.hpp"
#include "recordings/report_page.hpp"

#include "base/joined.hpp"
#include "base/number_text.hpp"
#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "messages/topics.hpp"

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

template <typename Member>
std::optional<double> number(const ComparedJoint& line, Member member)
{
  return line.friction ? std::make_optional(std::invoke(member, *line.friction)) : std::nullopt;
}

const std::vector<Column<ComparedJoint>> ARM_COLUMNS{
  { "joint", &ComparedJoint::name, "joint" },
  { "level", [](const ComparedJoint& line) { return levelName(line.verdict.level); }, "verdict" },
  { "verdict", [](const ComparedJoint& line) { return verdictFields(line.verdict); } },
  { "friction_ratio", [](const ComparedJoint& line) { return number(line, &FrictionFactor::value); } },
  { "friction_low", [](const ComparedJoint& line) { return number(line, &FrictionFactor::low); } },
  { "friction_high", [](const ComparedJoint& line) { return number(line, &FrictionFactor::high); } },
  { "friction", [](const ComparedJoint& line) { return line.friction ? factorText(*line.friction) : "-"; },
    "friction [95 %]" },
  { "temperature", &ComparedJoint::temperature, "at [degC]" },
  { "temperature_source", [](const ComparedJoint& line) { return line.temperature_source; }, "which is" },
  { "current_rms", &ComparedJoint::current_rms, "current, rms [A]" },
  { "current_residual_rms", &ComparedJoint::residual_rms, "less predicted [A]" }
};

/// What the joints of a group have in common, if that is worth a word.
std::string groupText(const JointGroup& group, const std::vector<ComparedJoint>& lines)
{
  constexpr double NOTEWORTHY = 0.1;
  if (!group.is_known || std::abs(group.median - 1.0) < NOTEWORTHY)
  {
    return {};
  }
  return "Friction of " + lines[group.begin].name + " to " + lines[group.end - 1].name + " together is " +
         fixedText(group.median, 2) +
         " times the expected one: another temperature or lubricant of these, not a fault of one joint. ";
}

/// Every joint that departs or is not judged, and why.
std::string departuresOf(const std::vector<ComparedJoint>& lines)
{
  std::string text;
  std::vector<std::pair<std::string, std::vector<std::string>>> unjudged;  // reason, joints
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
      text += line.name + ": " + line.contact + " Judged by the rest. ";
    }
  }
  text += judged && !departs ? "No joint departs from a sound one. " : "";
  for (const auto& [why, joints] : unjudged)
  {
    text += "Not judged: " + joined(joints) + ". " + why + " ";
  }
  return text;
}

/// Joints that are judged, but not against the reference that was given.
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
             "The reference did not judge the friction of " + joined(names) + "; the twin is taken in its place. ";
}

/// What the joints have in common, and each that departs or is not judged.
std::string textOf(const std::vector<ComparedJoint>& lines, const ArmFriction& arm, bool has_reference)
{
  std::string text;
  if (arm.median != 1.0)
  {
    text = "Friction of the whole arm is " + shortNumber(0.01 * std::round(100.0 * arm.median)) +
           " times the reference's: another temperature or gain, not a fault of one joint. ";
    if (arm.temperature)
    {
      text += "By the twin's law of friction this is " + shortNumber(std::round(*arm.temperature)) +
              " degC in place of " + shortNumber(std::round(lines.front().temperature)) + " degC. ";
    }
  }
  for (const JointGroup& group : arm.groups)
  {
    text += groupText(group, lines);
  }
  text += departuresOf(lines) + (has_reference ? withoutReference(lines) : "");
  text.pop_back();
  return text;
}

/// Level and text of an arm by those of its joints. `misfits`: why the rows of each say nothing.
void judgeArm(const std::vector<Misfit>& misfits, bool has_reference, ComparedRecording& compared)
{
  for (const ComparedJoint& joint : compared.joints)
  {
    compared.health = std::max(compared.health, severityOf(joint.verdict.level));
    compared.is_judged = compared.is_judged || joint.verdict.isJudged();
  }
  compared.level = compared.is_judged ? levelName(compared.health) : levelName(VerdictLevel::NOT_JUDGED);
  const bool same = misfits.front().exists() &&
                    std::all_of(misfits.begin(), misfits.end(),
                                [&](const Misfit& misfit) { return misfit.clause == misfits.front().clause; });
  compared.text = (compared.payload ? sentence(compared.payload->text()) + " The joints are judged with it. " : "") +
                  (same ? sentence(misfits.front().clause) : textOf(compared.joints, compared.friction, has_reference));
}

Json documentOfArm(const ComparisonOptions& options, const ComparedRecording& compared)
{
  double temperatures = 0.0;
  for (const ComparedJoint& joint : compared.joints)
  {
    temperatures += joint.temperature;
  }
  return { { "recording", options.recording },
           { "arm", options.arm },
           { "made_with", MADE_WITH },
           { "level", compared.level },
           { "text", compared.text },
           { "load", options.load },
           { "temperature", temperatures / static_cast<double>(compared.joints.size()) },
           { "temperature_estimate", compared.friction.temperature },
           { "rows", compared.found.rows },
           { "duration", compared.found.duration },
           { "friction_ratio", compared.friction.median },
           { "payload_mass", compared.payload ? std::make_optional(compared.payload->mass) : std::nullopt },
           { "payload_half_width",
             compared.payload ? std::make_optional(compared.payload->mass_half_width) : std::nullopt },
           { "joints", tableOf(compared).rows() } };
}

/// Of the currents less what is predicted, as torques of all joints, rms [N.m].
double residualTorque(const ArmRecording& recording, const ComparisonPass& pass)
{
  double squares = 0.0;
  for (std::size_t i = 0; i < pass.joints.size(); ++i)
  {
    squares +=
        std::pow(recording.parameters(i).telemetry.torque_per_current * pass.joints[i]->evidence().residualRms(), 2);
  }
  return std::sqrt(squares);
}

/// The same if all currents are the best multiple of what is predicted [N.m].
double residualOfGain(const ArmRecording& recording, const ComparisonPass& pass)
{
  double measured = 0.0;
  double predicted = 0.0;
  double both = 0.0;
  for (std::size_t i = 0; i < pass.joints.size(); ++i)
  {
    const JointEvidence& evidence = pass.joints[i]->evidence();
    const double weight = std::pow(recording.parameters(i).telemetry.torque_per_current, 2);
    const double of_measured = weight * std::pow(evidence.currentRms(), 2);
    const double of_predicted = weight * std::pow(evidence.predictedRms(), 2);
    measured += of_measured;
    predicted += of_predicted;
    both += 0.5 * (of_measured + of_predicted - weight * std::pow(evidence.residualRms(), 2));
  }
  return predicted > 0.0 ? std::sqrt(std::max(0.0, measured - both * both / predicted)) : std::sqrt(measured);
}

/// A payload is the reason only if every joint fits with it, and clearly better than without; where the friction of the
/// whole arm is another with it, also clearly better than another gain.
bool explains(const ArmRecording& recording, double residual_before, double residual_of_gain,
              const ComparisonPass& with)
{
  constexpr double CLEARLY = 0.9;
  const auto fits = [](const std::unique_ptr<JointComparison>& joint)
  { return !joint->friction({}).is_below_faults && joint->frictionReason() != Reason::LOAD_WRONG; };
  const double bound = with.friction.median == 1.0 ? residual_before : std::min(residual_before, residual_of_gain);
  return std::all_of(with.joints.begin(), with.joints.end(), fits) && residualTorque(recording, with) < CLEARLY * bound;
}

/// With the payload that the currents show where that explains them.
ComparisonPass passWithPayload(const ComparisonOptions& options, ArmRecording& recording, ComparedRecording& compared)
{
  ComparisonPass pass = passThrough(options, recording);
  if (!pass.payload || !pass.payload->isCarried())
  {
    return pass;
  }
  const IdentifiedPayload payload = *pass.payload;
  const double residual = residualTorque(recording, pass);
  const double residual_of_gain = residualOfGain(recording, pass);
  recording.setPayload(payload.payload());
  pass.joints.clear();  // closes the files that the next pass opens
  pass = passThrough(options, recording);
  if (explains(recording, residual, residual_of_gain, pass) || options.watch.stopped())
  {
    compared.payload = payload;
    return pass;
  }
  recording.setPayload(payload.configured);
  pass.joints.clear();
  return passThrough(options, recording);
}

/// With its data in `options.report`.
ComparedRecording compareInto(const ComparisonOptions& options)
{
  refuseReferenceAsReport(options);
  ArmRecording recording(options);
  ComparedRecording compared;
  ComparisonPass pass = passWithPayload(options, recording, compared);
  compared.is_arm = recording.isArm();
  compared.found = pass.found;
  compared.friction = pass.friction;
  if (options.watch.stopped())
  {
    return compared;
  }
  for (std::size_t i = 0; i < pass.joints.size(); ++i)
  {
    ComparedJoint& joint = compared.joints.emplace_back(pass.joints[i]->write(
        pass.found, pass.friction, pass.misfits[i], recording.twinNamespace(i) + "/" + topics::JOINT_STATES));
    joint.name = recording.joints()[i].short_name;
  }
  if (recording.isArm())
  {
    judgeArm(pass.misfits, !options.references.empty(), compared);
    compared.document = documentOfArm(options, compared);
    writeTextFile((fs::path(options.report) / ARM_FILE).string(), compared.document.dump() + "\n");
  }
  else
  {
    const Verdict& verdict = compared.joints.front().verdict;
    compared.level = levelName(verdict.level);
    compared.is_judged = verdict.isJudged();
    compared.health = severityOf(verdict.level);
    compared.text = verdictText(verdict);
    compared.document = compared.joints.front().document;
  }
  return compared;
}
}  // namespace

ComparedRecording compare(const ComparisonOptions& options)
{
  if (options.report.empty())
  {
    const TemporaryDirectory directory;
    ComparisonOptions passing = options;
    passing.report = directory.path();
    return compareInto(passing);
  }
  ComparedRecording compared = compareInto(options);
  if (!compared.joints.empty())
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
