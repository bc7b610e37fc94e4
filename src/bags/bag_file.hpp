// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <rosbag/bag.h>

namespace hjt
{
/// Opens a bag for reading. @throws InputError that says what is wrong with the file.
void openForReading(rosbag::Bag& bag, const std::string& path);

/// @throws InputError if the bag holds one of the topics: its messages would look like the twin's.
void refuseTopics(const rosbag::Bag& bag, const std::string& path, const std::vector<std::string>& topics);

/// All topics of a bag and their types, one a line.
std::string listTopics(const rosbag::Bag& bag);
}  // namespace hjt
