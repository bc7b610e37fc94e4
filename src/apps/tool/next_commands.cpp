// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tool/next_commands.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "base/number_text.hpp"
#include "recordings/comparison_files.hpp"

namespace hjt
{
namespace
{
/// As a shell takes it for one word.
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
}  // namespace

std::vector<std::string> nextCommands(const ArmOptions& options, const CheckedArm& arm)
{
  const bool is_mended = !arm.tried.empty() && arm.tried.front().helps;
  // Last, and in place of what it mends.
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
}  // namespace hjt
