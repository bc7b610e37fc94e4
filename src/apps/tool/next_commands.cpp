// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tool/next_commands.hpp"

#include <algorithm>

#include "base/number_text.hpp"
#include "recordings/comparison_files.hpp"

namespace hjt
{
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
  for (const std::string& assignment : options.assignments)
  {
    reading += " --set " + assignment;
  }
  if (options.topic != DEFAULT_TOPIC)
  {
    reading += " --topic " + options.topic;
  }
  const std::string& file = options.recording;
  if (arm.taken.empty())
  {
    const auto joint = std::find_if(arm.joints.begin(), arm.joints.end(),
                                    [](const CheckedJoint& one) { return one.verdict.isJudged(); });
    return joint == arm.joints.end() ? std::vector<std::string>() :
                                       std::vector<std::string>{ "joint_twin compare " + file + " --joint " +
                                                                 joint->name + reading + " --report report" };
  }
  if (!arm.isUsable() && !is_mended)
  {
    return {};
  }
  const std::string with = " --arm " + arm.taken + reading + remedy;
  return { (is_mended ? "joint_twin check " : "joint_twin identify ") + file + with +
               (is_mended ? "" : " --out my_arm"),
           "joint_twin compare " + file + with + " --report report",
           "joint_twin follow " + file + with + " --out rows" };
}
}  // namespace hjt
