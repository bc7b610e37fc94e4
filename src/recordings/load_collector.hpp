// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <vector>

#include "arm/load_fit.hpp"
#include "recordings/arm_recording.hpp"

namespace hjt
{
/// Gives the fit of an arm's load its samples, which come by joints: all of one time at once.
class LoadCollector
{
public:
  explicit LoadCollector(const ArmRecording& recording)
    : fit_(recording.arm(), recording.gains()), waiting_(recording.joints().size())
  {
  }

  /// The next sample of a joint. `predicted`: by its twin [A]. `is_touched`: something touches the arm.
  void add(std::size_t joint, const MotionSample& sample, double predicted, bool is_touched = false)
  {
    waiting_[joint].push_back({ sample, predicted, is_touched });
    while (std::none_of(waiting_.begin(), waiting_.end(), [](const std::deque<Row>& rows) { return rows.empty(); }))
    {
      samples_.clear();
      predicted_.clear();
      bool any_touched = false;
      for (std::deque<Row>& rows : waiting_)
      {
        samples_.push_back(rows.front().sample);
        predicted_.push_back(rows.front().predicted);
        any_touched = any_touched || rows.front().is_touched;
        rows.pop_front();
      }
      fit_.add(samples_, predicted_, any_touched);
    }
  }

  LoadFit& fit() { return fit_; }

private:
  struct Row
  {
    MotionSample sample;
    double predicted{};  // [A]
    bool is_touched{};
  };

  LoadFit fit_;
  std::vector<std::deque<Row>> waiting_;
  std::vector<MotionSample> samples_;
  std::vector<double> predicted_;
};
}  // namespace hjt
