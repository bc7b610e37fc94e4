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
/// Torques and faults recorded in a bag.
struct BagInputs
{
  std::vector<TwinInput> inputs;   ///< ordered by stamp; equal stamps in the order of the bag
  std::uint64_t without_effort{};  ///< number of stamped messages that name the joint without an effort
  std::uint64_t damaged{};         ///< number of messages that cannot be decoded
  std::uint64_t refused_faults{};  ///< number of faults of unknown kind or out of range, which are not among the inputs
  std::set<std::string> other_joints;  ///< joints in stamped messages that do not name this joint
};

/// Reads the input topics in `joint_namespace`. Stamped messages count at the stamp of their header, others at their
/// time of recording.
/// @throws InputError if a topic has another type, or a stamp is far from the time of recording.
BagInputs readBagInputs(const rosbag::Bag& bag, const std::string& joint_namespace, const Parameters& parameters);

/// Names of the twin's input topics in `joint_namespace`.
std::vector<std::string> inputTopics(const std::string& joint_namespace);
std::vector<std::string> outputTopics(const std::string& joint_namespace);
}  // namespace hjt
