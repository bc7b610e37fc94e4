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
  bool beside_controller{ true };  ///< without a reference hold the friction against the controller's where that is one
  /// Directory of the page, its figures and data; of an arm a directory for each joint. Empty: nothing is written.
  std::string report;
  std::vector<std::string> references;  ///< earlier reports of this joint or arm in sound condition; empty: none
};

void addOptions(OptionTable& table, ComparisonOptions& options);
/// Earlier reports to judge by.
void addReferenceOption(OptionTable& table, ComparisonOptions& options);

/// A topic or column that a comparison can use.
struct ContentLine
{
  std::string name;
  std::string gives;
  std::uint64_t messages{};  ///< rows of a CSV file; of temperatures: rows that have one
  bool found{};
};

/// Contents of a recording.
struct RecordingContents
{
  std::vector<ContentLine> lines;
  std::vector<std::string> joints;        ///< named in the telemetry's first message
  std::vector<std::string> other_topics;  ///< that a comparison does not use
};

/// A joint beside its twin.
struct ComparedJoint
{
  std::string name;  ///< short
  Verdict verdict;
  RecordingContents contents;
  std::optional<FrictionFactor> friction;  ///< measured over expected; none: not judged
  std::string contact;                     ///< contact that was found, in a sentence; empty: none
  double temperature{};                    ///< that it was judged at [degC]
  const char* temperature_source{};
  std::uint64_t rows{};
  double current_rms{};   ///< measured [A]
  double residual_rms{};  ///< measured less predicted [A]
  Json document;          ///< the data of its page
};

struct ComparedRecording
{
  bool is_arm{};
  std::string level;
  std::string text;  ///< a sentence or two
  bool is_judged{};
  std::size_t not_judged{};  ///< joints; the level does not speak for them
  HealthLevel health{};      ///< the worst of the joints
  MotionFindings found;
  AssumedLoad assumed;                ///< that the joints are judged with in place of the configured one
  ArmFriction friction;               ///< common factors of the joints
  std::vector<ComparedJoint> joints;  ///< from the base on; none: stopped
  Json document;                      ///< the data of the page
  std::string page;                   ///< its path; empty: none
};

/// Compares a recorded joint or arm with its twin: verdict, data and figures as a page.
/// @throws ParameterError, InputError: unreadable, a file that cannot be written, a page that cannot be made.
ComparedRecording compare(const ComparisonOptions& options);

/// A row for each joint.
Table tableOf(const ComparedRecording& compared);

constexpr const char* REPORT_PAGE = "report.html";

/// Runs the script that makes page and pictures of the data in a directory. @throws InputError if it does not end well.
void makePage(const std::string& directory);
}  // namespace hjt
