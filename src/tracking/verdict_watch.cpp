// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/verdict_watch.hpp"

#include <cstddef>
#include <utility>

namespace hjt
{
void VerdictWatch::setMisfit(const Misfit& misfit, bool settled)
{
  misfit_ = misfit;
  settled_ = settled;
}

JointContext VerdictWatch::context(double arm_friction, double arm_deviation, const Misfit& of_arm) const
{
  JointContext context = known_;
  context.arm_friction = arm_friction;
  context.misfit = misfit_.exists() ? misfit_ : of_arm;
  context.arm_deviation = arm_deviation;
  return context;
}

MeasuredFriction VerdictWatch::measuredFriction() const
{
  return hjt::measuredFriction(tracker_.evidence(), context(1.0, UNWITNESSED, {}));
}

void VerdictWatch::judge(double arm_friction, double arm_deviation, const Misfit& of_arm)
{
  const MotionReach& reach = tracker_.evidence().reach();
  last_row_ = reach.end;
  const bool is_new = confirmed_at_ > reach.end;  // the telemetry started again
  Verdict verdict = hjt::judge(tracker_.evidence(), context(arm_friction, arm_deviation, of_arm));
  const bool is_in_place = confirmed_.isJudged() && !whyNotJudged() && !is_new;
  // Found of the rows, unlike that they are too few: it takes the place of a verdict as a worse one does.
  const bool is_other =
      !verdict.fits &&
      (verdict.reason == Reason::EFFORT_UNIT || verdict.reason == Reason::LESS_THAN_FAULTS ||
       verdict.reason == Reason::NO_FRICTION || !of_arm.clause.empty() ||
       (!verdict.misfit.empty() && (verdict.misfit == known_.fitted.not_more || verdict.misfit == known_.fitted.not_less)));
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

std::optional<Misfit> VerdictWatch::whyNotJudged() const
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
  return evidence.isTouched() ? std::make_optional(Misfit{ Reason::CONTACT, contactText(evidence.contact().last()) }) :
                                std::nullopt;
}

Verdict VerdictWatch::now() const
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

void judgeTogether(const std::vector<VerdictWatch*>& joints, double tolerance)
{
  std::vector<MeasuredFriction> frictions;
  for (const VerdictWatch* joint : joints)
  {
    frictions.push_back(joint->measuredFriction());
  }
  const ArmFriction arm = commonFriction(frictions, tolerance);
  for (std::size_t i = 0; i < joints.size(); ++i)
  {
    joints[i]->judge(arm, i);
  }
}
}  // namespace hjt
