// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <future>
#include <optional>
#include <vector>

#include "arm/arm_load.hpp"
#include "arm/load_fit.hpp"
#include "arm/load_law.hpp"
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
}  // namespace hjt
