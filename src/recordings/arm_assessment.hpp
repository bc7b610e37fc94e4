// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "arm/found_load.hpp"
#include "recordings/arm_recording.hpp"
#include "recordings/assessed_joint.hpp"
#include "tracking/common_friction.hpp"
#include "tracking/stream_timing.hpp"

namespace hjt
{
/// What a recording is assumed to be of, in place of what is configured, since it explains the currents.
struct AssumedLoad
{
  std::optional<IdentifiedPayload> payload;
  std::optional<IdentifiedMounting> mounting;

  std::string text() const;  ///< in sentences; empty: as configured
};

/// The joints of a recording beside their twins after a pass through it.
struct ArmAssessment
{
  std::vector<AssessedJoint*> joints;
  MotionFindings found;
  StreamTimingReport timing;
  std::vector<Misfit> misfits;  ///< of each
  ArmFriction friction;         ///< what they have in common
  std::optional<FoundLoad> load;
  AssumedLoad assumed;

  JointContext context(std::size_t joint) const
  {
    return joints[joint]->context(misfits[joint], found.duration, friction.factors[joint], friction.deviations[joint]);
  }
};

struct AssessmentSettings
{
  /// New joints, for each pass through the recording; theirs is the caller.
  std::function<std::vector<AssessedJoint*>()> make_joints;
  bool beside_controller{ true };  ///< without a reference hold the friction against the controller's where that is one
  bool gives_notice{ true };       ///< of what does not fit in the recording
  Watch watch;
};

/// Reads the recording, and again with the payload and the mounting that its currents show, where these explain them:
/// they are the recording's then. `fit` is that of the last pass. @throws ParameterError, InputError.
ArmAssessment assess(ArmRecording& recording, const AssessmentSettings& settings, RecordingFit& fit);
}  // namespace hjt
