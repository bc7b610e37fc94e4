// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "output/report.hpp"
#include "recordings/recording_contents.hpp"
#include "recordings/recording_options.hpp"

#include "tracking/common_friction.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
constexpr const char* REPORT_PAGE = "report.html";

struct ComparisonOptions : RecordingOptions
{
  std::string report;     ///< directory of the page, its figures and data; of an arm a directory for each joint
  std::string reference;  ///< an earlier report of this joint or arm in sound condition; empty: none
};

/// A joint beside its twin.
struct ComparedJoint
{
  std::string name;  ///< short
  Verdict verdict;
  RecordingContents contents;
  std::string misfit;                    ///< of its recording; empty: it fits
  std::optional<double> friction_ratio;  ///< measured over expected; none: not known [-]
  double temperature{};                  ///< that it was judged at [degC]
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
  MotionFindings found;
  ArmFriction friction;               ///< what the joints have in common
  std::vector<ComparedJoint> joints;  ///< from the base on; none: stopped
  Json document;                      ///< the data of the page
  std::string page;                   ///< its path
};

/// Compares a recorded joint or arm with its twin: verdict, data and figures as a page.
/// @throws ParameterError, InputError: unreadable, a file that cannot be written, a page that cannot be made.
ComparedRecording compare(const ComparisonOptions& options);

/// A row for each joint.
Table tableOf(const ComparedRecording& compared);
}  // namespace hjt
