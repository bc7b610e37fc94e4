// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include <rosbag/bag.h>

#include "messages/conversions.hpp"
#include "messages/time.hpp"

namespace hjt
{
/// The torques and faults recorded in a bag.
struct BagInputs
{
  std::vector<TwinInput> inputs;       ///< by stamp; equal stamps in the order of the bag
  std::uint64_t without_effort{};      ///< stamped messages that name the joint but give no effort for it
  std::uint64_t damaged{};             ///< messages whose bytes cannot be read
  std::uint64_t refused_faults{};      ///< of unknown kind, or out of range: not among the inputs
  std::set<std::string> other_joints;  ///< joints named in stamped messages that do not name this one
};

/// Reads the input topics below `joint_namespace`. Stamped messages count at their header stamp, others at the time
/// they were recorded.
/// @throws InputError if a topic has another type, or a stamp is far from the time of recording.
BagInputs readBagInputs(const rosbag::Bag& bag, const std::string& joint_namespace, const Parameters& parameters);

/// The names under which the twin's inputs and outputs go below `joint_namespace`.
std::vector<std::string> inputTopics(const std::string& joint_namespace);
std::vector<std::string> outputTopics(const std::string& joint_namespace);
}  // namespace hjt
