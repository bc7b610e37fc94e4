// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace hjt
{
/// Prefix and suffix of the joints' names in messages: "left_", "".
struct JointAffixes
{
  std::string prefix;
  std::string suffix;

  std::string operator()(const std::string& joint) const { return prefix + joint + suffix; }
  bool operator==(const JointAffixes& other) const { return prefix == other.prefix && suffix == other.suffix; }
  bool empty() const { return prefix.empty() && suffix.empty(); }
};

/// " --prefix left_ --suffix _r", as options of a command; empty: none is needed.
std::string optionsOf(const JointAffixes& affixes);

/// Those with which all of `joints` are in `names`, in the order of the names.
std::vector<JointAffixes> findAffixes(const std::vector<std::string>& joints, const std::vector<std::string>& names);

/// Of the sensors of one joint, `NAME_motor` is that of joint NAME: the names without those.
std::vector<std::string> withoutMotors(const std::vector<std::string>& names);

/// The joints of `joints` that messages with `names` lack, as a clause, and the prefix or suffix that would find them,
/// spelled as options; empty: they name all.
std::string lackText(const std::vector<std::string>& joints, const std::vector<std::string>& names);
}  // namespace hjt
