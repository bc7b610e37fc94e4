// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/recorded_motion.hpp"

#include <numeric>

#include "bags/recorded_messages.hpp"
#include "bags/recording_format.hpp"
#include "recordings/motion_readers.hpp"
#include "tracking/time_fit.hpp"

namespace hjt
{
namespace
{
/// What times are multiplied by after reading: those of a table are scaled as they are read, since their unit decides
/// what a jump is.
double scaleOf(const MotionSource& source)
{
  return isCsv(source) ? 1.0 : source.time_scale;
}

void scaleTimes(double scale, MotionRow& row)
{
  row.time *= scale;
  row.received *= scale;
}
}  // namespace

bool isCsv(const MotionSource& source)
{
  return formatOfRecording(source.path) == RecordingFormat::TABLE;
}

bool recordsLoad(const MotionSource& source)
{
  return isCsv(source) ? tableRecordsLoad(source) :
                         RecordedMessages::open(source.path)->messagesOn(source.load_topic) > 0;
}

MotionCount readMotion(const MotionSource& source, const std::function<bool(const MotionRow&)>& visit,
                       const std::function<void(double)>& progress)
{
  TimeFit fit;
  const double scale = scaleOf(source);
  const auto scaled = [&](const std::vector<MotionRow>& read)
  {
    MotionRow row = read.front();
    scaleTimes(scale, row);
    fit.add(row.time, row.position, row.recorded_velocity);
    return visit(row);
  };
  MotionCount count = isCsv(source) ? readTableMotion(source, { source.csv_joint }, scaled, progress) :
                                      readMessageMotion(source, { source.joint }, scaled, progress);
  count.duration *= scale;
  count.velocity_ratio = fit.factor().value;
  return count;
}

MotionCount readArmMotion(const MotionSource& source, const std::vector<std::string>& names,
                          const std::function<bool(const std::vector<MotionRow>&)>& visit,
                          const std::function<void(double)>& progress)
{
  std::vector<MotionRow> rows;
  const double scale = scaleOf(source);
  const auto scaled = [&](const std::vector<MotionRow>& read)
  {
    rows = read;
    for (MotionRow& row : rows)
    {
      scaleTimes(scale, row);
    }
    return visit(rows);
  };
  std::vector<int> numbers(names.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  MotionCount count = isCsv(source) ? readTableMotion(source, numbers, scaled, progress) :
                                      readMessageMotion(source, names, scaled, progress);
  count.duration *= scale;
  return count;
}
}  // namespace hjt
