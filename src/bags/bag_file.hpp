// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <rosbag/bag.h>

namespace hjt
{
/// Checks the records of a bag before the rosbag library reads them: the library trusts every length, index position
/// and message offset in the file, and reads beyond its buffers where one is damaged.
///
/// Reads the whole file once. Bags that were not closed are left to the library, which refuses them; encrypted ones
/// too.
/// @throws InputError naming the file, the damage and its position [byte].
void checkBagFile(const std::string& path);

/// Opens a bag for reading. @throws InputError that says what is wrong with the file.
void openForReading(rosbag::Bag& bag, const std::string& path);

/// @throws InputError if the bag holds one of the topics: its messages would look like the twin's.
void refuseTopics(const rosbag::Bag& bag, const std::string& path, const std::vector<std::string>& topics);

/// All topics of a bag and their types, one a line.
std::string listTopics(const rosbag::Bag& bag);
}  // namespace hjt
