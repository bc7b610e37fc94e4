// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "arm/load_law.hpp"
#include "recordings/arm_recording.hpp"
#include "recordings/assessed_joint.hpp"
#include "tracking/stream_timing.hpp"

namespace hjt
{
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
