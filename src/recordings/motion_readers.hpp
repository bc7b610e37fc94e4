// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "recordings/recorded_motion.hpp"

namespace hjt
{
// The kinds of recordings behind readMotion and readArmMotion; times as they are recorded.

using VisitRows = std::function<bool(const std::vector<MotionRow>& rows)>;

/// Messages: one row for each of `names`, all of one time.
MotionCount readMessageMotion(const MotionSource& source, const std::vector<std::string>& names, const VisitRows& visit,
                              const std::function<void(double)>& progress);

/// A table: the joints of these numbers in its columns.
MotionCount readTableMotion(const MotionSource& source, const std::vector<int>& numbers, const VisitRows& visit,
                            const std::function<void(double)>& progress);

/// Rows at hand, MotionSource::rows, of so many joints; times scaled.
MotionCount readArrayMotion(const MotionSource& source, std::size_t joints, const VisitRows& visit,
                            const std::function<void(double)>& progress);

// Remarks of a reading.
/// Of angles that were folded into one turn, and of a recording that was played in a loop.
void remarkOnRounds(std::uint64_t folds, std::uint64_t rounds, MotionCount& count);
/// Of joints whose effort is never a number.
std::string silentText(const std::vector<std::string>& joints);
/// Of values that are no number in more than a few rows; empty: none. `missing`: in how many, by name.
std::string missingText(const std::map<std::string, std::uint64_t>& missing, const MotionCount& count);

/// The table has a load of that joint.
bool tableRecordsLoad(const MotionSource& source);
}  // namespace hjt
