// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "arm/arm_ranking.hpp"
#include "recordings/arm_assessment.hpp"
#include "recordings/arm_recording.hpp"

#include "tracking/telemetry_rows.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
/// Contents of a recording.
struct CheckedContents
{
  bool is_csv{};
  bool has_angles{};                ///< messages: a position
  std::vector<std::string> named;   ///< joints in the messages, their motors' entries not among them
  std::vector<std::string> usable;  ///< those with angle and effort
  std::string temperature;          ///< topic or column; empty: none
};

/// One joint of the recording.
struct CheckedJoint
{
  std::string name;   ///< short, of an arm's
  std::string joint;  ///< in the messages
  JointReach reach;
  bool has_velocity{};
  double gain{};         ///< telemetry.torque_per_current that counts [N.m/A]
  double stated_gain{};  ///< that the recording states; NaN: none [N.m/A]
  FittedFactor time_factor;
  FittedFactor lag;
  std::vector<RecordingFinding> findings;
  Misfit misfit;    ///< of its rows
  Verdict verdict;  ///< as that of `joint_twin compare`
};

/// A change of how the recording is read, and what came of it on this very recording.
struct TriedRemedy
{
  std::string options;  ///< to add to a command
  double before{};      ///< share of the currents that the load leaves, rms [-]
  double after{};
  bool helps{};
};

/// One arm in the recording; or joints of none.
struct CheckedArm
{
  JointAffixes affixes;
  std::vector<std::string> fitting;         ///< arms of the configuration that have these joints
  std::vector<ArmFit> ranked;               ///< those, the best first; empty: the choice was given
  std::string taken;                        ///< empty: none
  std::vector<std::string> missing;         ///< joints of the arm without angle or effort
  std::vector<std::string> joints_at_hand;  ///< read without an arm
  MotionFindings found;
  StreamTimingReport timing;
  FittedFactor stamps;
  EffortFit effort;
  EffortUnit configured_effort{};
  RecordingFit::LoadRest rest;
  double temperature{};
  std::vector<RecordingFinding> findings;
  AssumedLoad assumed;  ///< that the joints are judged with in place of the configured one
  std::vector<CheckedJoint> joints;
  std::vector<TriedRemedy> tried;

  bool isUsable() const;  ///< a joint is judged
  /// Of the arms that were ranked, those that explain the currents no clearly worse than the one taken.
  std::vector<std::string> alike() const;
};

struct RecordingCheck
{
  RecordingOptions options;
  CheckedContents contents;
  std::vector<CheckedArm> arms;  ///< at least one

  bool isUsable() const;
};

/// Reads the recording with every arm whose joints it names, and judges the joints with the best, or with that of the
/// options, as `joint_twin compare` does. Remedies are tried in memory. @throws InputError, ParameterError.
RecordingCheck checkRecording(const RecordingOptions& options);
}  // namespace hjt
