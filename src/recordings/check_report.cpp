// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/recording_check.hpp"

#include <algorithm>
#include <cctype>
#include <functional>
#include <string_view>

#include "base/number_text.hpp"
#include "output/report.hpp"
#include "recordings/recording_comparison.hpp"

namespace hjt
{
namespace
{
/// The text as one word of a shell command, in quotes if the shell needs them.
std::string shellWord(const std::string& text)
{
  const auto is_plain = [](char c)
  {
    return static_cast<unsigned char>(c) > 127 || std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("_./:=@%+,-").find(c) != std::string_view::npos;
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), is_plain))
  {
    return text;
  }
  std::string quoted = "'";
  for (const char c : text)
  {
    quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return quoted + "'";
}

const std::vector<Column<RecordingFinding>> FINDING_COLUMNS{ { "kind", &RecordingFinding::kind },
                                                             { "text", &RecordingFinding::text },
                                                             { "stops", [](const RecordingFinding& finding)
                                                               { return finding.stops.has_value(); } } };

const std::vector<Column<CheckedJoint>> CHECKED_JOINT_COLUMNS{
  { "name", &CheckedJoint::name },
  { "joint", &CheckedJoint::joint },
  { "rows", [](const CheckedJoint& joint) { return joint.reach.rows; } },
  { "least_angle", [](const CheckedJoint& joint) { return joint.reach.least_angle; } },
  { "most_angle", [](const CheckedJoint& joint) { return joint.reach.most_angle; } },
  { "least_speed", [](const CheckedJoint& joint) { return joint.reach.least_speed; } },
  { "most_speed", [](const CheckedJoint& joint) { return joint.reach.most_speed; } },
  { "least_current", [](const CheckedJoint& joint) { return joint.reach.least_current; } },
  { "most_current", [](const CheckedJoint& joint) { return joint.reach.most_current; } },
  { "has_velocity", &CheckedJoint::has_velocity },
  { "torque_per_current", &CheckedJoint::gain },
  { "torque_per_current_stated", &CheckedJoint::stated_gain },
  { "time_factor", [](const CheckedJoint& joint) { return joint.time_factor.value; } },
  { "velocity_lag", [](const CheckedJoint& joint) { return joint.lag.value; } },
  { "judged", [](const CheckedJoint& joint) { return joint.verdict.isJudged(); } },
  { "verdict", [](const CheckedJoint& joint) { return verdictFields(joint.verdict); } },
  { "findings", [](const CheckedJoint& joint) { return Table(FINDING_COLUMNS, joint.findings).rows(); } }
};

const std::vector<Column<ArmFit>> RANKING_COLUMNS{ { "arm", &ArmFit::arm },
                                                   { "effort",
                                                     [](const ArmFit& fit) { return effortKeyword(fit.unit); } },
                                                   { "left", &ArmFit::left },
                                                   { "cost", &ArmFit::cost } };

const std::vector<Column<TriedRemedy>> TRIED_COLUMNS{ { "options", [](const TriedRemedy& remedy)
                                                        { return remedy.options.substr(1); } },
                                                      { "before", &TriedRemedy::before },
                                                      { "after", &TriedRemedy::after },
                                                      { "helps", &TriedRemedy::helps } };

Json documentOf(const RecordingCheck& check, const CheckedArm& arm)
{
  const auto of = [](const auto& found, auto member) { return found ? Json(std::invoke(member, *found)) : Json(); };
  return Json{ { "recording", check.options.recording },
               { "prefix", arm.affixes.prefix },
               { "suffix", arm.affixes.suffix },
               { "rows", arm.found.rows },
               { "duration", arm.found.duration },
               { "period", arm.timing.period },
               { "missing", arm.timing.missing },
               { "gaps", arm.found.gaps },
               { "refused", arm.found.refused },
               { "unreadable", arm.found.corrupt },
               { "remarks", arm.found.remarks },
               { "arms", arm.fitting },
               { "ranking", Table(RANKING_COLUMNS, arm.ranked).rows() },
               { "arms_alike", arm.alike() },
               { "arm", arm.taken.empty() ? Json() : Json(arm.taken) },
               { "missing_joints", arm.missing },
               { "load", arm.taken.empty() ? "unknown" : "arm" },
               { "load_recorded", arm.found.has_load },
               { "temperature", check.contents.temperature.empty() ? Json() : Json(check.contents.temperature) },
               { "stamp_factor", arm.stamps.value },
               { "stamp_factor_uncertainty", arm.stamps.uncertainty },
               { "payload_mass", of(arm.assumed.payload, &IdentifiedPayload::mass) },
               { "payload_half_width", of(arm.assumed.payload, &IdentifiedPayload::mass_half_width) },
               { "gravity", of(arm.assumed.mounting, &IdentifiedMounting::gravity) },
               { "gravity_tilt", of(arm.assumed.mounting, &IdentifiedMounting::tilt) },
               { "gravity_half_width", of(arm.assumed.mounting, &IdentifiedMounting::half_width) },
               { "drag", of(arm.assumed.drag, &FoundDrag::force) },
               { "drag_half_width", of(arm.assumed.drag, &FoundDrag::half_width) },
               { "effort_factor", arm.effort.factor.value },
               { "effort_factor_uncertainty", arm.effort.factor.uncertainty },
               { "effort", arm.effort.is_known ? Json(effortKeyword(arm.effort.unit)) : Json() },
               { "findings", Table(FINDING_COLUMNS, arm.findings).rows() },
               { "tried", Table(TRIED_COLUMNS, arm.tried).rows() },
               { "joints", Table(CHECKED_JOINT_COLUMNS, arm.joints).rows() },
               { "usable", arm.isUsable() },
               { "next", nextCommands(check, arm) } };
}

}  // namespace

std::vector<std::string> nextCommands(const RecordingCheck& check, const CheckedArm& arm)
{
  const RecordingOptions& options = check.options;
  if (options.rows)
  {
    return {};  // a recording in memory has no file to name in a command
  }
  const bool is_mended = !arm.tried.empty() && arm.tried.front().helps;
  // The option of the remedy is the last one, so that it overrides or replaces an option for the same value.
  const std::string remedy = is_mended ? arm.tried.front().options : "";
  std::string reading = optionsOf(arm.affixes);
  if (options.time_scale != 1.0 && remedy.find("--time-scale") == std::string::npos)
  {
    reading += " --time-scale " + roundedText(options.time_scale, 6);
  }
  if (!options.config_dir.empty())
  {
    reading += " --config-dir " + shellWord(options.config_dir);
  }
  for (const std::string& config : options.configs)
  {
    reading += " --config " + shellWord(config);
  }
  for (const std::string& assignment : options.assignments)
  {
    reading += " --set " + shellWord(assignment);
  }
  if (options.topic != DEFAULT_TOPIC)
  {
    reading += " --topic " + shellWord(options.topic);
  }
  const std::string file = shellWord(options.recording);
  if (arm.taken.empty())
  {
    const auto joint = std::find_if(arm.joints.begin(), arm.joints.end(),
                                    [](const CheckedJoint& one) { return one.verdict.isJudged(); });
    return joint == arm.joints.end() ?
               std::vector<std::string>() :
               std::vector<std::string>{ "joint_twin compare " + file + " --joint " + shellWord(joint->name) + reading +
                                         " --report report" };
  }
  if (!arm.isUsable() && !is_mended)
  {
    return {};
  }
  const std::string with = " --arm " + shellWord(arm.taken) + reading + remedy;
  return { (is_mended ? "joint_twin check " : "joint_twin identify ") + file + with +
               (is_mended ? "" : " --out my_arm"),
           "joint_twin compare " + file + with + " --report report",
           "joint_twin follow " + file + with + " --out rows" };
}

Json documentOf(const RecordingCheck& check)
{
  Json document = documentOf(check, check.arms.front());
  std::vector<Json> others;
  for (std::size_t i = 1; i < check.arms.size(); ++i)
  {
    others.push_back(documentOf(check, check.arms[i]));
  }
  document["other_arms"] = others;
  return document;
}
}  // namespace hjt
