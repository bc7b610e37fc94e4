// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sensor_msgs/JointState.h>

#include "datasets/run_file.hpp"

#include "bags/bag_recorder.hpp"

namespace hjt
{
/// A run as a bag: the node's topics at their rates, of an arm /joint_states as its driver publishes it; and at the end
/// the record as a text on RECORD_TOPIC.
class BagRunFile : public RunFile
{
public:
  static constexpr const char* RECORD_TOPIC = "/joint_twin/run";

  BagRunFile(const RunSpec& spec, const Twin* twin, std::string path);
  ~BagRunFile() override;

  void record(Twin& twin, const DutyFeeder& feeder) override;
  void record(Stamp now, ArmRecorder& arm) override;
  void finish(OrderedJson record) override;

  static std::string readRecord(const std::string& path);  ///< empty if there is none

private:
  std::string path_;
  std::string temporary_;
  std::optional<BagWriter> bag_;
  std::optional<BagRecorder> recorder_;
  std::vector<std::size_t> order_;  // of an arm's joints in its states
  sensor_msgs::JointState states_;
  Stamp period_{};  // of the states [ns]
  Stamp begin_{};   // from which they count
  Stamp last_;
};
}  // namespace hjt
