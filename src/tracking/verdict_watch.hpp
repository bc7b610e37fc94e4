// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
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
  /// `tracker`: must outlive this. `is_identified`: the friction of the parameters is that of this joint.
  VerdictWatch(Tracker& tracker, const Parameters& parameters, bool is_identified)
    : tracker_(tracker), parameters_(parameters), is_identified_(is_identified)
  {
  }

  /// What does not fit in the telemetry; none: nothing, or that is not yet `settled`.
  void setMisfit(const Misfit& misfit, bool settled);
  const Misfit& misfit() const { return misfit_; }

  /// As `joint_twin compare` measures it, of the rows that the verdict is of.
  MeasuredFriction measuredFriction() const;

  /// Makes the verdict again; `arm_friction`: what all joints have in common of `measuredFriction` [-].
  void judge(double arm_friction);

  /// Why nothing is judged at the moment; none: it is.
  std::optional<Misfit> whyNotJudged() const;

  double lastRow() const { return tracker_.evidence().reach().end; }  ///< that counts [s]

  /// The one that stands.
  const Verdict& confirmed() const { return confirmed_; }
  /// That one, or why nothing is judged at the moment.
  Verdict now() const;

private:
  static constexpr double JUDGED_SPAN = 1800.0;    // [s]
  static constexpr double CONFIRMED_AFTER = 10.0;  // [s]

  JointContext context(double arm_friction) const;

  Tracker& tracker_;
  const Parameters parameters_;
  const bool is_identified_;
  Misfit misfit_;
  bool settled_{ true };
  Verdict confirmed_;
  double confirmed_at_{};  // time up to which no worse verdict was found [s]
};

/// Each joint after what the friction of all has in common within `tolerance`, as `joint_twin compare` judges a
/// recording.
void judgeTogether(const std::vector<VerdictWatch*>& joints, double tolerance);
}  // namespace hjt
