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
/// Torques and faults that a bag holds as inputs of the twin.
struct BagInputs
{
  std::vector<TwinInput> inputs;   ///< ordered by stamp; inputs with equal stamps are in the order of the bag
  std::uint64_t without_effort{};  ///< number of stamped messages that name the joint, but lack its effort
  std::uint64_t damaged{};         ///< number of messages that cannot be decoded
  /// Number of faults of unknown kind or with values out of range, which are not among the inputs.
  std::uint64_t refused_faults{};
  std::set<std::string> other_joints;  ///< joints in stamped messages that do not name the joint of the twin
};

/// Reads the input topics in `joint_namespace`. A stamped message takes effect at its stamp, another message at its
/// time of recording. @throws InputError if a topic has another type, or if a stamp is far from the time of recording.
BagInputs readBagInputs(const rosbag::Bag& bag, const std::string& joint_namespace, const Parameters& parameters);

/// Names of the twin's input topics in `joint_namespace`.
std::vector<std::string> inputTopics(const std::string& joint_namespace);
std::vector<std::string> outputTopics(const std::string& joint_namespace);
}  // namespace hjt
