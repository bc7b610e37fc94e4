// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/ros_io/recorded_motion.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/JointState.h>

#include "harmonic_joint_twin/params/number_table.hpp"
#include "harmonic_joint_twin/params/parameter_error.hpp"
#include "harmonic_joint_twin/ros_io/bag_inputs.hpp"
#include "harmonic_joint_twin/ros_io/telemetry_messages.hpp"

namespace hjt
{
namespace
{
bool isCsv(const MotionSource& source)
{
  const std::string end = ".csv";
  return source.path.size() >= end.size() && source.path.compare(source.path.size() - end.size(), end.size(), end) == 0;
}

/// Turns messages into rows. A row waits for the next one, so that a load with its own stamp can still reach it.
class BagRows
{
public:
  BagRows(const MotionSource& source, const std::function<bool(const MotionRow&)>& visit)
    : source_(source), visit_(visit)
  {
  }

  /// False: the visitor has had enough.
  bool read(const rosbag::MessageInstance& instance)
  {
    boost::shared_ptr<sensor_msgs::JointState> message;
    try
    {
      message = instance.instantiate<sensor_msgs::JointState>();
    }
    catch (const std::exception&)
    {
      ++count_.corrupt;
      return true;
    }
    if (!message)
    {
      throw InputError(instance.getTopic() + " has type " + instance.getDataType() +
                       ", expected sensor_msgs/JointState");
    }
    const ros::Time stamp = message->header.stamp.isZero() ? instance.getTime() : message->header.stamp;
    return instance.getTopic() == source_.topic ? takeTelemetry(*message, stamp, instance.getTime()) :
                                                  readLoad(*message, stamp);
  }

  bool flush()
  {
    bool more = true;
    if (waiting_)
    {
      more = visit_(*waiting_);
      ++count_.rows;
      waiting_.reset();
    }
    return more;
  }

  MotionCount count() const { return count_; }
  const std::set<std::string>& names() const { return names_; }

private:
  /// Place of the joint in the message; its size if it is not there.
  std::size_t find(const sensor_msgs::JointState& message) const
  {
    return static_cast<std::size_t>(std::find(message.name.begin(), message.name.end(), source_.joint) -
                                    message.name.begin());
  }

  bool takeTelemetry(const sensor_msgs::JointState& message, const ros::Time& stamp, const ros::Time& received)
  {
    const std::size_t i = find(message);
    if (i == message.name.size())
    {
      names_.insert(message.name.begin(), message.name.end());
      return true;
    }
    MotionRow row;
    if (readTelemetry(message, JointNames(source_.joint), row) != TelemetryStatus::FOUND)
    {
      ++count_.corrupt;
      return true;
    }
    const bool more = flush();
    if (!start_)
    {
      start_ = stamp;
    }
    row.time = (stamp - *start_).toSec();
    row.received = (received - *start_).toSec();
    row.load = load_;
    count_.duration = std::max(count_.duration, row.time);
    waiting_ = row;
    waiting_stamp_ = stamp;
    return more;
  }

  bool readLoad(const sensor_msgs::JointState& message, const ros::Time& stamp)
  {
    const std::size_t i = find(message);
    if (i < message.name.size() && i < message.effort.size() && std::isfinite(message.effort[i]))
    {
      load_ = message.effort[i];
      if (waiting_ && stamp <= waiting_stamp_)
      {
        waiting_->load = load_;
      }
    }
    return true;
  }

  const MotionSource& source_;
  const std::function<bool(const MotionRow&)>& visit_;
  MotionCount count_;
  std::set<std::string> names_;
  std::optional<MotionRow> waiting_;
  ros::Time waiting_stamp_;
  std::optional<ros::Time> start_;
  double load_{};
};

void open(rosbag::Bag& bag, const std::string& path)
{
  try
  {
    bag.open(path, rosbag::bagmode::Read);
  }
  catch (const rosbag::BagUnindexedException&)
  {
    throw InputError(path + " was not closed properly and has no index; `rosbag reindex` may mend it");
  }
  catch (const std::exception& error)
  {
    throw InputError(path + " cannot be read as a bag: " + error.what());
  }
}

MotionCount readBag(const MotionSource& source, const std::function<bool(const MotionRow&)>& visit,
                    const std::function<void(double)>& progress)
{
  rosbag::Bag bag;
  open(bag, source.path);
  rosbag::View telemetry(bag, rosbag::TopicQuery(source.topic));
  if (telemetry.size() == 0)
  {
    throw InputError(source.path + " has no messages on " + source.topic + "; it holds:" + listTopics(bag));
  }
  rosbag::View view(bag, rosbag::TopicQuery(std::vector<std::string>{ source.topic, source.load_topic }));
  BagRows rows(source, visit);
  const double total = view.size();
  double done = 0.0;
  bool more = true;
  for (auto instance = view.begin(); more && instance != view.end(); ++instance)
  {
    more = rows.read(*instance);
    progress(++done / total);
  }
  rows.flush();
  if (rows.count().rows == 0)
  {
    std::string found;
    for (const std::string& name : rows.names())
    {
      found += (found.empty() ? "" : ", ") + name;
    }
    throw InputError(source.topic + " never tells angle and effort of joint '" + source.joint +
                     "'; joints found: " + (found.empty() ? "none" : found));
  }
  return rows.count();
}

using CsvTable = NumberTable<4>;

CsvTable openCsv(const MotionSource& source)
{
  const std::string n = "_" + std::to_string(source.csv_joint);
  return CsvTable(source.path, { "timestamp", "actual_q" + n, "actual_current" + n, "target_moment" + n }, 1);
}

MotionCount readCsv(const MotionSource& source, const std::function<bool(const MotionRow&)>& visit,
                    const std::function<void(double)>& progress)
{
  CsvTable table = openCsv(source);
  MotionCount count;
  std::array<double, 4> row{};
  while (table.read(row))
  {
    ++count.rows;
    count.duration = std::max(count.duration, row[0]);
    MotionRow motion{ row[0], row[1], row[2], row[3] };
    motion.received = row[0];
    if (!visit(motion))
    {
      break;
    }
  }
  progress(1.0);
  if (count.rows == 0)
  {
    throw InputError(source.path + " has no rows");
  }
  return count;
}
}  // namespace

bool recordsLoad(const MotionSource& source)
{
  if (isCsv(source))
  {
    return openCsv(source).hasColumn(3);
  }
  rosbag::Bag bag;
  open(bag, source.path);
  return rosbag::View(bag, rosbag::TopicQuery(source.load_topic)).size() > 0;
}

MotionCount readMotion(const MotionSource& source, const std::function<bool(const MotionRow&)>& visit,
                       const std::function<void(double)>& progress)
{
  return isCsv(source) ? readCsv(source, visit, progress) : readBag(source, visit, progress);
}
}  // namespace hjt
