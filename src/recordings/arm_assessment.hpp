// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arm/arm_ranking.hpp"
#include "arm/found_load.hpp"
#include "recordings/arm_recording.hpp"
#include "tracking/sound_joint.hpp"
#include "tracking/telemetry_rows.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
/// A joint of a recording beside its twin, and what is known of it: what `check`, `compare` and `follow` have in
/// common.
class AssessedJoint
{
public:
  /// `sound`: what is known of the joint in sound condition. `is_identified`: the parameters are of this very joint.
  /// @throws ParameterError as JointEvidence.
  AssessedJoint(const Parameters& parameters, LoadOrigin load, SoundJoint sound, bool is_identified)
    : evidence_(parameters, load), own_(std::move(sound.own)), is_identified_(is_identified)
  {
    evidence_.setReference(std::move(sound.baseline));
  }
  virtual ~AssessedJoint() = default;
  AssessedJoint(const AssessedJoint&) = delete;
  AssessedJoint& operator=(const AssessedJoint&) = delete;

  virtual JointEvidence::Row update(const MotionSample& sample) { return evidence_.update(sample); }
  const JointEvidence& evidence() const { return evidence_; }

  const OwnReference& own() const { return own_; }
  /// Whether a reference of the joint's friction is known.
  bool hasReference() const { return is_identified_ || !own_.friction.empty(); }
  /// Without a reference the friction is held against what the arm's controller expects.
  void holdAgainstController() { has_controller_ = true; }

  /// `factor` and `deviation` are of the friction that the joints of an arm have in common.
  JointContext context(const Misfit& misfit, double factor = 1.0, double deviation = UNWITNESSED) const
  {
    return { own_, is_identified_, has_controller_, factor, misfit, deviation };
  }
  MeasuredFriction friction(const Misfit& misfit) const { return measuredFriction(evidence_, context(misfit)); }

private:
  JointEvidence evidence_;
  const OwnReference own_;
  const bool is_identified_;
  bool has_controller_{};
};

using AssessedJoints = std::vector<std::unique_ptr<AssessedJoint>>;

/// The joints of a recording beside their twins after a pass through it.
struct ArmAssessment
{
  AssessedJoints joints;
  MotionFindings found;
  StreamTimingReport timing;
  JudgedJoints judged;
  std::optional<FoundLoad> load;
  AssumedLoad assumed;                    ///< load that the joints are judged with
  std::vector<FittedFriction> frictions;  ///< friction of each joint by the first pass; empty: not known

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
  /// Makes a joint by its number, anew for each pass through the recording; none: a plain one.
  std::function<std::unique_ptr<AssessedJoint>(std::size_t)> make_joint;
  bool beside_controller{ true };  ///< the friction that the controller expects may be the reference
  bool looks_for_arm{ true };      ///< nothing is judged if another shipped arm explains the recording clearly better
  bool gives_notice{};             ///< whether the user gets notices of what is wrong with the recording
};

/// Reads and judges the recording. If its currents show another payload or mounting, the recording is read again with
/// that load, which stays the recording's if it explains the currents. `fit` is that of the last pass.
/// @throws ParameterError, InputError.
ArmAssessment assess(ArmRecording& recording, const AssessmentSettings& settings, RecordingFit& fit);

/// Ranks the arms of these names, the best first, by how they explain the first two minutes of the recording and the
/// gains that it states. @throws InputError, ParameterError.
std::vector<ArmFit> rankArms(const RecordingOptions& options, const std::vector<std::string>& names);
}  // namespace hjt
