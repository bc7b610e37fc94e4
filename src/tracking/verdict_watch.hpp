// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
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
  void setMisfit(const Misfit& misfit, bool settled)
  {
    misfit_ = misfit;
    settled_ = settled;
  }

  const Misfit& misfit() const { return misfit_; }
  void setFitted(const FittedFriction& friction) { known_.fitted = friction; }

  /// As `joint_twin compare` measures it, of the rows that the verdict is of.
  MeasuredFriction measuredFriction() const
  {
    return hjt::measuredFriction(tracker_.evidence(), context(1.0, UNWITNESSED, {}));
  }

  /// Rows without a received temperature are predicted at what the friction of the joints means, if that is known.
  void predictAt(const ArmFriction& arm)
  {
    if (arm.is_known)
    {
      tracker_.setTemperature(arm.temperature);
    }
  }

  /// Makes the verdict again, alone.
  void judge() { judge(1.0, UNWITNESSED, {}); }
  /// Makes it after common factors of the joints of `measuredFriction`. `joint`: its number.
  void judge(const ArmFriction& arm, std::size_t joint)
  {
    judge(arm.factors[joint], arm.deviations[joint], arm.misfit);
  }

  /// Why nothing is judged at the moment; none: it is.
  std::optional<Misfit> whyNotJudged() const
  {
    if (misfit_.exists())
    {
      return misfit_;
    }
    if (!tracker_.isLoadKnown())
    {
      return Misfit{ Reason::LOAD_UNKNOWN, "the load is unknown" };
    }
    const JointEvidence& evidence = tracker_.evidence();
    return evidence.isTouched() ?
               std::make_optional(Misfit{ Reason::CONTACT, contactText(evidence.contact().last()) }) :
               std::nullopt;
  }

  double lastRow() const { return last_row_; }  ///< that was judged [s]

  /// The one that stands.
  const Verdict& confirmed() const { return confirmed_; }

  /// That one, or why nothing is judged at the moment.
  Verdict now() const
  {
    Verdict verdict = confirmed_;
    if (const std::optional<Misfit> why_not = whyNotJudged())
    {
      verdict.dismiss(*why_not);
    }
    else if (severityOf(verdict.level) != HealthLevel::OK && !settled_)
    {
      verdict.dismiss({ Reason::TELEMETRY_UNSETTLED, "" });
    }
    return verdict;
  }

private:
  static constexpr double JUDGED_SPAN = 1800.0;    // [s]
  static constexpr double CONFIRMED_AFTER = 10.0;  // [s]

  JointContext context(double arm_friction, double arm_deviation, const Misfit& of_arm) const
  {
    JointContext context = known_;
    context.arm_friction = arm_friction;
    context.misfit = misfit_.exists() ? misfit_ : of_arm;
    context.arm_deviation = arm_deviation;
    return context;
  }

  void judge(double arm_friction, double arm_deviation, const Misfit& of_arm)
  {
    const MotionReach& reach = tracker_.evidence().reach();
    last_row_ = reach.end;
    const bool is_new = confirmed_at_ > reach.end;  // the telemetry started again
    Verdict verdict = hjt::judge(tracker_.evidence(), context(arm_friction, arm_deviation, of_arm));
    const bool is_in_place = confirmed_.isJudged() && !whyNotJudged() && !is_new;
    // Found of the rows, unlike that they are too few: it takes the place of a verdict as a worse one does.
    const bool is_other =
        !verdict.fits && (verdict.reason == Reason::EFFORT_UNIT || verdict.reason == Reason::LESS_THAN_FAULTS ||
                          verdict.reason == Reason::NO_FRICTION || !of_arm.clause.empty() ||
                          (!verdict.misfit.empty() &&
                           (verdict.misfit == known_.fitted.not_more || verdict.misfit == known_.fitted.not_less)));
    const bool is_open = is_in_place && !verdict.isJudged() && !is_other;
    const bool is_no_worse = !(is_in_place && is_other) && severityOf(verdict.level) <= severityOf(confirmed_.level);
    if (!is_open && (is_new || is_no_worse || reach.end - confirmed_at_ >= CONFIRMED_AFTER))
    {
      confirmed_ = std::move(verdict);
      confirmed_at_ = reach.end;
    }
    if (reach.end - reach.begin > JUDGED_SPAN)
    {
      tracker_.forgetEvidence();
    }
  }

  Tracker& tracker_;
  JointContext known_;
  Misfit misfit_;
  bool settled_{ true };
  double last_row_{};  // [s]
  Verdict confirmed_;
  double confirmed_at_{};  // time up to which no worse verdict was found [s]
};

/// What the friction of the joints has in common within `tolerance`.
inline ArmFriction commonFriction(const std::vector<VerdictWatch*>& joints, double tolerance)
{
  std::vector<MeasuredFriction> frictions;
  for (const VerdictWatch* joint : joints)
  {
    frictions.push_back(joint->measuredFriction());
  }
  return commonFriction(frictions, tolerance);
}

/// Each joint after that, as `joint_twin compare` judges a recording.
inline ArmFriction judgeTogether(const std::vector<VerdictWatch*>& joints, double tolerance)
{
  const ArmFriction arm = commonFriction(joints, tolerance);
  for (std::size_t i = 0; i < joints.size(); ++i)
  {
    joints[i]->judge(arm, i);
  }
  return arm;
}
}  // namespace hjt
