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
  bool beside_controller{ true };  ///< the friction that the controller expects may be the reference
  /// Directory of the page, its figures and data, with a directory for each joint of an arm. Empty: nothing is written.
  std::string report;
  std::vector<std::string> references;  ///< earlier reports of the joint or arm in sound condition
};

void addOptions(OptionTable& table, ComparisonOptions& options);
/// Adds the option for earlier reports to judge by.
void addReferenceOption(OptionTable& table, ComparisonOptions& options);

/// A topic or column that a comparison can use.
struct ContentLine
{
  std::string name;
  std::string gives;
  std::uint64_t messages{};  ///< number of messages, or of rows with a value
  bool found{};
};

/// Contents of a recording.
struct RecordingContents
{
  std::vector<ContentLine> lines;
  std::vector<std::string> joints;        ///< named in the telemetry's first message
  std::vector<std::string> other_topics;  ///< topics that a comparison does not use
};

/// A joint beside its twin.
struct ComparedJoint
{
  std::string name;  ///< short name
  Verdict verdict;
  RecordingContents contents;
  std::optional<FrictionFactor> friction;  ///< measured friction over the expected one; none if it is not judged
  std::string contact;                     ///< sentence on a contact that was found; empty: none
  double temperature{};                    ///< temperature at which the joint was judged [degC]
  const char* temperature_source{};
  std::uint64_t rows{};
  double current_rms{};   ///< measured current [A]
  double residual_rms{};  ///< measured current less predicted current [A]
  Json document;          ///< data of the joint's page
};

struct ComparedRecording
{
  bool is_arm{};
  std::string level;
  std::string text;  ///< one or two sentences
  bool is_judged{};
  std::size_t not_judged{};  ///< number of joints that are not judged
  HealthLevel health{};      ///< worst level of the joints
  MotionFindings found;
  AssumedLoad assumed;                ///< load that the joints are judged with
  ArmFriction friction;               ///< friction that the joints have in common
  std::vector<ComparedJoint> joints;  ///< joints from the base on; none if the comparison was stopped
  Json document;                      ///< data of the page
  std::string page;                   ///< path of the page; empty: none
};

/// Compares a recorded joint or arm with its twin, and makes a page of verdict, data and figures if a report is wanted.
/// @throws ParameterError, InputError if the recording is unreadable, or a file or page cannot be made.
ComparedRecording compare(const ComparisonOptions& options);

/// Table with a row for each joint.
Table tableOf(const ComparedRecording& compared);

constexpr const char* REPORT_PAGE = "report.html";

/// Runs the script that makes a page and its pictures of the data in a directory. @throws InputError if the script
/// fails.
void makePage(const std::string& directory);
}  // namespace hjt
