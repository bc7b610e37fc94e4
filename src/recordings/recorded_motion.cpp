// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/recorded_motion.hpp"

#include <utility>

#include "recordings/motion_readers.hpp"
#include "tracking/telemetry_fit.hpp"

namespace hjt
{
namespace
{
std::string leftOutText(std::uint64_t rows, const std::string& reason)
{
  return rows == 0 ? "" : std::to_string(rows) + (rows == 1 ? " row is left out: " : " rows are left out: ") + reason;
}
}  // namespace

bool recordsLoad(const MotionSource& source)
{
  return isCsv(source) ? tableRecordsLoad(source) :
                         RecordedMessages::open(source.path)->messagesOn(source.load_topic) > 0;
}

MotionCount readMotion(const MotionSource& source, const std::vector<std::string>& names, const VisitMotionRows& visit,
                       const std::function<void(double)>& progress)
{
  // Times of a table or of arrays are scaled during reading, because the size of a jump in seconds decides on rounds.
  const double scale = isCsv(source) ? 1.0 : source.time_scale;
  std::vector<double> speeds = source.speeds;
  speeds.resize(names.size(), MotionSource::FASTEST);
  RowFilter filter(std::move(speeds));
  TimeFit fit;
  const auto fitted = [&](const std::vector<MotionRow>& rows)
  {
    fit.add(rows.front().time, rows.front().position, rows.front().recorded_velocity);
    return visit(rows);
  };
  std::vector<MotionRow> rows;
  bool more = true;
  const auto take = [&](const std::vector<MotionRow>& recorded)
  {
    rows = recorded;
    for (MotionRow& row : rows)
    {
      row.time *= scale;
      row.received *= scale;
    }
    return more = filter.push(rows, fitted);
  };
  MotionCount count = source.rows   ? readArrayMotion(source, names.size(), take, progress) :
                      isCsv(source) ? readTableMotion(source, names.size(), take, progress) :
                                      readMessageMotion(source, names, take, progress);
  if (more)
  {
    filter.finish(fitted);
  }
  count.velocity_ratio = fit.factor().value;
  count.left_out = filter.leftOut();
  count.duration *= scale;
  count.rows -= count.left_out.all();
  count.corrupt += count.left_out.impossible + count.left_out.unreachable;
  count.remark(
      leftOutText(count.left_out.unreachable, "the joints cannot reach these angles from the neighbouring rows"));
  count.remark(leftOutText(count.left_out.repeated,
                           "they repeat the values of the row before while the joints move (held by a driver, or a "
                           "recorder was stuck)"));
  count.remark(leftOutText(count.left_out.bunched,
                           "their stamps come in bunches, within a quarter of the mean step after the row before"));
  return count;
}
}  // namespace hjt
