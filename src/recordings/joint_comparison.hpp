// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "output/output_file.hpp"
#include "recordings/arm_recording.hpp"
#include "recordings/compare.hpp"
#include "recordings/comparison_files.hpp"
#include "recordings/recording_comparison.hpp"

#include "tracking/sound_joint.hpp"

namespace hjt
{
constexpr const char* MADE_WITH = "joint_twin " HJT_VERSION;

/// A joint that is being compared, its source, and the directory of its report.
class JointComparison
{
public:
  /// `directory`: of its report. `references`: directories of earlier reports; empty: none. `is_identified`: the
  /// parameters are of this very joint.
  JointComparison(const ArmRecording& recording, std::size_t joint, LoadOrigin load, const std::string& directory,
                  const std::vector<std::string>& references, bool is_identified);

  void update(const MotionSample& sample) { comparison_.update(sample); }

  const JointEvidence& evidence() const { return comparison_.evidence(); }

  bool hasReference() const { return is_identified_ || !sound_.own.friction.empty(); }  ///< of its friction
  /// Without a reference the friction is held against what the arm's controller expects.
  void holdAgainstController() { has_controller_ = true; }

  MeasuredFriction friction(const Misfit& misfit) const;
  /// Why it is not judged; SOUND: it is.
  Reason frictionReason() const;

  /// Judges, and writes the data of the page. `arm`: what the joints have in common. `twin_topic`: of a twin that was
  /// recorded beside the robot. @throws InputError.
  ComparedJoint write(const MotionFindings& found, const ArmFriction& arm, const Misfit& misfit,
                      const std::string& twin_topic);

private:
  const std::size_t joint_;
  const Parameters parameters_;
  const MotionSource source_;
  const bool is_file_;
  const std::string directory_;
  const SoundJoint sound_;
  const bool is_identified_;
  bool has_controller_{};
  TableFile<JudgedWindow> windows_;
  RecordingComparison comparison_;
};
}  // namespace hjt
