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
/// Joints and temperature that a recording contains.
struct CheckedContents
{
  bool is_csv{};
  bool has_angles{};                ///< whether at least one message has a position
  std::vector<std::string> named;   ///< names of the joints in the messages, without the entries of motors
  std::vector<std::string> usable;  ///< names of the joints with angle and effort
  std::string temperature;          ///< topic or column of the temperature; empty: none
};

/// One joint of the recording and its verdict.
struct CheckedJoint
{
  std::string name;   ///< short name; for a joint without an arm, its name in the messages
  std::string joint;  ///< name of the joint in the messages
  JointReach reach;
  bool has_velocity{};
  double gain{};         ///< torque per current that the program uses [N.m/A]
  double stated_gain{};  ///< torque per current that the recording states, NaN if it states none [N.m/A]
  FittedFactor time_factor;
  FittedFactor lag;
  std::vector<RecordingFinding> findings;
  Misfit misfit;    ///< why the joint's rows do not allow a verdict
  Verdict verdict;  ///< verdict on this joint, by the rules of `joint_twin compare`
};

/// A changed way of reading the recording, for example another time scale, and its effect.
struct TriedRemedy
{
  std::string options;  ///< options to add to a command for the change
  double before{};      ///< share of the currents that the load does not explain, without the change, rms [-]
  double after{};       ///< share of the currents that the load does not explain, with the change, rms [-]
  bool helps{};
};

/// An arm whose joints the recording has, or joints without a known arm.
struct CheckedArm
{
  JointAffixes affixes;
  std::vector<std::string> fitting;         ///< arms of the configuration whose joints the recording has
  std::vector<ArmFit> ranked;               ///< the fitting arms, the best one first; empty if the options name the arm
  std::string taken;                        ///< arm that the joints are judged with; empty: no arm
  std::vector<std::string> missing;         ///< names of the arm's joints without angle or effort
  std::vector<std::string> joints_at_hand;  ///< names of joints that are read without an arm
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

  bool isUsable() const;  ///< whether at least one joint is judged
  /// Ranked arms, other than the chosen one, that do not explain the currents clearly worse than the chosen arm.
  std::vector<std::string> alike() const;
};

struct RecordingCheck
{
  RecordingOptions options;
  CheckedContents contents;
  std::vector<CheckedArm> arms;  ///< arms in the recording, at least one entry

  bool isUsable() const;
};

/// Reads the recording with every arm whose joints it names, and judges the joints as `joint_twin compare` does. The
/// arm is that of the options or, without one, the best one. No file is changed. @throws InputError, ParameterError.
RecordingCheck checkRecording(const RecordingOptions& options);

/// Commands to run next, complete with all options of this check. Empty for a recording in memory.
std::vector<std::string> nextCommands(const RecordingCheck& check, const CheckedArm& arm);

Json documentOf(const RecordingCheck& check);
}  // namespace hjt
