// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "output/output_file.hpp"
#include "recordings/arm_recording.hpp"
#include "recordings/assessed_joint.hpp"
#include "recordings/compare.hpp"
#include "recordings/comparison_files.hpp"
#include "recordings/recording_comparison.hpp"

#include "tracking/sound_joint.hpp"

namespace hjt
{
constexpr const char* MADE_WITH = "joint_twin " HJT_VERSION;

/// A joint that is being compared, its source, and the directory of its report.
class JointComparison : public AssessedJoint
{
public:
  /// `directory`: of its report. `sound`: what earlier reports left of it. `is_identified`: the parameters are of this
  /// very joint.
  JointComparison(const ArmRecording& recording, std::size_t joint, const std::string& directory, SoundJoint sound,
                  bool is_identified);

  void update(const MotionSample& sample) override { comparison_.update(sample); }
  const JointEvidence& evidence() const override { return comparison_.evidence(); }

  /// Judges, and writes the data of the page. `parameters`: of this joint. `twin_topic`: of a twin that was recorded
  /// beside the robot.
  /// @throws InputError.
  ComparedJoint write(const Parameters& parameters, const MotionFindings& found, const JointContext& context,
                      const std::string& twin_topic);

private:
  const MotionSource source_;
  const bool is_file_;
  const std::string directory_;                     // empty: no file is written
  std::optional<TableFile<JudgedWindow>> windows_;  // likewise
  RecordingComparison comparison_;
};
}  // namespace hjt
