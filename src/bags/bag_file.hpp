// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <rosbag/bag.h>

namespace hjt
{
/// Checks the records of a bag before the rosbag library reads them. The library does not check lengths, positions of
/// indexes and offsets of messages. In a damaged file, it reads beyond its buffers.
///
/// The function reads the whole file once. It does not check bags that were not closed or are encrypted, because the
/// library rejects them.
/// @throws InputError with the name of the file, the damage and its position [byte].
void checkBagFile(const std::string& path);

/// Opens a bag for reading. @throws InputError with the reason if this fails.
void openForReading(rosbag::Bag& bag, const std::string& path);

/// @throws InputError if the bag has one of the topics. Their messages could be confused with those of the twin.
void refuseTopics(const rosbag::Bag& bag, const std::string& path, const std::vector<std::string>& topics);

/// Text that lists all topics of a bag with their types, one per line.
std::string listTopics(const rosbag::Bag& bag);
}  // namespace hjt
