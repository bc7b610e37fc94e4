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
/// The verdict on a measured joint while its rows arrive. After half an hour the evidence starts again, and the last
/// verdict stands until the new rows give a verdict. A worse verdict than the present one counts only after
/// CONFIRMED_AFTER, because a verdict from few rows is uncertain.
class VerdictWatch
{
public:
  /// `tracker` must outlive this object. `known`: reference of the joint, and what else is known of the joint.
  VerdictWatch(Tracker& tracker, JointContext known) : tracker_(tracker), known_(std::move(known)) {}

  /// Sets the misfit of the telemetry; empty: the telemetry fits. `settled`: whether `misfit` is final.
  void setMisfit(const Misfit& misfit, bool settled)
  {
    misfit_ = misfit;
    settled_ = settled;
  }

  const Misfit& misfit() const { return misfit_; }
  void setFitted(const FittedFriction& friction) { known_.fitted = friction; }

  /// Friction of the rows in the present evidence. `joint_twin compare` measures the friction in the same way.
  MeasuredFriction measuredFriction() const { return hjt::measuredFriction(tracker_.evidence(), context()); }

  /// Gives rows without a received temperature the temperature that explains the friction of all joints (ArmFriction).
  void predictAt(const ArmFriction& arm)
  {
    if (arm.is_known)
    {
      tracker_.setTemperature(arm.temperature);
    }
  }

  void judge() { judge(context()); }  ///< judges the present evidence without the other joints
  /// Judges the present evidence with the common factors of all joints. `joint`: number of this joint.
  void judge(const ArmFriction& arm, std::size_t joint) { judge(context(&arm, joint)); }

  /// Why the joint is not judged at the moment; none: it is judged.
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

  double lastRow() const { return last_row_; }  ///< time of the last row that was judged [s]

  const Verdict& confirmed() const { return confirmed_; }  ///< the present verdict

  /// The present verdict, or a verdict NOT_JUDGED that says why the joint is not judged at the moment.
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
  static constexpr double JUDGED_SPAN = 1800.0;    // longest time from first to last row in the evidence [s]
  static constexpr double CONFIRMED_AFTER = 10.0;  // time after which a worse verdict counts [s]

  /// `arm`: common factors of the joints; nullptr: not known. `joint`: number of this joint.
  JointContext context(const ArmFriction* arm = nullptr, std::size_t joint = 0) const
  {
    JointContext context = known_;
    context.arm_friction = arm != nullptr ? arm->factors[joint] : 1.0;
    context.arm_deviation = arm != nullptr ? arm->deviations[joint] : UNWITNESSED;
    context.misfit = misfit_.exists() || arm == nullptr ? misfit_ : arm->misfit;
    return context;
  }

  void judge(const JointContext& context)
  {
    const MotionReach& reach = tracker_.evidence().reach();
    last_row_ = reach.end;
    const bool is_new = confirmed_at_ > reach.end;  // true: the telemetry started again
    Verdict verdict = hjt::judge(tracker_.evidence(), context);
    const bool is_in_place = confirmed_.isJudged() && !whyNotJudged() && !is_new;
    // A misfit that the rows show replaces the verdict only after CONFIRMED_AFTER. Too few rows replace no verdict.
    const bool is_other =
        !verdict.fits && (verdict.reason == Reason::EFFORT_UNIT || verdict.reason == Reason::LESS_THAN_FAULTS ||
                          verdict.reason == Reason::NO_FRICTION || context.misfit.exists() ||
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
  double last_row_{};  // time of the last row that was judged [s]
  Verdict confirmed_;
  double confirmed_at_{};  // time of the last row when confirmed_ was last set [s]
};

/// Common friction factors of these joints, by their present evidence. `tolerance`: as in hjt::commonFriction().
inline ArmFriction commonFriction(const std::vector<VerdictWatch*>& joints, double tolerance)
{
  std::vector<MeasuredFriction> frictions;
  for (const VerdictWatch* joint : joints)
  {
    frictions.push_back(joint->measuredFriction());
  }
  return commonFriction(frictions, tolerance);
}

/// Judges each joint with the common factors of all joints, as `joint_twin compare` judges a recording.
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
