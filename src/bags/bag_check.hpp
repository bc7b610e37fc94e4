// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace hjt
{
/// Checks the records of a bag before the rosbag library reads them: the library trusts every length, index position
/// and message offset in the file, and reads beyond its buffers where one is damaged.
///
/// Reads the whole file once. Bags that were not closed are left to the library, which refuses them; encrypted ones
/// too.
/// @throws InputError naming the file, the damage and its position [byte].
void checkBagFile(const std::string& path);
}  // namespace hjt
