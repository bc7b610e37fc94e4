// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "arm/load_law.hpp"
#include "recordings/arm_recording.hpp"
#include "tracking/telemetry_rows.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
/// A joint of a recording beside its twin, and what is known of it: what `check`, `compare` and `follow` have in
/// common.
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

/// The same without output files.
class AssessedTwin : public AssessedJoint
{
public:
  AssessedTwin(const Parameters& parameters, LoadOrigin load, bool is_identified)
    : AssessedJoint(OwnReference(), is_identified), evidence_(parameters, load)
  {
  }
  void update(const MotionSample& sample) override { evidence_.update(sample); }
  const JointEvidence& evidence() const override { return evidence_; }

private:
  JointEvidence evidence_;
};

/// The joints beside their twins, made anew for each reading.
class AssessedTwins
{
public:
  std::vector<AssessedJoint*> make(const std::vector<Parameters>& parameters, LoadOrigin load, bool is_identified)
  {
    joints_.clear();
    std::vector<AssessedJoint*> all;
    for (const Parameters& of : parameters)
    {
      all.push_back(joints_.emplace_back(std::make_unique<AssessedTwin>(of, load, is_identified)).get());
    }
    return all;
  }

  AssessedTwin& operator[](std::size_t joint) const { return *joints_[joint]; }

private:
  std::vector<std::unique_ptr<AssessedTwin>> joints_;
};

/// The joints of a recording beside their twins after a pass through it.
struct ArmAssessment
{
  std::vector<AssessedJoint*> joints;
  MotionFindings found;
  StreamTimingReport timing;
  JudgedJoints judged;
  std::optional<FoundLoad> load;
  AssumedLoad assumed;                    ///< that the joints are judged with
  std::vector<FittedFriction> frictions;  ///< of each joint, of the first pass; empty: none

  JointContext context(std::size_t joint) const
  {
    JointContext context =
        joints[joint]->context(judged.misfits[joint], judged.common.factors[joint], judged.common.deviations[joint]);
    context.fitted = frictions.empty() ? FittedFriction() : frictions[joint];
    return context;
  }
};

struct AssessmentSettings
{
  /// New joints, for each pass through the recording; theirs is the caller.
  std::function<std::vector<AssessedJoint*>()> make_joints;
  bool beside_controller{ true };  ///< without a reference hold the friction against the controller's where that is one
  bool looks_for_arm{ true };      ///< judge nothing where another shipped arm explains the recording clearly better
  bool gives_notice{ true };       ///< whether misfits of the recording are printed
  Watch watch;
};

/// Reads the recording, and again with the payload and the mounting that its currents show, where these explain them:
/// they are the recording's then. `fit` is that of the last pass. @throws ParameterError, InputError.
ArmAssessment assess(ArmRecording& recording, const AssessmentSettings& settings, RecordingFit& fit);
}  // namespace hjt
