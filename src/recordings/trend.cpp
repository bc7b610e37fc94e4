// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/trend.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include "output/output_file.hpp"
#include "recordings/compare.hpp"

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

/// A stamp before this one, the year 2000, is not a date, but a time since the start of a program [ns].
constexpr Stamp FIRST_DATE = 946'684'800'000'000'000;
/// Changes of friction within this time come from the drives' temperature and are not a trend [h].
constexpr double DAY = 24.0;
constexpr double PER_CENT = 100.0;

bool isRos2Directory(const fs::path& path)
{
  return fs::is_directory(path) && fs::exists(path / "metadata.yaml");
}

bool isNamedRecording(const fs::path& path)
{
  static const std::set<std::string> ENDINGS{ ".bag", ".active", ".db3", ".mcap", ".csv" };
  return fs::is_directory(path) ? isRos2Directory(path) : ENDINGS.count(path.extension().string()) > 0;
}

std::vector<std::string> recordingsIn(const std::string& folder)
{
  std::vector<std::string> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
  {
    if (isNamedRecording(entry.path()))
    {
      found.push_back(entry.path().string());
    }
  }
  std::sort(found.begin(), found.end());
  if (found.empty())
  {
    throw InputError(folder +
                     " holds no recordings (.bag, .db3, .mcap, .csv, directories of ROS 2); folders in it are "
                     "not searched");
  }
  return found;
}

/// The files in the given order, each only once.
std::vector<std::string> filesOf(const std::vector<std::string>& given)
{
  std::vector<std::string> files;
  std::set<std::string> known;
  for (const std::string& path : given)
  {
    if (!fs::exists(path))
    {
      throw InputError(path + " does not exist");
    }
    const bool is_folder = fs::is_directory(path) && !isRos2Directory(path);
    for (const std::string& file : is_folder ? recordingsIn(path) : std::vector<std::string>{ path })
    {
      std::error_code error;
      const std::string there = fs::canonical(file, error).string();
      if (known.insert(error ? file : there).second)  // a broken link is kept, to be listed as not readable
      {
        files.push_back(file);
      }
    }
  }
  return files;
}

/// Compares one recording with the twin. `progress` is called with the read share of the recording, 0 to 1.
DatedRecording readRecording(const ComparisonOptions& all, const std::string& path,
                             const std::function<void(double)>& progress)
{
  DatedRecording recording;
  recording.path = path;
  ComparisonOptions options = all;
  options.recording = path;
  options.report.clear();
  options.beside_controller = false;  // so that all recordings have the same reference
  options.watch.progress = [&progress](const std::string&) { return progress; };
  options.watch.notice = [&recording](const std::string& text) { recording.remarks.push_back(text); };
  try
  {
    recording.compared = compare(options);
    recording.compared.document = {};
    for (ComparedJoint& joint : recording.compared.joints)
    {
      joint.document = {};
    }
    if (recording.compared.found.start >= FIRST_DATE)
    {
      recording.date = recording.compared.found.start;
    }
  }
  catch (const ParameterError&)
  {
    throw;
  }
  catch (const InputError& error)
  {
    recording.unread = error.what();
  }
  return recording;
}

/// Sorts the recordings by date if every readable recording has a date, and sets their times.
void putInOrder(Trend& trend)
{
  std::vector<DatedRecording>& recordings = trend.recordings;
  trend.has_dates = std::all_of(recordings.begin(), recordings.end(),
                                [](const DatedRecording& one) { return one.date || !one.isRead(); });
  if (trend.has_dates)
  {
    std::stable_sort(recordings.begin(), recordings.end(),
                     [](const DatedRecording& a, const DatedRecording& b)
                     { return a.date && (!b.date || *a.date < *b.date); });
  }
  constexpr double SECONDS = 3600.0;
  for (std::size_t i = 0; i < recordings.size(); ++i)
  {
    const bool is_dated = trend.has_dates && recordings[i].date;
    recordings[i].time =
        is_dated ? toSeconds(*recordings[i].date - *recordings.front().date) / SECONDS : static_cast<double>(i);
  }
}

std::string perCent(double share)
{
  return fixedText(PER_CENT * share, 1);
}

/// Text on a change of friction, for example "1.31 [1.17, 1.46] times from 2026-01-03 to 2026-09-30, 4.8 % [2.9, 6.7]
/// per 1000 h, by 10 recordings."
std::string changeText(const FrictionTrend& friction, const Trend& trend, const std::vector<Stamp>& dates)
{
  const double unit = trendUnit(trend);
  return fixedText(friction.change(), 2) + " [" + fixedText(friction.changeLow(), 2) + ", " +
         fixedText(friction.changeHigh(), 2) + "] times " +
         (trend.has_dates ? "from " + dateText(dates.front()) + " to " + dateText(dates.back()) :
                            std::string("from the first to the last recording")) +
         ", " + perCent(unit * friction.slope) + " % [" + perCent(unit * friction.slopeLow()) + ", " +
         perCent(unit * friction.slopeHigh()) + "] " + trendUnitText(trend) + ", by " +
         std::to_string(friction.recordings) + " recordings.";
}

/// Logarithm of a joint's friction, including the common factor of the arm's joints; none if not judged.
std::optional<double> logarithmOf(const DatedRecording& recording, std::size_t joint)
{
  if (!recording.isRead() || !recording.compared.joints[joint].friction)
  {
    return std::nullopt;
  }
  const double in_common = recording.compared.friction.factors[joint];
  const double factor = in_common * recording.compared.joints[joint].verdict.friction.factor;
  return factor > 0.0 ? std::make_optional(std::log(factor)) : std::nullopt;
}

/// Sets the frictions of the joints `begin` to `end` - 1, which are a group, in all recordings.
void dateFrictions(std::vector<DatedRecording>& recordings, std::size_t begin, std::size_t end)
{
  std::vector<std::vector<std::optional<double>>> logarithms(end - begin);
  for (std::size_t joint = begin; joint < end; ++joint)
  {
    for (const DatedRecording& recording : recordings)
    {
      logarithms[joint - begin].push_back(logarithmOf(recording, joint));
    }
  }
  const std::vector<std::optional<double>> common = commonOfRecordings(logarithms);
  for (std::size_t k = 0; k < recordings.size(); ++k)
  {
    for (std::size_t joint = begin; joint < end; ++joint)
    {
      DatedRecording& recording = recordings[k];
      recording.frictions.emplace_back();
      if (const std::optional<double>& logarithm = logarithms[joint - begin][k])
      {
        const double in_common = common[k].value_or(0.0);
        const double slow = common[k] ? 0.0 : recording.compared.friction.deviations[joint];
        recording.frictions.back() = { recording.time, std::exp(*logarithm - in_common),
                                       recording.compared.joints[joint].friction->deviation, slow, in_common };
      }
    }
  }
}

JointTrend judgeJoint(const Trend& trend, std::size_t joint, const std::string& name)
{
  std::vector<DatedFriction> frictions;
  std::vector<Stamp> dates;
  for (const DatedRecording& recording : trend.recordings)
  {
    if (recording.frictions[joint])
    {
      frictions.push_back(*recording.frictions[joint]);
      dates.push_back(recording.date.value_or(0));
    }
  }
  JointTrend judged;
  judged.name = name;
  judged.friction = frictionTrend(frictions);
  const FrictionTrend& friction = judged.friction;
  if (friction.recordings < FrictionTrend::MIN_RECORDINGS)
  {
    judged.text = std::to_string(friction.recordings) +
                  (friction.recordings == 1 ? " recording shows its friction, " : " recordings show its friction, ") +
                  std::to_string(FrictionTrend::MIN_RECORDINGS) + " are needed.";
  }
  else if (trend.has_dates && friction.span < DAY)
  {
    judged.friction.slope = std::nan("");
    judged.text = "All recordings that show its friction are within " + fixedText(friction.span, 1) +
                  " h. Within a day, friction changes with the temperature, so a trend needs a longer time.";
  }
  else
  {
    judged.level = friction.departs() ? VerdictLevel::WARN : VerdictLevel::OK;
    judged.text = std::string("Friction ") +
                  (!friction.departs()     ? "does not change: " :
                   friction.change() > 1.0 ? "rises: " :
                                             "falls: ") +
                  changeText(friction, trend, dates);
  }
  return judged;
}

/// Text of the trends: joints that change, joints without a trend, and the latest recording if it is not OK.
std::string textOf(const Trend& trend)
{
  std::string text;
  std::vector<std::pair<std::string, std::vector<std::string>>> unjudged;  // reason, and joints with this reason
  bool is_any = false;
  bool departs = false;
  for (const JointTrend& joint : trend.joints)
  {
    is_any = is_any || joint.level != VerdictLevel::NOT_JUDGED;
    if (joint.level == VerdictLevel::WARN)
    {
      departs = true;
      text += joint.name + ": " + joint.text + " ";
    }
    if (joint.level == VerdictLevel::NOT_JUDGED)
    {
      const auto same =
          std::find_if(unjudged.begin(), unjudged.end(), [&](const auto& one) { return one.first == joint.text; });
      (same == unjudged.end() ? unjudged.emplace_back(joint.text, std::vector<std::string>()) : *same)
          .second.push_back(joint.name);
    }
  }
  text += is_any && !departs ? "The friction of no joint changes more than that of a sound joint. " : "";
  for (const auto& [why, joints] : unjudged)
  {
    text += "No trend of " + joined(joints) + ": " + why + " ";
  }
  if (!trend.has_dates)
  {
    text += "Not all recordings have a date, so their order stands for time. ";
  }
  if (trend.latest && (!is_any || trend.recordings[*trend.latest].compared.health != HealthLevel::OK))
  {
    const DatedRecording& latest = trend.recordings[*trend.latest];
    text += "The latest, " + fs::path(latest.path).filename().string() + ": " + latest.compared.text + " ";
  }
  text.pop_back();
  return text;
}

void judgeTrend(Trend& trend)
{
  const auto first = std::find_if(trend.recordings.begin(), trend.recordings.end(),
                                  [](const DatedRecording& recording) { return recording.isRead(); });
  trend.is_arm = first->compared.is_arm;
  const std::size_t joints = first->compared.joints.size();
  dateFrictions(trend.recordings, 0, jointsToElbow(joints));
  dateFrictions(trend.recordings, jointsToElbow(joints), joints);
  for (std::size_t i = 0; i < joints; ++i)
  {
    trend.joints.push_back(judgeJoint(trend, i, first->compared.joints[i].name));
    trend.health = std::max(trend.health, severityOf(trend.joints.back().level));
    trend.is_judged = trend.is_judged || trend.joints.back().level != VerdictLevel::NOT_JUDGED;
  }
  for (std::size_t i = 0; i < trend.recordings.size(); ++i)
  {
    if (trend.recordings[i].compared.is_judged)
    {
      trend.latest = i;
    }
  }
  for (std::size_t i = 0; i < joints; ++i)
  {
    const bool is_latest_judged = trend.latest && trend.recordings[*trend.latest].compared.joints[i].verdict.isJudged();
    trend.not_judged += is_latest_judged || trend.joints[i].level != VerdictLevel::NOT_JUDGED ? 0 : 1;
  }
  if (trend.latest)
  {
    trend.health = std::max(trend.health, trend.recordings[*trend.latest].compared.health);
    trend.is_judged = true;
  }
  trend.level =
      trend.is_judged ? levelName(static_cast<VerdictLevel>(trend.health)) : levelName(VerdictLevel::NOT_JUDGED);
  trend.text = textOf(trend);
}

/// @throws InputError if a file that the options name cannot be written.
void requireFiles(const TrendOptions& options)
{
  requireWritable(options.out, options.force);
  if (options.report.empty())
  {
    return;
  }
  prepareReport(options.report, TREND_FILE, options.force);
}
}  // namespace

void addOptions(OptionTable& table, TrendOptions& options)
{
  table
      .add("recordings", options.recordings,
           "recordings, as for `compare`, or folders of recordings, of one joint or arm over months")
      .required()
      .type("IN|DIR");
  addJointOptions(table, options);
  table.add("--out", options.out, "CSV with a row for each recording").type("FILE.csv");
  table.add("--report", options.report, "directory for a page with the figure, and for its data").type("DIR");
  addReferenceOption(table, options);
}

Trend trend(const TrendOptions& options)
{
  requireFiles(options);
  const std::vector<std::string> files = filesOf(options.recordings);
  if (files.empty())
  {
    throw InputError("recordings: at least one is required");
  }
  const std::function<void(double)> show = options.watch.progress("recordings");
  Trend trend;
  for (const std::string& file : files)
  {
    const auto done = static_cast<double>(trend.recordings.size());
    trend.recordings.push_back(
        readRecording(options, file, [&](double share) { show((done + share) / static_cast<double>(files.size())); }));
    if (options.watch.stopped())
    {
      return {};
    }
  }
  if (std::none_of(trend.recordings.begin(), trend.recordings.end(),
                   [](const DatedRecording& recording) { return recording.isRead(); }))
  {
    const std::string& why = trend.recordings.front().unread;
    throw InputError(files.size() == 1 ? why :
                                         "none of " + std::to_string(files.size()) + " recordings can be read: " + why);
  }
  putInOrder(trend);
  judgeTrend(trend);
  if (!options.out.empty())
  {
    writeTextFile(options.out, csvOf(trend));
  }
  if (!options.report.empty())
  {
    writeTextFile((fs::path(options.report) / TREND_FILE).string(), documentOf(trend).dump() + "\n");
    trend.page = (fs::path(options.report) / REPORT_PAGE).string();
    makePage(options.report);
  }
  return trend;
}
}  // namespace hjt
