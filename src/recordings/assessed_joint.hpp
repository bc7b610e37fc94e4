// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

#include "tracking/verdict.hpp"

namespace hjt
{
/// A joint of a recording beside its twin, and what is known of it: what `check` and `compare` have in common.
class AssessedJoint
{
public:
  AssessedJoint(OwnReference own, bool is_identified) : own_(std::move(own)), is_identified_(is_identified) {}
  virtual ~AssessedJoint() = default;
  AssessedJoint(const AssessedJoint&) = delete;
  AssessedJoint& operator=(const AssessedJoint&) = delete;

  virtual void update(const MotionSample& sample) = 0;
  virtual const JointEvidence& evidence() const = 0;

  const OwnReference& own() const { return own_; }
  bool hasReference() const { return is_identified_ || !own_.friction.empty(); }  ///< of its friction
  /// Without a reference the friction is held against what the arm's controller expects.
  void holdAgainstController() { has_controller_ = true; }

  /// `factor`, `deviation`: what the joints of an arm have in common.
  JointContext context(const Misfit& misfit, double factor = 1.0, double deviation = UNWITNESSED) const
  {
    return { own_, is_identified_, has_controller_, factor, misfit, deviation };
  }
  MeasuredFriction friction(const Misfit& misfit) const { return measuredFriction(evidence(), context(misfit)); }
  /// Why it is not judged; SOUND: it is.
  Reason frictionReason() const { return frictionFactor(evidence(), context({})).reason; }

private:
  const OwnReference own_;
  const bool is_identified_;
  bool has_controller_{};
};
}  // namespace hjt
