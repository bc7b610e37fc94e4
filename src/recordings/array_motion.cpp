// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "harmonic_joint_twin/base/errors.hpp"
#include "recordings/motion_readers.hpp"
#include "recordings/row_time.hpp"
#include "recordings/source_watch.hpp"
#include "tracking/plausible.hpp"
#include "tracking/unfolded_angle.hpp"

namespace hjt
{
MotionCount readArrayMotion(const MotionSource& source, std::size_t joints, const VisitRows& visit,
                            const std::function<void(double)>& progress)
{
  MotionCount count;
  std::vector<UnfoldedAngle> angles(joints);
  RowTime times;
  RowOrder order;
  SourceWatch sources;
  std::vector<MotionRow> rows;
  for (const std::vector<MotionRow>& row : *source.rows)
  {
    if (row.size() != joints)
    {
      throw InputError(source.path + " has " + std::to_string(row.size()) +
                       " joints, expected: " + std::to_string(joints));
    }
    progress(static_cast<double>(++count.rows) / static_cast<double>(source.rows->size()));
    const double seconds = source.time_scale * row.front().time;
    if (!(std::abs(seconds) < MAX_TIME))
    {
      ++count.corrupt;
      continue;
    }
    const double by_stamps = times.at(std::llround(1e9 * seconds));
    // As the numbers stand in the array where there is one round.
    const double time = times.rounds() == 1 ? seconds : by_stamps;
    order.add(seconds);
    count.duration = std::max(count.duration, time);
    rows = row;
    for (std::size_t i = 0; i < joints; ++i)
    {
      rows[i].time = rows[i].received = time;
      rows[i].position = angles[i].take(time, row[i].position);
    }
    sources.add("", rows);
    if (!visit(rows))
    {
      break;
    }
  }
  std::uint64_t folds = 0;
  for (const UnfoldedAngle& angle : angles)
  {
    folds += angle.folds();
  }
  remarkOnRounds(folds, times.rounds(), count);
  count.misfit = { Reason::TWO_SOURCES, sources.text() };
  if (!count.misfit.exists())
  {
    count.misfit = { Reason::STAMPS, order.text() };
  }
  return count;
}
}  // namespace hjt
