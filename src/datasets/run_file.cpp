// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/run_file.hpp"

#include <cstdio>
#include <filesystem>
#include <mutex>
#include <optional>
#include <utility>

#include <rosbag/view.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/String.h>

#include "arm/arm_configuration.hpp"
#include "bags/bag_file.hpp"
#include "bags/bag_recorder.hpp"
#include "base/publish_period.hpp"
#include "base/whole_file.hpp"
#include "datasets/file_seal.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "messages/time.hpp"
#include "messages/topics.hpp"
#include "output/process_end.hpp"

#include "arm/moving_arm.hpp"
#include "base/number_text.hpp"
#include "health/indicator_table.hpp"

namespace hjt
{
namespace
{
/// Lock for opening and closing a bag. Both search for plugins (compression, encryption) and are not thread-safe.
std::mutex g_opening;

/// Writes a run. If this fails, the file is removed. The error therefore omits how to read an incomplete file.
template <class Action>
void writeOrRefuse(const Action& action)
{
  try
  {
    action();
  }
  catch (const InputError& error)
  {
    const std::string text = error.what();
    throw InputError(text.substr(0, text.find("; ")));
  }
}

/// A run as a bag: the topics of the node at their rates; for an arm, /joint_states as the arm's driver publishes it.
/// The last message is the record, a text on RECORD_TOPIC.
class BagRunFile : public RunFile
{
public:
  static constexpr const char* RECORD_TOPIC = "/joint_twin/run";

  BagRunFile(const RunSpec& spec, const Twin* twin, std::string path)
    : path_(std::move(path)), temporary_(makeFileBeside(path_)), last_(SIMULATION_EPOCH)
  {
    if (spec.arm)
    {
      order_ = driverOrder(spec.arm->arm);
      period_ = publishPeriod(spec.arm->arm.state_rate, spec.parameters.solver.rate);
      begin_ = twin != nullptr ? twin->stamp() : begin_;
      states_ = jointStatesOf(driverNames(spec.arm->arm));
    }
    const std::lock_guard<std::mutex> lock(g_opening);
    bag_.emplace(temporary_);
    if (twin != nullptr && !spec.arm)
    {
      recorder_.emplace(*twin, DEFAULT_NAMESPACE, *bag_);
    }
  }

  ~BagRunFile() override
  {
    const std::lock_guard<std::mutex> lock(g_opening);
    bag_.reset();
    std::remove(temporary_.c_str());
    std::remove((temporary_ + ".active").c_str());
  }

  void record(Twin& twin, const DutyFeeder& /*feeder*/) override
  {
    writeOrRefuse([&] { recorder_->record(twin); });
    last_ = twin.stamp();
  }

  void record(Stamp now, ArmRecorder& arm) override
  {
    if ((now - begin_) % period_ != 0)
    {
      return;
    }
    const ArmRow& row = arm.row();
    states_.header.stamp = toRosTime(now);
    for (std::size_t k = 0; k < order_.size(); ++k)
    {
      states_.position[k] = row[ACTUAL_POSITION][order_[k]];
      states_.velocity[k] = row[ACTUAL_VELOCITY][order_[k]];
      states_.effort[k] = row[ACTUAL_CURRENT][order_[k]];
    }
    writeOrRefuse([&] { bag_->write(std::string("/") + topics::JOINT_STATES, now, states_); });
    last_ = now;
  }

  void finish(OrderedJson record) override
  {
    std_msgs::String message;
    message.data = record.dump();
    writeOrRefuse(
        [&]
        {
          bag_->write(RECORD_TOPIC, last_, message);
          const std::lock_guard<std::mutex> lock(g_opening);
          bag_->close();
        });
    sealFile(temporary_);
    bringToDisk(temporary_, path_);
  }

  /// Text of the record; empty if the bag has no record.
  static std::string readRecord(const std::string& path)
  {
    const std::lock_guard<std::mutex> lock(g_opening);
    try
    {
      rosbag::Bag bag;
      openForReading(bag, path);
      rosbag::View view(bag, rosbag::TopicQuery(RECORD_TOPIC));
      for (const rosbag::MessageInstance& message : view)
      {
        const auto text = message.instantiate<std_msgs::String>();
        return text ? text->data : std::string();
      }
    }
    catch (const std::exception&)
    {
      // A damaged file, or a file that is not a bag, counts as missing.
    }
    return {};
  }

private:
  std::string path_;
  std::string temporary_;
  std::optional<BagWriter> bag_;
  std::optional<BagRecorder> recorder_;
  std::vector<std::size_t> order_;  // index of the joint for each entry of the arm's states
  sensor_msgs::JointState states_;
  Stamp period_{};  // period of the arm's states [ns]
  Stamp begin_{};   // stamp from which period_ is counted [ns]
  Stamp last_;
};

}  // namespace

std::unique_ptr<RunFile> makeRunFile(const Recording& recording, const RunSpec& spec, const Twin* twin,
                                     const std::string& path)
{
  if (recording.format == RunFormat::BAG)
  {
    return std::make_unique<BagRunFile>(spec, twin, path);
  }
  return makeHdf5RunFile(recording, spec, twin, path);
}

void addOutcome(const TwinCounters& counters, std::uint64_t on_surface, double end, OrderedJson& record)
{
  if (counters.solver_failures > 0)
  {
    record["status"] = "failed";
    record["error"] = "the solver found no equilibrium at " + numberText(end) + " s; the record ends at this time";
  }
  record["steps"] = counters.steps;
  record["steps_on_surface"] = on_surface;
  record["coarse_steps"] = counters.coarse_steps;
  record["torque_clamped"] = counters.torque_clamped;
  record["jumps"] = counters.jumps;
}

void addProtectiveStop(const ArmDescription& arm, const MovingArm& moving, OrderedJson& record)
{
  const std::optional<ProtectiveStop>& stop = moving.protectiveStop();
  record[PROTECTIVE_STOP] = stop ? arm.joints[stop->joint].short_name + " " + stop->reason + " at " +
                                       numberText(toSeconds(stop->stamp - moving.motionBegin())) + " s" :
                                   "";
}

const char* runFileExtension(RunFormat format)
{
  return format == RunFormat::BAG ? ".bag" : ".h5";
}

OrderedJson readRunRecord(RunFormat format, const std::string& path)
{
  if (!std::filesystem::exists(path))
  {
    return nullptr;
  }
  const std::string text = format == RunFormat::BAG ? BagRunFile::readRecord(path) : readHdf5Text(path, "record");
  return OrderedJson::parse(text, nullptr, false);
}

std::string readRunParameters(const std::string& path)
{
  return readHdf5Text(path, "parameters");
}

Columns readRunColumns(const std::string& path, const std::vector<std::string>& holding)
{
  return readHdf5Columns(path, holding);
}

std::string errorColumn(std::size_t indicator)
{
  return std::string("window_error_") + indicatorName(amplitudeOf(indicator));
}

double dataSize(const Recording& recording, const RunSpec& spec)
{
  const std::size_t joints = spec.arm ? spec.arm->drives.size() : 1;
  double bytes = 0.0;
  for (const RecordingGroup& group : recording.groups)
  {
    for (const RunColumn* column : group.columns)
    {
      const auto numbers = static_cast<double>(column->width(spec.parameters.gear.teeth_flexspline, joints));
      bytes += (spec.duration - recording.start) * group.rate * numbers * (group.float32 ? 4.0 : 8.0);
    }
  }
  return bytes;
}
}  // namespace hjt
