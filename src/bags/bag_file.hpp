// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <rosbag/bag.h>

namespace hjt
{
/// Checks the records of a bag before the rosbag library reads them. The library does not check lengths, index
/// positions and message offsets, and reads beyond its buffers in a damaged file.
///
/// The function reads the whole file once. It does not check bags that were not closed, and encrypted ones; the library
/// rejects them.
/// @throws InputError with the file, the damage and its position [byte].
void checkBagFile(const std::string& path);

/// Opens a bag for reading. @throws InputError with the reason.
void openForReading(rosbag::Bag& bag, const std::string& path);

/// @throws InputError if the bag contains one of the topics, whose messages could be mistaken for the twin's.
void refuseTopics(const rosbag::Bag& bag, const std::string& path, const std::vector<std::string>& topics);

/// Text of all topics of a bag with their types, one per line.
std::string listTopics(const rosbag::Bag& bag);
}  // namespace hjt
