// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/life_publisher.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <system_error>

#include <ros/console.h>

#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "messages/time.hpp"
#include "messages/topics.hpp"

namespace hjt
{
namespace
{
/// Time between two counts of use by the loop [ns].
constexpr Stamp COUNT_PERIOD = 1'000'000;
/// Length of the intervals of use that the loop hands over [ns]. A longer gap between two instants is not use.
constexpr Stamp STRETCH = 1'000'000'000;
constexpr std::size_t STRETCH_SLOTS = 2;

/// `path`, or PATH.1, PATH.2 ... if the file exists, so that no file is overwritten.
std::string unusedName(const std::string& path)
{
  std::string name = path;
  std::error_code error;
  for (int number = 1; std::filesystem::exists(name, error); ++number)
  {
    name = path + "." + std::to_string(number);
  }
  return name;
}
}  // namespace

LifePublisher::LifePublisher(ros::NodeHandle& node, const Parameters& parameters)
  : joint_(parameters.joint.name)
  , parameters_(parameters.life)
  , path_(parameters.life.use_record == NO_FILE ? "" : parameters.life.use_record)
  , counted_{ 0, UsageHistory(parameters.life), {}, 0 }
  , stretches_(STRETCH_SLOTS, counted_)
  , record_(parameters.life)
  , estimator_(parameters)
  , publisher_(node.advertise<harmonic_joint_twin::RemainingLife>(topics::REMAINING_LIFE, 1, true))
{
  readRecord();
  reference_hours_ = record_.hours();
  thread_ = std::thread([this] { run(); });
}

LifePublisher::~LifePublisher()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  wake_up_.notify_all();
  thread_.join();
  takeStretches();
  record_.add(counted_.use);
  write();
}

void LifePublisher::readRecord()
{
  if (path_.empty())
  {
    return;
  }
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path_, error);
  if (status.type() == std::filesystem::file_type::not_found)
  {
    ROS_INFO_STREAM("There is no record of the drive's use at " << path_ << " yet; the drive counts as new");
    return;
  }
  const auto require = [this](bool good, const std::string& why)
  {
    if (!good)
    {
      throw ParameterError("life.use_record = '" + path_ + "' " + why);
    }
  };
  require(std::filesystem::status_known(status), "cannot be reached: " + error.message());
  require(std::filesystem::is_regular_file(status), "must be a file, not a directory, a device or a pipe");
  require(DutyCycle::isOne(path_),
          "is not a record of a drive's use or is unreadable; the node does not overwrite another file");
  try
  {
    record_ = UsageHistory(parameters_, path_);
    ROS_INFO_STREAM("The drive has been used for " << record_.hours() << " h (" << path_ << ")");
  }
  catch (const InputError& error)
  {
    const std::string aside = unusedName(path_ + ".unreadable");
    std::error_code refused;
    std::filesystem::rename(path_, aside, refused);
    ROS_ERROR_STREAM("The record of the drive's use cannot be read: "
                     << error.what() << ". The drive counts as new; "
                     << (refused ? "the node does not write the file" : "the file is kept as " + aside));
    path_ = refused ? "" : path_;
  }
}

void LifePublisher::offer(Stamp instant, double motor_velocity, double joint_torque, double temperature,
                          const Assessment& assessment) noexcept
{
  const Stamp elapsed = instant - last_;
  if (elapsed >= 0 && elapsed < COUNT_PERIOD)
  {
    return;
  }
  last_ = instant;
  if (elapsed < 0 || elapsed > STRETCH)
  {
    return;  // the twin has restarted at another instant, and the time between the instants is no use of the drive
  }
  counted_.use.add({ toSeconds(elapsed), std::abs(motor_velocity), joint_torque, temperature });
  counted_.until = instant;
  if (assessment.windows != counted_.windows)
  {
    const Assessment before = assessment.windows < counted_.windows ? Assessment() : counted_.assessment;
    counted_.assessment = supersedes(assessment, before) ? assessment : before;
    counted_.windows = assessment.windows;
  }
  if (instant >= counted_from_ && instant - counted_from_ < STRETCH)
  {
    return;
  }
  if (Stretch* slot = stretches_.claim())
  {
    *slot = counted_;
    stretches_.commit();
    counted_.use.clear();
    counted_from_ = instant;
  }
}

void LifePublisher::run()
{
  const std::chrono::duration<double> period(parameters_.forecast_period);
  std::unique_lock<std::mutex> lock(mutex_);
  while (!wake_up_.wait_for(lock, period, [this] { return stopping_; }))
  {
    lock.unlock();
    takeStretches();
    write();
    publish();
    lock.lock();
  }
}

void LifePublisher::takeStretches()
{
  for (const Stretch* stretch = stretches_.front(); stretch != nullptr; stretch = stretches_.front())
  {
    reference_hours_ = stretch->windows < windows_ ? record_.hours() : reference_hours_;
    windows_ = stretch->windows;
    assessment_ = stretch->assessment;
    record_.add(stretch->use);
    until_ = stretch->until;
    stretches_.pop();
  }
}

void LifePublisher::publish()
{
  if (record_.turns() == 0.0)
  {
    return;
  }
  try
  {
    const bool assessed = assessment_.state == AssessmentState::ASSESSED;
    const LifeEstimate estimate = estimator_.estimate(record_, assessed ? &assessment_ : nullptr, reference_hours_);
    const RemainingHours& remaining = estimate.remaining;
    harmonic_joint_twin::RemainingLife message;
    message.header.stamp = toRosTime(until_);
    message.header.frame_id = joint_;
    message.hours = estimate.hours;
    message.turns = estimate.turns;
    message.assessed = assessed ? toRosTime(assessment_.stamp) : ros::Time();
    message.remaining_hours_10 = remaining.quantile[1];
    message.remaining_hours_50 = remaining.quantile[2];
    message.remaining_hours_90 = remaining.quantile[3];
    for (std::size_t i = 0; i < RemainingHours::BINS; ++i)
    {
      message.remaining_hours[i] = RemainingHours::edge(i);
      message.probability[i] = remaining.probability[i];
    }
    std::copy(remaining.by_cause.begin(), remaining.by_cause.end(), message.end_probability.begin());
    message.nearest_limit = nameOf(estimate.nearest());
    message.flank_wear_used = estimate.usedOf(EndOfLife::FLANK_WEAR);
    message.interface_wear_used = estimate.usedOf(EndOfLife::INTERFACE_WEAR);
    message.root_crack_used = estimate.usedOf(EndOfLife::ROOT_CRACK);
    message.bearing_used = estimate.usedOf(EndOfLife::BEARING);
    message.tooth_space_fatigue_used = estimate.usedOf(EndOfLife::TOOTH_SPACE_FATIGUE);
    message.transition_fatigue_used = estimate.usedOf(EndOfLife::TRANSITION_FATIGUE);
    message.flange_fatigue_used = estimate.usedOf(EndOfLife::FLANGE_FATIGUE);
    message.grease_used = estimate.grease_used;
    publisher_.publish(message);
  }
  catch (const std::exception& error)  // no exception may leave a thread
  {
    ROS_WARN_STREAM_ONCE("The node cannot forecast the remaining life: " << error.what());
  }
}

void LifePublisher::write()
{
  if (path_.empty() || record_.turns() == 0.0)
  {
    return;
  }
  try
  {
    writeTextFile(path_, record_.text());
  }
  catch (const std::exception& error)
  {
    ROS_WARN_STREAM_THROTTLE(60.0, "The node cannot write the record of the drive's use: " << error.what());
  }
}
}  // namespace hjt
