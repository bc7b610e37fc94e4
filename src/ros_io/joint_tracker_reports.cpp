// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <string>

#include "messages/time.hpp"
#include "ros_io/joint_tracker.hpp"

namespace hjt
{
using diagnostic_updater::DiagnosticStatusWrapper;

void JointTracker::reportTelemetry(DiagnosticStatusWrapper& status) const
{
  const StreamTimingReport timing = stream_.timing.report();
  const TrackerCounters counters = tracker_.counters();
  status.add("Topic", stream_.topic);
  status.add("Joint", names_.joint);
  status.add("Rows", timing.rows);
  status.add("Period [s]", timing.period);
  status.add("Rows missing", timing.missing);
  status.add("Longest gap [s]", timing.longest_gap);
  status.add("Gaps that cut the stream", counters.gaps);
  status.add("Stamps repeated", timing.repeated);
  status.add("Stamps going back", timing.backward);
  status.add("Restarts", counters.restarts + stream_.clock_changes);
  status.add("Reception less stamp [s]", timing.offset);
  status.add("Jitter of reception, 95 % [s]", timing.jitter);
  status.add("Unknown joint, refused", refusals_.unknown_joint);
  status.add("Names in the last of those", stream_.found_names);
  status.add("Without position or effort, refused", refusals_.incomplete);
  status.add("Efforts all zero, refused", stream_.without_effort);
  status.add("Angles that cannot be, left out", stream_.left_out.impossible + stream_.left_out.unreachable);
  status.add("Values that repeat in motion, left out", stream_.left_out.repeated);
  status.add("Stamps in bunches, left out", stream_.left_out.bunched);
  status.add("Jumps of angles by a turn, taken out", stream_.folds);
  status.add("Mounting that is not configured", stream_.mounting.empty() ? "none found" : stream_.mounting);
  status.add("Drag of the tool", stream_.drag.empty() ? "none found" : stream_.drag);
  status.add("Payload that is not configured", stream_.payload.empty() ? "none found" : stream_.payload);
  status.add("Not finite, refused", refusals_.not_finite);
  status.add("Too large, refused", stream_.too_large.load());
  status.add("Stamp far from the clock, refused", stream_.far_stamps);
  status.add("Loads refused", refusals_.load);
  status.add("Rows without a load", counters.without_load);
  status.add("Temperatures refused", refusals_.temperature);
  status.add("Temperatures of other frames", stream_.other_temperatures);
  if (last_load_stamp_)
  {
    status.add("Load's stamp before the newest row's reception [s]",
               toSeconds(stream_.last_received - *last_load_stamp_));
  }
}

void JointTracker::reportComparison(DiagnosticStatusWrapper& status) const
{
  const TrackerCounters counters = tracker_.counters();
  const std::optional<double> lag = tracker_.lag();
  const MotionReach& reach = tracker_.evidence().reach();
  const Verdict& verdict = verdict_.confirmed();
  status.add("Verdict", levelName(verdict.level));
  for (const Finding& finding : verdict.findings)
  {
    status.add(subjectTitle(finding.subject), levelName(finding.level) + (". " + findingText(verdict, finding)));
  }
  status.add("Verdict is of the last [s]", reach.end - reach.begin);
  status.add("Residual of the current [A]", comparison_.current.residual());
  status.add("Its band [A]", comparison_.current.band);
  status.add("Residual of the position [rad]", comparison_.position.residual());
  status.add("Residual of the velocity [rad/s]", comparison_.velocity.residual());
  status.add("Joint torque net of friction [N.m]", comparison_.joint_torque);
  status.add("Load [N.m]", comparison_.load_torque);
  status.add("Temperature [degC]",
             counters.compared > 0 ? comparison_.temperature : tracker_.evidence().parameters().input.temperature);
  status.add("Temperature is", comparison_.temperature_received          ? "received" :
                               tracker_.hasEstimate()                    ? "estimated from the friction of all joints" :
                               thermal_model_ == ThermalModel::TWO_NODES ? "estimated from the losses of the motion" :
                                                                           "configured");
  status.add("Friction that all joints have in common [-]", arm_friction_);
  status.add("Rows compared", counters.compared);
  status.add("Rows outside the band", counters.outside);
  status.add("Share of the last ones outside [-]", tracker_.outsideShare());
  status.add("Steps failed", counters.solver_failures + outputs_.failures());
  if (lag)
  {
    status.add("Measured after predicted [s]", *lag);
  }
  else
  {
    status.add("Measured after predicted [s]", "unknown");
  }
}

void JointTracker::reportHealth(DiagnosticStatusWrapper& status) const
{
  addAssessment(tracker_.assessment(), status);
}
}  // namespace hjt
