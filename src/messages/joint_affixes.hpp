// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace hjt
{
/// Prefix and suffix of an arm's joint names in messages, for example "left_" and "".
struct JointAffixes
{
  std::string prefix;
  std::string suffix;

  std::string operator()(const std::string& joint) const { return prefix + joint + suffix; }
  bool operator==(const JointAffixes& other) const { return prefix == other.prefix && suffix == other.suffix; }
  bool empty() const { return prefix.empty() && suffix.empty(); }
};

/// The affixes as options of a command, for example " --prefix left_ --suffix _r"; empty if both affixes are empty.
std::string optionsOf(const JointAffixes& affixes);

/// Finds all affixes with which `names` contains all of `joints`. The affixes are in the order of the names.
std::vector<JointAffixes> findAffixes(const std::vector<std::string>& joints, const std::vector<std::string>& names);

/// The names without those of motors. In messages on a single joint, `NAME_motor` is the motor of joint NAME.
std::vector<std::string> withoutMotors(const std::vector<std::string>& names);

/// Clause that lists the joints that `names` lacks, and options that would find them; empty if none is missing.
std::string lackText(const std::vector<std::string>& joints, const std::vector<std::string>& names);
}  // namespace hjt
