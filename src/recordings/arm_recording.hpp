// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "arm/arm_load.hpp"
#include "arm/recording_fit.hpp"
#include "recordings/recording_options.hpp"
#include "tracking/joint_evidence.hpp"

namespace hjt
{
/// Values of one joint of an arm in a row.
struct ArmJointRow
{
  MotionSample row;  ///< has the chosen load at the output; speed and acceleration are set only for a joint of an arm
  double recorded_load{};  ///< load at the joint as the recording states it [N.m]
  double motor_part{};     ///< torque of the motor's inertia that a controller counts as load of the joint [N.m]
};

/// The recording of an arm or of a single joint, and the parameters of the joints' twins. A single joint counts as an
/// arm of one joint. The load of a single joint is the recorded load, if the recording has one.
class ArmRecording
{
public:
  using VisitRows = std::function<void(const std::vector<ArmJointRow>&)>;
  using VisitSample = std::function<void(std::size_t, const MotionSample&)>;

  /// @throws ParameterError; InputError if the recording is unreadable or lacks the chosen load.
  explicit ArmRecording(const RecordingOptions& options);

  const RecordingOptions& options() const { return options_; }
  bool isArm() const { return is_arm_; }
  bool isFile() const { return !options_.rows; }
  const ArmDescription& arm() const { return arm_; }  ///< for a single joint, an arm with only this joint
  const std::vector<ArmJoint>& joints() const { return arm_.joints; }
  /// Replaces the load of the arm. `arm`: the same arm with the new load. `course`: payloads that begin at later times.
  void setLoad(ArmDescription arm, PayloadCourse course)
  {
    arm_ = std::move(arm);
    course_ = std::move(course);
  }
  MotionSource source(std::size_t joint) const;        ///< source that reads only this joint
  std::string twinNamespace(std::size_t joint) const;  ///< namespace of the twin's topics, as in arm.launch
  /// Parameters of a joint. In an arm, telemetry.inertia_in_load is 0 unless the recorded load is used.
  const Parameters& parameters(std::size_t joint) const { return parameters_[joint]; }
  const std::vector<Parameters>& parameters() const { return parameters_; }
  /// Gain of each joint, as the recording states it (RecordedStatements) [N.m/A]; NaN if the recording states none. An
  /// identified or configured gain takes precedence over the stated gain.
  const std::vector<double>& statedGains() const { return stated_gains_; }
  bool hasRecordedLoad() const { return has_load_; }
  /// Whether the joints' load is the recorded load.
  bool usesRecordedLoad() const { return uses_recorded_; }
  LoadOrigin loadOrigin() const
  {
    return uses_recorded_ ? LoadOrigin::RECORDED : is_arm_ ? LoadOrigin::ARM : LoadOrigin::CONFIGURED;
  }

  /// Calls `visit` for each time at which all joints have a row, with the rows of this time. A row without a load has a
  /// load of 0. `fit` gets all rows of an arm. The use of memory does not grow with the recording. @throws InputError.
  MotionFindings read(const VisitRows& visit, RecordingFit& fit) const;

  /// Calls `visit` with the rows as they are recorded. In rows of an arm `current` is the effort. @throws InputError.
  MotionCount readRows(const VisitMotionRows& visit) const;

  /// Calls `visit` with the samples of each joint, including rates and load. A joint without a recorded load carries
  /// the configured load. @throws InputError.
  MotionFindings readSamples(const VisitSample& visit, RecordingFit& fit) const;

  /// Tells the user why joints of an arm cannot be judged. Wrong stamps are left to the other noticeOf.
  void noticeOf(const RecordingFit& fit) const;
  /// Tells the user of defects of the whole recording, including wrong stamps.
  void noticeOf(const MotionFindings& found) const;

private:
  MotionFindings readJoint(const VisitRows& visit) const;
  MotionFindings readArm(const VisitRows& visit, RecordingFit& fit) const;

  RecordingOptions options_;
  bool is_arm_;
  ArmDescription arm_;
  PayloadCourse course_;
  std::vector<double> stated_gains_;
  std::vector<Parameters> parameters_;
  std::vector<double> inertias_in_load_;  // inertia of each motor in the controller's torque of its joint [kg.m^2]
  MotionSource source_;
  std::string payload_text_;  // remark on a stated payload; empty: the payload of the arm's file counts
  bool has_load_{};
  bool uses_recorded_{};
};
}  // namespace hjt
