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
/// Finds payload and mounting from an arm's currents while the rows arrive. The class evaluates the rows after every 30
/// s of motion. After eight minutes of motion, or after a change of the load, the class forgets the rows and begins
/// again. If the payload changes, only the last payload counts. The class tries a found load for 10 s of motion
/// (LoadLaw). If the trial fails, the class looks for no load during the next eight minutes of motion. An evaluation
/// takes some tenths of a second in a thread of its own. The class allocates and is not for a real-time loop.
class LoadWatch
{
public:
  /// `joints`: parameters of each joint. `drives`: drive of each joint, with its expected friction.
  /// @throws ParameterError for the reasons that MotionDriven names.
  LoadWatch(const ArmDescription& arm, const std::vector<Parameters>& joints, std::vector<LoadFit::Drive> drives);

  void add(const ArmSample& sample);
  /// Forgets the rows, because rows of another motion follow. The present load stays.
  void reset();

  bool isDue() const;  ///< whether look() has work: an evaluation is due, or the result of one is ready
  bool isLooking() const { return found_.valid(); }
  /// Starts an evaluation, or takes the result of the running one. Call this function if isDue() is true. `joints`:
  /// results with the present load. Returns true if from now on the joints are judged with another load than before.
  bool look(const JudgedJoints& joints);

  const AssumedLoad& assumed() const { return law_.counts(); }
  bool isTrying() const { return law_.isTrying(); }
  /// Why no joint can be judged: the payload changes from leg to leg, or the gains of all joints differ from the
  /// configured ones. Empty: the joints can be judged.
  const Misfit& misfit() const { return misfit_; }
  /// Friction of each joint by the last evaluation; empty before the first evaluation.
  const std::vector<FittedFriction>& frictions() const { return frictions_; }
  /// Whether an evaluation has ended and no load is on trial.
  bool isSettled() const { return has_looked_ && !isTrying(); }
  /// The arm with the load (payload, mounting, drag) with which the joints are judged.
  const ArmDescription& arm() const { return arm_; }

private:
  static constexpr double TRIAL = 10.0;  // time of motion for which a found load is tried [s]

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
  double last_time_{ -HUGE_VAL };  // time of the last sample that the fit used [s]
  double next_look_{ LoadFit::FIRST_LOOK };
  bool has_looked_{};
  Misfit misfit_;
  std::vector<FittedFriction> frictions_;
  bool is_new_{ true };           // true: the next row is the first one after a gap
  double looked_at_{};            // time of the last row of the last evaluation [s]
  bool is_of_others_{};           // true: the rows of the running evaluation are from before the last reset
  std::future<FoundLoad> found_;  // last member: its destructor waits for the thread, which uses other members
};

/// Finds out, while rows arrive, whether the rows belong to another arm than the given one (rankArms). The class ranks
/// the arms after 30, 60 and 120 s of motion. After eight more minutes of motion the class begins again with new rows,
/// or at once if a ranking shows another arm. A ranking takes some seconds in its own thread. The class keeps only rows
/// with motion.
class ArmWatch
{
public:
  /// Makes the arms to rank, including the given arm. The thread that ranks the arms calls this function.
  using MakeCandidates = std::function<std::vector<ArmCandidate>()>;

  /// `own`: name of the given arm. `unit_is_given`: whether the efforts certainly have the configured unit.
  ArmWatch(MakeCandidates make, std::string own, bool unit_is_given = false)
    : make_(std::move(make)), own_(std::move(own)), unit_is_given_(unit_is_given)
  {
  }
  ~ArmWatch() { is_stopped_ = true; }
  ArmWatch(const ArmWatch&) = delete;
  ArmWatch& operator=(const ArmWatch&) = delete;

  /// Adds one row of each joint, all of the same time, with the effort as received in the field `current`.
  void add(const std::vector<MotionRow>& rows);
  void reset();  ///< forgets all rows and the results of their rankings, because rows of another motion follow

  /// Takes the result of a finished ranking. Returns false if none has finished. @throws any exception of
  /// MakeCandidates.
  bool look();

  /// Name of the arm that is clearly likelier than the given one; empty: no such arm is known.
  const std::string& other() const { return other_; }
  bool isSettled() const { return is_settled_; }  ///< whether a ranking of the present rows has ended

private:
  static constexpr double PERIOD = 0.006;  // least time between rows that are kept [s]

  bool moves(const std::vector<MotionRow>& rows);
  void ask();

  MakeCandidates make_;
  std::string own_;
  bool unit_is_given_;
  std::string other_;
  bool is_settled_{};
  std::vector<std::vector<MotionRow>> rows_;
  std::vector<double> moved_from_;  // angle of each joint at its last change that counted as motion [rad]
  double last_moved_{ -HUGE_VAL };  // time of the last row with motion [s]
  double last_time_{ -HUGE_VAL };   // time of the last row that was kept [s]
  double moved_{};                  // time of motion since the first of the present rows [s]
  double next_look_{ LoadFit::FIRST_LOOK };
  std::atomic<bool> is_stopped_{ false };  // true: the rows of the running ranking are from before the last reset
  std::future<std::string> answer_;        // last member: its destructor waits for the thread, which uses other members
};
}  // namespace hjt
