// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cmath>
#include <cstddef>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arm/arm_load.hpp"
#include "arm/arm_ranking.hpp"
#include "arm/found_load.hpp"
#include "arm/load_fit.hpp"
#include "tracking/motion_driven.hpp"

namespace hjt
{
/// Payload and mounting that an arm's currents show while its rows come: looked for every 30 s of motion, after eight
/// minutes all over again, and where the payload changes in that time in the rows since then. What is found is tried
/// for 10 s of motion (LoadLaw); once it is taken back nothing is looked for in the next eight minutes. A thread of its
/// own looks, some tenths of a second. Not for a real-time loop: it allocates.
class LoadWatch
{
public:
  /// `joints`: parameters of each; `drives`: with the friction that is expected of each. @throws ParameterError as
  /// MotionDriven.
  LoadWatch(const ArmDescription& arm, const std::vector<Parameters>& joints, std::vector<LoadFit::Drive> drives);

  void add(const ArmSample& sample);
  /// Starts again with the load that counts: other rows follow.
  void reset();

  /// It is time to begin a look, or to take what one has found.
  bool isDue() const;
  bool isLooking() const { return found_.valid(); }
  /// Where it is due. `joints`: beside their twins, with the load that counts. True: another counts from now on.
  bool look(const JudgedJoints& joints);

  const AssumedLoad& assumed() const { return law_.counts(); }
  bool isTrying() const { return law_.isTrying(); }
  /// Why no joint can be judged: a payload that is taken up and put down again and again, or another gain of all.
  const Misfit& misfit() const { return misfit_; }
  /// Of each joint by the last look; empty: none yet.
  const std::vector<FittedFriction>& frictions() const { return frictions_; }
  /// It has looked, and tries nothing: the load is what it counts as.
  bool isSettled() const { return has_looked_ && !isTrying(); }
  /// The arm with the payload and the mounting that count.
  const ArmDescription& arm() const { return arm_; }

private:
  static constexpr double TRIAL = 10.0;  // of motion [s]

  void start(double first_look);
  void begin(std::vector<bool> measured);
  bool take(const FoundLoad& found, const JudgedJoints& joints);

  const ArmDescription given_;
  ArmDescription arm_;
  LoadLaw law_;
  const std::vector<LoadFit::Drive> drives_;
  std::vector<MotionDriven> twins_;
  std::optional<LoadFit> fit_;
  std::vector<MotionSample> samples_;
  std::vector<const MotionDriven*> beside_;
  double last_time_{ -HUGE_VAL };  // that counted [s]
  double next_look_{ LoadFit::FIRST_LOOK };
  bool has_looked_{};
  Misfit misfit_;
  std::vector<FittedFriction> frictions_;
  bool is_new_{ true };           // the next row comes after a gap
  double looked_at_{};            // time of the last row of the last look [s]
  bool is_of_others_{};           // what is found is of rows of before
  std::future<FoundLoad> found_;  // last: it is waited for before the rest goes
};

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
