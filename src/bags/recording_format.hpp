// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace hjt
{
/// Format of a recording, by its first bytes and not by its name.
enum class RecordingFormat
{
  BAG,        ///< of ROS 1
  DATABASE,   ///< SQLite, a .db3 of rosbag2
  MCAP,       ///< .mcap
  DIRECTORY,  ///< of rosbag2, with such files
  TABLE       ///< text: a CSV file
};

/// @throws InputError if the file cannot be read, or is of a format that nothing here reads: it names the format and
/// what converts it.
RecordingFormat formatOfRecording(const std::string& path);

/// @throws InputError if it is a file of messages, which hold no targets: `wanted` is read of a table.
void requireTable(const std::string& path, const std::string& wanted);

/// The sentence to end an error of a ROS 2 file with: how to make a bag of it.
std::string conversionOf(const std::string& path);
}  // namespace hjt
