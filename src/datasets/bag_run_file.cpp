// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/bag_run_file.hpp"

#include <cstdio>
#include <mutex>
#include <utility>

#include <rosbag/view.h>
#include <std_msgs/String.h>

#include "datasets/file_seal.hpp"
#include "output/run_summary.hpp"

#include "arm/arm_configuration.hpp"
#include "bags/bag_file.hpp"
#include "base/publish_period.hpp"
#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "messages/time.hpp"
#include "messages/topics.hpp"

namespace hjt
{
namespace
{
/// Opening and closing look for plugins (compression, encryption), which is not made for several threads.
std::mutex g_opening;

/// Writes. A run that cannot be written is removed: an error must not tell how to read what is left of it.
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
}  // namespace

BagRunFile::BagRunFile(const RunSpec& spec, const Twin* twin, std::string path)
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

BagRunFile::~BagRunFile()
{
  const std::lock_guard<std::mutex> lock(g_opening);
  bag_.reset();
  std::remove(temporary_.c_str());
  std::remove((temporary_ + ".active").c_str());
}

void BagRunFile::record(Twin& twin, const DutyFeeder& /*feeder*/)
{
  writeOrRefuse([&] { recorder_->record(twin); });
  last_ = twin.stamp();
}

void BagRunFile::record(Stamp now, ArmRecorder& arm)
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

void BagRunFile::finish(OrderedJson record)
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

std::string BagRunFile::readRecord(const std::string& path)
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
    // Not a bag, or a damaged one: as if it were not there.
  }
  return {};
}
}  // namespace hjt
