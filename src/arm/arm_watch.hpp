// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cmath>
#include <functional>
#include <future>
#include <string>
#include <utility>
#include <vector>

#include "arm/arm_ranking.hpp"
#include "arm/load_fit.hpp"

namespace hjt
{
/// Whether an arm is another than given, by the law of `rankArms`, while its rows come: asked after 30, 60 and 120 s of
/// motion, and after eight minutes all over again, at once where it may be another. A thread of its own works each time
/// some seconds; rows of motion alone are kept for it.
class ArmWatch
{
public:
  /// Makes the arms to choose from, `own` among them, in that thread.
  using MakeCandidates = std::function<std::vector<ArmCandidate>()>;

  /// `unit_is_given`: efforts are of the configured unit.
  ArmWatch(MakeCandidates make, std::string own, bool unit_is_given = false)
    : make_(std::move(make)), own_(std::move(own)), unit_is_given_(unit_is_given)
  {
  }
  ~ArmWatch() { is_stopped_ = true; }
  ArmWatch(const ArmWatch&) = delete;
  ArmWatch& operator=(const ArmWatch&) = delete;

  /// Rows of all joints at one time, `current` the effort as it comes.
  void add(const std::vector<MotionRow>& rows);
  /// Other rows follow: what was found of those before, or is still asked of them, counts no more.
  void reset();

  /// True: an answer has come. @throws what the making of the arms threw.
  bool look();

  /// Clearly likelier than the one given; empty: none is known.
  const std::string& other() const { return other_; }
  /// It has an answer.
  bool isSettled() const { return is_settled_; }

private:
  static constexpr double PERIOD = 0.006;  // of the rows that are kept, at least [s]

  bool moves(const std::vector<MotionRow>& rows);
  void ask();

  MakeCandidates make_;
  std::string own_;
  bool unit_is_given_;
  std::string other_;
  bool is_settled_{};
  std::vector<std::vector<MotionRow>> rows_;
  std::vector<double> moved_from_;  // angles where the joints last stood [rad]
  double last_moved_{ -HUGE_VAL };  // [s]
  double last_time_{ -HUGE_VAL };   // of a row that is kept [s]
  double moved_{};                  // since the last start, but for the rest [s]
  double next_look_{ LoadFit::FIRST_LOOK };
  std::atomic<bool> is_stopped_{ false };  // pending questions are ignored
  std::future<std::string> answer_;        // last: it is waited for before the rest goes
};
}  // namespace hjt
