// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "tracking/tracker.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
/// The verdict on a measured joint while its rows come, live and offline alike. It is of the rows of half an hour; then
/// they start again, and the last verdict stands until there is another. A worse one counts after it has stood for a
/// while: the first rows of a motion are few.
class VerdictWatch
{
public:
  /// `tracker`: must outlive this. `known`: what its friction is held against.
  VerdictWatch(Tracker& tracker, JointContext known) : tracker_(tracker), known_(std::move(known)) {}

  /// Misfit of the telemetry; none: it fits, or that is not yet `settled`.
  void setMisfit(const Misfit& misfit, bool settled);
  const Misfit& misfit() const { return misfit_; }
  void setFitted(const FittedFriction& friction) { known_.fitted = friction; }

  /// As `joint_twin compare` measures it, of the rows that the verdict is of.
  MeasuredFriction measuredFriction() const;

  /// Makes the verdict again, alone.
  void judge() { judge(1.0, UNWITNESSED, {}); }
  /// Makes it after common factors of the joints of `measuredFriction`. `joint`: its number.
  void judge(const ArmFriction& arm, std::size_t joint)
  {
    judge(arm.factors[joint], arm.deviations[joint], arm.misfit);
  }

  /// Why nothing is judged at the moment; none: it is.
  std::optional<Misfit> whyNotJudged() const;

  double lastRow() const { return last_row_; }  ///< that was judged [s]

  /// The one that stands.
  const Verdict& confirmed() const { return confirmed_; }
  /// That one, or why nothing is judged at the moment.
  Verdict now() const;

private:
  static constexpr double JUDGED_SPAN = 1800.0;    // [s]
  static constexpr double CONFIRMED_AFTER = 10.0;  // [s]

  JointContext context(double arm_friction, double arm_deviation, const Misfit& of_arm) const;
  void judge(double arm_friction, double arm_deviation, const Misfit& of_arm);

  Tracker& tracker_;
  JointContext known_;
  Misfit misfit_;
  bool settled_{ true };
  double last_row_{};  // [s]
  Verdict confirmed_;
  double confirmed_at_{};  // time up to which no worse verdict was found [s]
};

/// Each joint after what the friction of all has in common within `tolerance`, as `joint_twin compare` judges a
/// recording.
void judgeTogether(const std::vector<VerdictWatch*>& joints, double tolerance);
}  // namespace hjt
