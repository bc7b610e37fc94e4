// SPDX-License-Identifier: BSD-3-Clause
#include "messages/joint_affixes.hpp"

#include <algorithm>

#include "base/text.hpp"

namespace hjt
{
namespace
{
std::string lacking(const std::vector<std::string>& joints, const std::vector<std::string>& names,
                    const JointAffixes& affixes)
{
  std::vector<std::string> lack;
  for (const std::string& joint : joints)
  {
    if (!holds(names, affixes(joint)))
    {
      lack.push_back(affixes(joint));
    }
  }
  return joined(lack);
}
}  // namespace

std::string optionsOf(const JointAffixes& affixes)
{
  return (affixes.prefix.empty() ? std::string() : " --prefix " + affixes.prefix) +
         (affixes.suffix.empty() ? std::string() : " --suffix " + affixes.suffix);
}

std::vector<JointAffixes> findAffixes(const std::vector<std::string>& joints, const std::vector<std::string>& names)
{
  std::vector<JointAffixes> found;
  const std::string& first = joints.front();
  for (const std::string& name : names)
  {
    for (std::size_t at = name.find(first); at != std::string::npos; at = name.find(first, at + 1))
    {
      const JointAffixes affixes{ name.substr(0, at), name.substr(at + first.size()) };
      const bool is_new = std::find(found.begin(), found.end(), affixes) == found.end();
      if (is_new && lacking(joints, names, affixes).empty())
      {
        found.push_back(affixes);
      }
    }
  }
  return found;
}

std::vector<std::string> withoutMotors(const std::vector<std::string>& names)
{
  const std::string motor = "_motor";
  std::vector<std::string> joints;
  for (const std::string& name : names)
  {
    const bool is_motor = name.size() > motor.size() &&
                          name.compare(name.size() - motor.size(), motor.size(), motor) == 0 &&
                          holds(names, name.substr(0, name.size() - motor.size()));
    if (!is_motor)
    {
      joints.push_back(name);
    }
  }
  return joints;
}

std::string lackText(const std::vector<std::string>& joints, const std::vector<std::string>& names)
{
  const std::string lack = lacking(joints, names, {});
  if (lack.empty())
  {
    return {};
  }
  std::string text = lack + " not among the joints " + joined(names);
  for (const JointAffixes& affixes : findAffixes(joints, names))
  {
    text += "; with" + (affixes.prefix.empty() ? std::string() : " prefix " + affixes.prefix) +
            (affixes.suffix.empty() ? std::string() : " suffix " + affixes.suffix) + " all joints are found";
  }
  return text;
}
}  // namespace hjt
