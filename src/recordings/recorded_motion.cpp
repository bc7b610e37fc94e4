// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/recorded_motion.hpp"

#include <numeric>
#include <utility>

#include "bags/recorded_messages.hpp"
#include "recordings/motion_readers.hpp"
#include "tracking/telemetry_fit.hpp"

namespace hjt
{
namespace
{
/// Factor on the times after reading: those of a table or of arrays are scaled as they are read, since their
/// unit decides what a jump is.
double scaleOf(const MotionSource& source)
{
  return source.rows || isCsv(source) ? 1.0 : source.time_scale;
}

std::string leftOutText(std::uint64_t rows, const char* reason)
{
  return std::to_string(rows) + (rows == 1 ? " row is left out: " : " rows are left out: ") + reason;
}

void addRemarks(const LeftOutRows& left_out, MotionCount& count)
{
  const auto remark = [&](std::uint64_t rows, const char* reason)
  {
    if (rows > 0)
    {
      count.remarks.push_back(leftOutText(rows, reason));
    }
  };
  remark(left_out.unreachable, "angles that the joints cannot have reached from the rows beside them");
  remark(left_out.repeated,
         "they repeat the values of the row before while the joints move (held by a driver, or a recorder was stuck)");
  remark(left_out.bunched, "stamps come in bunches, each within a quarter of the mean step after another");
}

/// By the reader of its kind. `names`, `numbers`: of the joints in messages and tables.
MotionCount readAny(const MotionSource& source, const std::vector<std::string>& names, const std::vector<int>& numbers,
                    const VisitRows& visit, const std::function<void(double)>& progress)
{
  return source.rows   ? readArrayMotion(source, names.size(), visit, progress) :
         isCsv(source) ? readTableMotion(source, numbers, visit, progress) :
                         readMessageMotion(source, names, visit, progress);
}

/// The same through the filter.
MotionCount readFiltered(const MotionSource& source, const std::vector<std::string>& names,
                         const std::vector<int>& numbers, const VisitRows& visit,
                         const std::function<void(double)>& progress)
{
  const double scale = scaleOf(source);
  std::vector<double> speeds = source.speeds;
  speeds.resize(names.size(), MotionSource::FASTEST);
  RowFilter filter(std::move(speeds));
  std::vector<MotionRow> rows;
  bool more = true;
  MotionCount count = readAny(
      source, names, numbers,
      [&](const std::vector<MotionRow>& recorded)
      {
        rows = recorded;
        for (MotionRow& row : rows)
        {
          row.time *= scale;
          row.received *= scale;
        }
        return more = filter.push(rows, visit);
      },
      progress);
  if (more)
  {
    filter.finish(visit);
  }
  count.left_out = filter.leftOut();
  count.duration *= scale;
  count.rows -= count.left_out.all();
  count.corrupt += count.left_out.impossible + count.left_out.unreachable;
  addRemarks(count.left_out, count);
  return count;
}
}  // namespace

bool recordsLoad(const MotionSource& source)
{
  return isCsv(source) ? tableRecordsLoad(source) :
                         RecordedMessages::open(source.path)->messagesOn(source.load_topic) > 0;
}

MotionCount readMotion(const MotionSource& source, const std::function<bool(const MotionRow&)>& visit,
                       const std::function<void(double)>& progress)
{
  TimeFit fit;
  const auto fitted = [&](const std::vector<MotionRow>& rows)
  {
    const MotionRow& row = rows.front();
    fit.add(row.time, row.position, row.recorded_velocity);
    return visit(row);
  };
  MotionCount count = readFiltered(source, { source.joint }, { source.csv_joint }, fitted, progress);
  count.velocity_ratio = fit.factor().value;
  return count;
}

MotionCount readArmMotion(const MotionSource& source, const std::vector<std::string>& names,
                          const std::function<bool(const std::vector<MotionRow>&)>& visit,
                          const std::function<void(double)>& progress)
{
  std::vector<int> numbers(names.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  return readFiltered(source, names, numbers, visit, progress);
}
}  // namespace hjt
