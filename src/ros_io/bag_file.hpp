// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <rosbag/bag.h>

namespace hjt
{
/// Opens a bag for reading. @throws InputError that says what is wrong with the file.
void openForReading(rosbag::Bag& bag, const std::string& path);

/// All topics of a bag and their types, one a line.
std::string listTopics(const rosbag::Bag& bag);
}  // namespace hjt
