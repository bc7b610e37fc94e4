// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/indicators.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/stamp.hpp"
#include "health/signal_monitor.hpp"
#include "output/output_file.hpp"
#include "output/report.hpp"

namespace hjt
{
namespace
{
const char* stateName(AssessmentState state)
{
  constexpr std::array NAMES{ "waiting",         "learning",
                              "assessed",        "no reference",
                              "too few windows", "payload, load or gain of the current not in the reference" };
  return NAMES[static_cast<std::size_t>(state)];
}

Json toJson(const Assessment& assessment)
{
  const std::vector<Column<Evidence>> columns{ { "indicator",
                                                 [](const Evidence& item) { return indicatorName(item.indicator); } },
                                               { "value", &Evidence::value },
                                               { "expected", &Evidence::expected },
                                               { "score", &Evidence::score } };
  const std::vector<Evidence> evidence(
      assessment.evidence.begin(),
      assessment.evidence.begin() + static_cast<std::ptrdiff_t>(assessment.evidence_count));
  Json alternatives{ std::initializer_list<Json::Member>{} };
  for (std::size_t i = 0; i < assessment.alternative_count; ++i)
  {
    alternatives[causeName(assessment.alternatives[i].cause)] = assessment.alternatives[i].confidence;
  }
  return { { "state", stateName(assessment.state) },
           { "windows_here", assessment.windows_here },
           { "windows_needed", assessment.windows_needed },
           { "level", levelName(assessment.level) },
           { "cause", causeName(assessment.cause) },
           { "confidence", assessment.confidence },
           { "severity", assessment.severity },
           { "severity_deviation", assessment.severity_deviation },
           { "alternatives", alternatives },
           { "largest_score", assessment.largest_score },
           { "pattern", causeName(assessment.pattern) },
           { "evidence", Table(columns, evidence).rows() } };
}

/// Columns with the operating point of a window, for documents and CSV files.
const std::vector<Column<WindowResult>> POINT_COLUMNS{
  { "time", [](const WindowResult& window) { return toSeconds(window.indicators.stamp); } },
  { "turns", [](const WindowResult& window) { return window.indicators.turns; } },
  { "speed", [](const WindowResult& window) { return window.indicators.point.speed; } },
  { "direction", [](const WindowResult& window) { return window.indicators.point.direction; } },
  { "load", [](const WindowResult& window) { return window.indicators.point.load; } },
  { "load_constant", [](const WindowResult& window) { return window.indicators.point.load_constant; } },
  { "load_sine", [](const WindowResult& window) { return window.indicators.point.load_sine; } },
  { "load_cosine", [](const WindowResult& window) { return window.indicators.point.load_cosine; } },
  { "inertia", [](const WindowResult& window) { return window.indicators.point.inertia; } },
  { "temperature", [](const WindowResult& window) { return window.indicators.point.temperature; } }
};

/// JSON object with the result of `value` for each indicator, under the indicator's name.
template <class Value>
Json byIndicator(const Value& value)
{
  Json json;
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    json[indicatorName(i)] = value(i);
  }
  return json;
}

/// For each indicator: sound value, difference from the sound value, variance without the part from common causes, and
/// loadings on these causes (WindowResidual). Null if the assessment does not compare the indicator.
Json residualJson(const WindowResult& window)
{
  return byIndicator(
      [&](std::size_t i)
      {
        const WindowResidual& residual = window.residual;
        std::vector<double> numbers{ residual.sound[i], residual.difference[i], residual.own[i] };
        numbers.insert(numbers.end(), residual.common[i].begin(), residual.common[i].end());
        return residual.own[i] > 0.0 ? Json(numbers) : Json();
      });
}

/// The indicator with the largest score, and the difference of its mean over recent windows from its reference.
struct Strongest
{
  std::size_t indicator{};
  double score{};
  double spreads{};  // difference over the indicator's spread in the reference [-]
  double percent{};  // difference over the reference [%]; NaN if the reference is smaller than the spread
};

std::optional<Strongest> strongestOf(const WindowResult& window)
{
  const FeatureScores scores = featureScores(window.deviations);
  const FeatureScore& most = *std::max_element(scores.begin(), scores.end(),
                                               [](const FeatureScore& a, const FeatureScore& b)
                                               { return std::abs(a.score) < std::abs(b.score); });
  const Deviation& deviation = window.deviations[most.indicator];
  if (!most.compared || !(deviation.spread > 0.0))
  {
    return std::nullopt;
  }
  const double difference = window.residual.difference[most.indicator];
  const bool is_share = std::abs(deviation.expected) > deviation.spread;
  return Strongest{ most.indicator, most.score, difference / deviation.spread,
                    is_share ? 100.0 * difference / std::abs(deviation.expected) : NOT_MEASURED };
}

Json strongestJson(const WindowResult& window)
{
  const std::optional<Strongest> strongest = strongestOf(window);
  return !strongest ? Json() :
                      Json{ { "indicator", indicatorName(strongest->indicator) },
                            { "score", strongest->score },
                            { "spreads", strongest->spreads },
                            { "percent", strongest->percent } };
}

std::vector<Column<WindowResult>> documentColumns()
{
  using W = const WindowResult&;
  std::vector<Column<WindowResult>> columns = POINT_COLUMNS;
  columns.insert(columns.begin(), { { "recording", &WindowResult::recording },
                                    { "made_of", &WindowResult::origin },
                                    { "parameters", &WindowResult::parameters } });
  columns.push_back({ "indicators", [](W window)
                      { return byIndicator([&](std::size_t i) { return window.indicators.values[i]; }); } });
  columns.push_back(
      { "scores", [](W window) { return byIndicator([&](std::size_t i) { return window.deviations[i].score; }); } });
  columns.push_back({ "residual", residualJson });
  columns.push_back({ "freedom", [](const WindowResult& window) { return window.residual.freedom; } });
  columns.push_back({ "averaged", [](const WindowResult& window) { return window.residual.windows; } });
  columns.push_back({ "strongest", strongestJson });
  columns.push_back(
      { "seen_from", [](W window) { return window.seen_from ? seenFromJson(*window.seen_from) : Json(); } });
  columns.push_back({ "assessment", [](const WindowResult& window) { return toJson(window.assessment); } });
  return columns;
}

std::vector<Column<WindowResult>> fileColumns()
{
  std::vector<Column<WindowResult>> columns = POINT_COLUMNS;
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    columns.push_back({ indicatorName(i), [i](const WindowResult& window) { return window.indicators.values[i]; } });
  }
  columns.push_back({ "state", [](const WindowResult& window) { return static_cast<int>(window.assessment.state); } });
  columns.push_back({ "level", [](const WindowResult& window) { return static_cast<int>(window.assessment.level); } });
  columns.push_back({ "cause", [](const WindowResult& window) { return static_cast<int>(window.assessment.cause); } });
  columns.push_back({ "confidence", [](const WindowResult& window) { return window.assessment.confidence; } });
  columns.push_back({ "severity", [](const WindowResult& window) { return window.assessment.severity; } });
  columns.push_back(
      { "severity_deviation", [](const WindowResult& window) { return window.assessment.severity_deviation; } });
  columns.push_back({ "largest_score", [](const WindowResult& window) { return window.assessment.largest_score; } });
  return columns;
}

void printTable(const WindowResult& window)
{
  std::printf("%-32s %14s %-10s %14s %8s\n", "indicator", "value", "unit", "healthy", "score");
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    const double value = window.indicators.values[i];
    const Deviation& deviation = window.deviations[i];
    if (!std::isfinite(value))
    {
      continue;
    }
    std::printf("%-32s %14s %-10s", indicatorName(i), shortNumber(value).c_str(), indicatorUnit(i));
    if (std::isfinite(deviation.score))
    {
      std::printf(" %14s %8s", shortNumber(deviation.expected).c_str(), fixedText(deviation.score, 2).c_str());
    }
    std::printf("\n");
  }
}

}  // namespace

Json seenFromJson(const SeenFrom& seen_from)
{
  Json json;
  for (std::size_t cause = 0; cause < CAUSE_COUNT; ++cause)
  {
    if (!std::isnan(seen_from[cause]))
    {
      json[causeName(static_cast<Cause>(cause))] = std::isfinite(seen_from[cause]) ? Json(seen_from[cause]) : Json();
    }
  }
  return json;
}

void writeWindows(const std::string& path, const std::vector<WindowResult>& windows)
{
  writeTable(path, fileColumns(), windows);
}

Report reportOf(const AssessedWindows& found)
{
  static const std::vector<Column<UnreadRecording>> UNREAD{ { "recording", &UnreadRecording::recording },
                                                            { "why", &UnreadRecording::why } };
  return { { { "threshold", "", found.threshold },
             { "windows", "", Table(documentColumns(), found.windows).rows() },
             { "assessment", "", toJson(found.windows.back().assessment) },
             { "unread", "", Table(UNREAD, found.unread).rows() } },
           {} };
}

/// A probability or severity, rounded to hundredths. Further digits would change with the last count of an encoder.
double hundredths(double value)
{
  return std::round(100.0 * value) / 100.0;
}

void printSummary(const std::vector<WindowResult>& windows)
{
  const WindowResult& last = windows.back();
  printTable(last);
  const Assessment& assessment = last.assessment;
  const bool judged = assessment.state == AssessmentState::ASSESSED;
  std::vector<ReportLine> lines{ { "", "windows", windows.size() },
                                 { "", "turns in the last window", last.indicators.turns },
                                 { "", "motor speed in the last window", last.indicators.point.speed, "rad/s" },
                                 { "", "made of", last.origin },
                                 { "", "source of the parameters", last.parameters },
                                 { "", "state", stateName(assessment.state) },
                                 { "", "level", judged ? levelName(assessment.level) : "not judged" } };
  if (const std::optional<Strongest> strongest = strongestOf(last))
  {
    lines.push_back({ "", "largest score over threshold", assessment.largest_score });
    if (assessment.pattern != Cause::NONE)
    {
      lines.push_back({ "", "pattern of this score", causeName(assessment.pattern) });
    }
    lines.push_back(
        { "", assessment.pattern == Cause::NONE ? "that of" : "furthest off", indicatorName(strongest->indicator) });
    lines.push_back({ "", "its deviation", strongest->spreads, "spreads" });
    if (std::isfinite(strongest->percent))
    {
      lines.push_back({ "", "of its reference", strongest->percent, "%" });
    }
  }
  if (assessment.level != HealthLevel::OK)
  {
    lines.push_back({ "", "most likely cause", causeName(assessment.cause) });
    lines.push_back({ "", "confidence", hundredths(assessment.confidence) });
    lines.push_back({ "", "severity", hundredths(assessment.severity) });
    lines.push_back({ "", "its standard deviation", hundredths(assessment.severity_deviation) });
    for (std::size_t i = 0; i < assessment.alternative_count; ++i)
    {
      const Alternative& other = assessment.alternatives[i];
      lines.push_back({ "", std::string("or ") + causeName(other.cause), hundredths(other.confidence) });
    }
  }
  for (std::size_t cause = 0; last.seen_from && cause < CAUSE_COUNT; ++cause)
  {
    const double severity = (*last.seen_from)[cause];
    const std::string name = causeName(static_cast<Cause>(cause));
    if (!std::isnan(severity))
    {
      lines.push_back(std::isfinite(severity) ? ReportLine{ "", name + " would show from", severity } :
                                                ReportLine{ "", name, "would not show" });
    }
  }
  printReport(false, lines);
  if (!judged)
  {
    std::printf("not judged: %s\n", whyNotJudged(assessment).c_str());
  }
}
}  // namespace hjt
