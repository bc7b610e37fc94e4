// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <ros/names.h>
#include <ros/this_node.h>

#include "arm/arm_description.hpp"

namespace hjt
{
/// Name of a joint of an arm in the graph: NAMESPACE/SHORT_NAME/NODE. Its topics lie below.
inline std::string jointName(const ArmJoint& joint)
{
  const std::string& name = ros::this_node::getName();
  const std::string node = name.substr(name.rfind('/') + 1);
  return ros::names::append(ros::names::parentNamespace(name), joint.short_name + "/" + node);
}
}  // namespace hjt
