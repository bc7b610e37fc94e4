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
/// One joint of the arm at the time of a row.
struct ArmJointRow
{
  MotionSample row;        ///< its load the one chosen, at the output; rates are those of an arm's joint only
  double recorded_load{};  ///< [N.m]
  double motor_part{};     ///< of the motor's inertia, in a controller's torque beside the arm's load [N.m]
};

/// The recording of an arm, or of one joint as an arm of one, and the twin's parameters of each of its joints. The load
/// of one joint is the recorded one.
class ArmRecording
{
public:
  using VisitRows = std::function<void(const std::vector<ArmJointRow>&)>;
  using VisitSample = std::function<void(std::size_t, const MotionSample&)>;

  /// @throws ParameterError, InputError: unreadable, or without the load that is chosen.
  explicit ArmRecording(const RecordingOptions& options);

  const RecordingOptions& options() const { return options_; }
  bool isArm() const { return is_arm_; }
  bool isFile() const { return !options_.rows; }
  const ArmDescription& arm() const { return arm_; }  ///< for a single joint: that joint alone
  const std::vector<ArmJoint>& joints() const { return arm_.joints; }
  /// The same arm under another load, in place of the configured one.
  void setLoad(ArmDescription arm, PayloadCourse course)
  {
    arm_ = std::move(arm);
    course_ = std::move(course);
  }
  MotionSource source(std::size_t joint) const;        ///< with that joint alone
  std::string twinNamespace(std::size_t joint) const;  ///< of its twin's topics, those of arm.launch
  /// `telemetry.inertia_in_load` is that of the load that is chosen.
  const Parameters& parameters(std::size_t joint) const { return parameters_[joint]; }
  const std::vector<Parameters>& parameters() const { return parameters_; }
  /// Torque per current that an arm's recording states, see RecordedStatements; it counts unless another was identified
  /// or set [N.m/A].
  const std::vector<double>& statedGains() const { return stated_gains_; }
  bool hasRecordedLoad() const { return has_load_; }
  /// The load is the recorded one.
  bool usesRecordedLoad() const { return uses_recorded_; }
  LoadOrigin loadOrigin() const
  {
    return uses_recorded_ ? LoadOrigin::RECORDED : is_arm_ ? LoadOrigin::ARM : LoadOrigin::CONFIGURED;
  }

  /// Calls `visit` for each time with a row of each joint, in memory that does not grow; `fit` receives all rows of an
  /// arm. Without any load the rows' is 0. @throws InputError.
  MotionFindings read(const VisitRows& visit, RecordingFit& fit) const;

  /// The rows as they are recorded: of an arm `current` is the effort. @throws InputError.
  MotionCount readRows(const VisitMotionRows& visit) const;

  /// Calls `visit` with the samples of each joint, their rates and loads filled in; a joint without any load carries
  /// what it is configured to. @throws InputError.
  MotionFindings readSamples(const VisitSample& visit, RecordingFit& fit) const;

  /// Gives notice of what does not fit in an arm: why a joint cannot be judged. Wrong stamps are said of the whole.
  void noticeOf(const RecordingFit& fit) const;
  /// And of the whole recording.
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
  std::vector<double> inertias_in_load_;  // of the motors, in a controller's torque, at the joints [kg.m^2]
  MotionSource source_;
  std::string payload_text_;  // where it is the controller's in place of the file's; else empty
  bool has_load_{};
  bool uses_recorded_{};
};
}  // namespace hjt
