// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harmonic_joint_twin/base/stamp.hpp"
#include "output/report.hpp"
#include "recordings/compare.hpp"
#include "tracking/friction_trend.hpp"

namespace hjt
{
struct TrendOptions : ComparisonOptions
{
  std::vector<std::string> recordings;  ///< recordings, or folders that hold recordings
  std::string out;                      ///< CSV file to write, with a row for each recording; empty: no file
};

void addOptions(OptionTable& table, TrendOptions& options);

/// A recording of a trend, with its date and its comparison with the twin.
struct DatedRecording
{
  std::string path;
  std::optional<Stamp> date;         ///< date of the first row [ns since 1970]; none if the stamps are not dates
  double time{};                     ///< time since the first recording [h]; without dates, its number from 0
  std::vector<std::string> remarks;  ///< remarks from reading the recording
  std::string unread;                ///< why the recording could not be compared; empty if it was compared
  ComparedRecording compared;  ///< comparison without documents; has no joints if the recording could not be compared
  /// Friction of each joint for its trend, divided by the common factor of the joint's group; none if it is not known.
  std::vector<std::optional<DatedFriction>> frictions;

  bool isRead() const { return !compared.joints.empty(); }
  const char* level() const { return isRead() ? compared.level.c_str() : levelName(VerdictLevel::NOT_JUDGED); }
  const std::string& text() const { return isRead() ? compared.text : unread; }
};

/// Trend of one joint's friction over all recordings.
struct JointTrend
{
  std::string name;  ///< short name of the joint
  FrictionTrend friction;
  VerdictLevel level{ VerdictLevel::NOT_JUDGED };
  std::string text;  ///< sentence on the trend of this joint
};

struct Trend
{
  bool is_arm{};
  bool has_dates{};  ///< whether all readable recordings have a date; if not, their order replaces the time
  std::vector<DatedRecording> recordings;  ///< recordings by date, unreadable ones last; none after a stop
  std::vector<JointTrend> joints;          ///< trends of the joints, from the base on
  std::optional<std::size_t> latest;       ///< number of the last recording that was judged
  std::string level;
  std::string text;          ///< sentences on the trends and the latest recording
  HealthLevel health{};      ///< worst level of the trends and the latest recording
  bool is_judged{};          ///< whether a trend or the latest recording is judged
  std::size_t not_judged{};  ///< number of joints without a trend and without a verdict in the latest recording
  std::string page;          ///< path of the page; empty: none
};

/// Judges each recording as `compare` does, and whether the friction of a joint changes from recording to recording.
///
/// In a folder the function reads files that end in .bag, .db3, .mcap, .csv or .active, and directories of ROS 2, but
/// no other folders. A recording that cannot be read stays in the list, with the reason.
/// @throws ParameterError, InputError if no recording can be read, or a file cannot be written.
Trend trend(const TrendOptions& options);

/// Text of a date in UTC: "2026-01-31 08:15" for people, and "2026-01-31T08:15:00Z" from isoDate.
std::string dateText(Stamp date);
std::string isoDate(Stamp date);

constexpr const char* TREND_FILE = "trend.json";

/// Time to which a slope in the report refers: 1000 [h], or 1 recording if the recordings have no dates.
double trendUnit(const Trend& trend);
const char* trendUnitText(const Trend& trend);  ///< unit of a slope in words, for example "per 1000 h"

Json documentOf(const Trend& trend);

/// CSV text with a row for each recording. Texts are in quotes, and an unknown number is empty.
std::string csvOf(const Trend& trend);

/// Table for people, with a row for each recording and a column for each joint.
Table recordingsOf(const Trend& trend);

Table jointsOf(const Trend& trend);
}  // namespace hjt
