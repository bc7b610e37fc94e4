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
  std::vector<std::string> recordings;  ///< files, or folders of them
  std::string out;                      ///< CSV file to write, with a row for each recording; empty: none
};

void addOptions(OptionTable& table, TrendOptions& options);

/// A recording and its comparison.
struct DatedRecording
{
  std::string path;
  std::optional<Stamp> date;         ///< date of its first row [ns since 1970]; none if its stamps are no dates
  double time{};                     ///< hours since the first recording; without dates its place in the order
  std::vector<std::string> remarks;  ///< remarks of the reader
  std::string unread;                ///< why it was not compared; empty if it was
  ComparedRecording compared;        ///< comparison without documents; it has no joints if it failed
  /// Friction of each joint for its trend, apart from what the joints of its group have in common; none if it is not
  /// known.
  std::vector<std::optional<DatedFriction>> frictions;

  bool isRead() const { return !compared.joints.empty(); }
  const char* level() const { return isRead() ? compared.level.c_str() : levelName(VerdictLevel::NOT_JUDGED); }
  const std::string& text() const { return isRead() ? compared.text : unread; }
};

/// A joint over all recordings.
struct JointTrend
{
  std::string name;  ///< short name
  FrictionTrend friction;
  VerdictLevel level{ VerdictLevel::NOT_JUDGED };
  std::string text;  ///< a sentence
};

struct Trend
{
  bool is_arm{};
  bool has_dates{};                        ///< all recordings have a date; else their order stands for time
  std::vector<DatedRecording> recordings;  ///< recordings by date, unread ones last; none if stopped
  std::vector<JointTrend> joints;          ///< joints from the base on
  std::optional<std::size_t> latest;       ///< number of the last recording that was judged
  std::string level;
  std::string text;          ///< a sentence or two
  HealthLevel health{};      ///< worst level of the trends and the latest recording
  bool is_judged{};          ///< whether a trend or the latest recording is judged
  std::size_t not_judged{};  ///< number of joints without a trend and without a verdict in the latest recording
  std::string page;          ///< path of the page; empty: none
};

/// Judges each recording as `compare` does, and whether the friction of a joint changes from recording to recording.
///
/// Of a folder the function takes files that are named .bag, .db3, .mcap, .csv or .active, and directories of ROS 2,
/// but no other folders. A recording that cannot be read is kept with the reason.
/// @throws ParameterError, InputError if no recording can be read, or a file cannot be written.
Trend trend(const TrendOptions& options);

/// The date in UTC, as "2026-01-31 08:15" and "2026-01-31T08:15:00Z".
std::string dateText(Stamp date);
std::string isoDate(Stamp date);

constexpr const char* TREND_FILE = "trend.json";

/// Unit of a slope for people: 1000 h, or without dates one recording.
double trendUnit(const Trend& trend);
const char* trendUnitText(const Trend& trend);  ///< the unit in words, as "per 1000 h"

Json documentOf(const Trend& trend);

/// CSV text with a row for each recording. Texts are in quotes, and an unknown number is empty.
std::string csvOf(const Trend& trend);

/// Table with a row for each recording and a column for each joint.
Table recordingsOf(const Trend& trend);

/// Table with a row for each joint.
Table jointsOf(const Trend& trend);
}  // namespace hjt
