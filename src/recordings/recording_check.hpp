// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "arm/arm_ranking.hpp"
#include "output/json.hpp"
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
  bool has_angles{};                ///< at least one message has a position
  std::vector<std::string> named;   ///< joints in the messages, without the entries of motors
  std::vector<std::string> usable;  ///< joints with angle and effort
  std::string temperature;          ///< topic or column of the temperature; empty: none
};

/// One joint of the recording.
struct CheckedJoint
{
  std::string name;   ///< short name, for a joint of an arm
  std::string joint;  ///< name of the joint in the messages
  JointReach reach;
  bool has_velocity{};
  double gain{};         ///< torque per current that counts [N.m/A]
  double stated_gain{};  ///< torque per current that the recording states, else NaN [N.m/A]
  FittedFactor time_factor;
  FittedFactor lag;
  std::vector<RecordingFinding> findings;
  Misfit misfit;    ///< misfit of the joint's rows
  Verdict verdict;  ///< verdict on this joint, by the rules of `joint_twin compare`
};

/// A change of how the recording is read, and its effect on this recording.
struct TriedRemedy
{
  std::string options;  ///< options to add to a command
  double before{};      ///< share of the currents that the load leaves without the change, rms [-]
  double after{};       ///< share of the currents that the load leaves with the change, rms [-]
  bool helps{};
};

/// One arm in the recording, or joints of no known arm.
struct CheckedArm
{
  JointAffixes affixes;
  std::vector<std::string> fitting;         ///< arms of the configuration that have these joints
  std::vector<ArmFit> ranked;               ///< the fitting arms, the best first; empty if the options name the arm
  std::string taken;                        ///< arm that the joints are judged with; empty: none
  std::vector<std::string> missing;         ///< joints of the arm without angle or effort
  std::vector<std::string> joints_at_hand;  ///< joints that are read without an arm
  MotionFindings found;
  StreamTimingReport timing;
  FittedFactor stamps;
  EffortFit effort;
  EffortUnit configured_effort{};
  RecordingFit::LoadRest rest;
  double temperature{};
  std::vector<RecordingFinding> findings;
  AssumedLoad assumed;  ///< load that the joints are judged with
  std::vector<CheckedJoint> joints;
  std::vector<TriedRemedy> tried;

  bool isUsable() const;  ///< whether a joint is judged
  /// Ranked arms that do not explain the currents clearly worse than the arm that was taken.
  std::vector<std::string> alike() const;
};

struct RecordingCheck
{
  RecordingOptions options;
  CheckedContents contents;
  std::vector<CheckedArm> arms;  ///< arms in the recording; at least one

  bool isUsable() const;
};

/// Reads the recording with every arm whose joints it names, and judges the joints as `joint_twin compare` does, with
/// the arm of the options or the best one. Remedies are tried in memory. @throws InputError, ParameterError.
RecordingCheck checkRecording(const RecordingOptions& options);

/// Commands to run next, ready to paste, with options that were tried only. A recording in memory has no commands.
std::vector<std::string> nextCommands(const RecordingCheck& check, const CheckedArm& arm);

Json documentOf(const RecordingCheck& check);
}  // namespace hjt
