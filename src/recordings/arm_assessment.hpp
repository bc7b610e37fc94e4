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
/// A joint of a recording, its twin, and what is known of the joint. `check`, `compare` and `follow` use this class.
class AssessedJoint
{
public:
  /// `sound`: what is known of the joint in sound condition. `is_identified`: whether the parameters were identified on
  /// this very joint. @throws ParameterError for the reasons that JointEvidence names.
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
  /// Whether a reference of the joint's friction is known, by identification or from earlier reports.
  bool hasReference() const { return is_identified_ || !own_.friction.empty(); }
  /// Compares the friction with the friction that the arm's controller expects, unless a reference is known.
  void holdAgainstController() { has_controller_ = true; }

  /// `factor`: common factor of the joints' friction [-]. `deviation`: standard deviation of its logarithm [-].
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

/// Joints of a recording and their twins after the program has read the recording.
struct ArmAssessment
{
  AssessedJoints joints;
  MotionFindings found;
  StreamTimingReport timing;
  JudgedJoints judged;
  std::optional<FoundLoad> load;
  AssumedLoad assumed;  ///< load that the joints are judged with
  /// Friction of each joint from the first reading of the recording. Empty: not known.
  std::vector<FittedFriction> frictions;

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
  /// Makes the joint with this number, once for each reading of the recording. Null: a plain AssessedJoint is made.
  std::function<std::unique_ptr<AssessedJoint>(std::size_t)> make_joint;
  bool beside_controller{ true };  ///< whether the friction that the controller expects may be the reference
  /// Whether the joints get no verdict if another shipped arm explains the recording clearly better than the given arm.
  bool looks_for_arm{ true };
  bool gives_notice{};  ///< whether the user gets notices of defects of the recording
};

/// Reads and judges the recording. If the currents show another payload or mounting than the configured one, the
/// function reads the recording again with the load found, and keeps this load if it explains the currents. `fit` gets
/// the result of the last reading. @throws ParameterError, InputError.
ArmAssessment assess(ArmRecording& recording, const AssessmentSettings& settings, RecordingFit& fit);

/// Ranks the named arms, the best first, by how well they explain the first two minutes of the recording and the gains
/// that the recording states. @throws InputError, ParameterError.
std::vector<ArmFit> rankArms(const RecordingOptions& options, const std::vector<std::string>& names);
}  // namespace hjt
