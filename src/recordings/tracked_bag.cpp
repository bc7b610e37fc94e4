// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/tracked_bag.hpp"

#include <cmath>
#include <limits>

#include "bags/bag_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "output/run_summary.hpp"

namespace hjt
{
TrackedBag::TrackedBag(const std::string& path, const MotionSource& source, const std::vector<Joint>& joints)
  : source_path_(source.path), writer_(path), joints_(joints)
{
  if (source.time_scale != 1.0)
  {
    throw InputError("--bag keeps the times of the recording: --time-scale cannot change them");
  }
  std::vector<std::string> names;
  for (const Joint& joint : joints)
  {
    names.push_back(joint.name);
  }
  const auto take_first = [this](const MotionRow& row)
  {
    delay_ = std::llround(1e9 * (row.received - row.time));
    return false;
  };
  const auto no_progress = [](double) {};
  start_ = (joints.size() == 1 ?
                readMotion(source, take_first, no_progress) :
                readArmMotion(
                    source, names, [&](const std::vector<MotionRow>& rows) { return take_first(rows.front()); },
                    no_progress))
               .start;
  if (isCsv(source))
  {
    start_ += SIMULATION_EPOCH;  // a controller counts from its own start
  }
  else if (source.format == RecordingFormat::BAG)
  {
    openForReading(source_, source.path);
    for (const Joint& joint : joints)
    {
      refuseTopics(source_, source.path, trackerTopics(joint.joint_namespace));
    }
    view_.addQuery(source_);
    next_ = view_.begin();
  }
  for (const Joint& joint : joints)
  {
    const BagContext context{ writer_, joint.joint_namespace + "/", delay_ };
    outputs_.push_back(std::make_unique<TrackerOutputs<RecordedTopic>>(context, joint.parameters));
  }
}

void TrackedBag::offer(std::size_t joint, const Comparison& comparison, const Tracker& tracker)
{
  const Stamp stamp = start_ + std::llround(1e9 * comparison.time);
  copyUntil(stamp + delay_);
  outputs_[joint]->offer(stamp, comparison, tracker);
}

void TrackedBag::judge(const std::vector<Tracker*>& trackers, const ArmAssessment& arm)
{
  for (std::size_t i = 0; i < trackers.size(); ++i)
  {
    verdicts_.push_back(std::make_unique<VerdictWatch>(*trackers[i], arm.context(i)));
    verdicts_.back()->setMisfit(arm.judged.misfits[i], true);
  }
}

void TrackedBag::offerVerdicts(double time)
{
  if (verdict_periods_.begins(start_ + std::llround(1e9 * time)))
  {
    judgeNow();
  }
}

void TrackedBag::judgeNow()
{
  std::vector<VerdictWatch*> verdicts;
  for (const auto& verdict : verdicts_)
  {
    verdicts.push_back(verdict.get());
  }
  judgeTogether(verdicts, joints_.front().parameters.comparison.repeat_tolerance);
  for (std::size_t i = 0; i < verdicts_.size(); ++i)
  {
    outputs_[i]->offer(start_ + std::llround(1e9 * verdicts_[i]->lastRow()), verdicts_[i]->now());
  }
}

void TrackedBag::copyUntil(Stamp recorded)
{
  try
  {
    while (next_ && *next_ != view_.end() && fromRosTime((*next_)->getTime()) <= recorded)
    {
      writer_.copy(**next_);
      ++*next_;
    }
  }
  catch (const rosbag::BagException& error)
  {
    throw InputError(source_path_ + " cannot be copied: " + error.what() + "; " + writer_.path() +
                     " is readable and holds what came before");
  }
}

void TrackedBag::close()
{
  judgeNow();
  copyUntil(std::numeric_limits<Stamp>::max());
  writer_.close();
}
}  // namespace hjt
