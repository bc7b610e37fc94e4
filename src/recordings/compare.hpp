// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "output/report.hpp"
#include "recordings/arm_assessment.hpp"
#include "recordings/recording_options.hpp"
#include "tracking/common_friction.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
struct ComparisonOptions : RecordingOptions
{
  bool beside_controller{ true };  ///< whether the friction that the controller expects may be the reference
  /// Directory for the page, its figures and data, with a folder for each joint of an arm. Empty: nothing is written.
  std::string report;
  std::vector<std::string> references;  ///< earlier reports of the joint or arm in sound condition
};

void addOptions(OptionTable& table, ComparisonOptions& options);
/// Adds the option that names earlier reports of the sound joint or arm.
void addReferenceOption(OptionTable& table, ComparisonOptions& options);

/// A topic or column that a comparison can use.
struct ContentLine
{
  std::string name;
  std::string gives;
  std::uint64_t messages{};  ///< number of messages of the topic, or of rows with a value in the column
  bool found{};
};

/// What a recording contains: topics or columns, and joints.
struct RecordingContents
{
  std::vector<ContentLine> lines;
  std::vector<std::string> joints;        ///< joints that are named in the telemetry's first message
  std::vector<std::string> other_topics;  ///< topics that a comparison does not use
};

/// Result for one joint, compared with its twin.
struct ComparedJoint
{
  std::string name;  ///< short name of the joint
  Verdict verdict;
  RecordingContents contents;
  /// Measured friction over expected friction; none if the friction is not judged.
  std::optional<FrictionFactor> friction;
  std::string contact;   ///< sentence on a contact that was found; empty: no contact
  double temperature{};  ///< temperature at which the joint was judged [degC]
  const char* temperature_source{};
  std::uint64_t rows{};
  double current_rms{};   ///< measured current, rms [A]
  double residual_rms{};  ///< measured current less predicted current, rms [A]
  Json document;          ///< data of the joint's page
};

struct ComparedRecording
{
  bool is_arm{};
  std::string level;
  std::string text;  ///< sentences for the user on the joints that differ from sound joints or are not judged
  bool is_judged{};
  std::size_t not_judged{};  ///< number of joints that are not judged
  HealthLevel health{};      ///< worst level of the joints
  MotionFindings found;
  AssumedLoad assumed;                ///< load that the joints are judged with
  ArmFriction friction;               ///< common factors of the joints' friction
  std::vector<ComparedJoint> joints;  ///< joints from the base on; none if the comparison was stopped
  Json document;                      ///< data of the page
  std::string page;                   ///< path of the page; empty: none
};

/// Compares a recorded joint or arm with its twin. If options.report is set, also makes a page of verdict and figures.
/// @throws ParameterError, InputError if the recording is unreadable, or a file or page cannot be made.
ComparedRecording compare(const ComparisonOptions& options);

Table tableOf(const ComparedRecording& compared);

constexpr const char* REPORT_PAGE = "report.html";

/// Runs the script that makes a page with pictures from the data in a directory. @throws InputError if it fails.
void makePage(const std::string& directory);
}  // namespace hjt
