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
  std::string out;                      ///< CSV file with a row for each recording; empty: none
};

void addOptions(OptionTable& table, TrendOptions& options);

/// A recording and what `compare` makes of it.
struct DatedRecording
{
  std::string path;
  std::optional<Stamp> date;         ///< of its first row [ns since 1970]; none: its stamps are no calendar's
  double time{};                     ///< hours since the first recording; without dates its place in the order
  std::vector<std::string> remarks;  ///< remarks of the reader
  std::string unread;                ///< why it was not compared; empty: it was
  ComparedRecording compared;        ///< without documents; no joints: it was not
  /// Of each joint, for its trend: friction apart from what the joints of its group have in common, which is taken
  /// alike of all recordings; none: not known.
  std::vector<std::optional<DatedFriction>> frictions;

  bool isRead() const { return !compared.joints.empty(); }
  const char* level() const { return isRead() ? compared.level.c_str() : levelName(VerdictLevel::NOT_JUDGED); }
  const std::string& text() const { return isRead() ? compared.text : unread; }
};

/// A joint over all recordings.
struct JointTrend
{
  std::string name;  ///< short
  FrictionTrend friction;
  VerdictLevel level{ VerdictLevel::NOT_JUDGED };
  std::string text;  ///< a sentence
};

struct Trend
{
  bool is_arm{};
  bool has_dates{};                        ///< all recordings have one; else their order stands for time
  std::vector<DatedRecording> recordings;  ///< by date; those that were not read last. None: stopped
  std::vector<JointTrend> joints;          ///< from the base on
  std::optional<std::size_t> latest;       ///< of the recordings, the last one that was judged
  std::string level;
  std::string text;          ///< a sentence or two
  HealthLevel health{};      ///< the worse of the trends and the latest recording
  bool is_judged{};          ///< a trend, or the latest recording
  std::size_t not_judged{};  ///< joints of which neither is judged
  std::string page;          ///< its path; empty: none
};

/// Judges each recording as `compare` does, and whether the friction of a joint changes from one to the other.
///
/// Of a folder the files that are named .bag, .db3, .mcap, .csv or .active count, and the directories of ROS 2; its
/// other folders do not. A recording that cannot be read is kept with the reason.
/// @throws ParameterError, InputError: no recording can be read, a file that cannot be written.
Trend trend(const TrendOptions& options);

/// "2026-01-31 08:15" or "2026-01-31T08:15:00Z", UTC.
std::string dateText(Stamp date);
std::string isoDate(Stamp date);

constexpr const char* TREND_FILE = "trend.json";

/// By which a slope is multiplied for people: 1000 h, or without dates from one recording to the next.
double trendUnit(const Trend& trend);
const char* trendUnitText(const Trend& trend);  ///< "per 1000 h"

Json documentOf(const Trend& trend);

/// A row for each recording, texts in quotes, nothing where a number is not known.
std::string csvOf(const Trend& trend);

/// A row for each recording, a column for each joint.
Table recordingsOf(const Trend& trend);

/// A row for each joint.
Table jointsOf(const Trend& trend);
}  // namespace hjt
