// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/trend.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/number_text.hpp"
#include "messages/time.hpp"

namespace hjt
{
namespace
{
std::optional<std::string> dateOf(const DatedRecording& recording)
{
  return recording.date ? std::make_optional(isoDate(*recording.date)) : std::nullopt;
}

/// Reason for the finding on the joint's friction.
Reason reasonOf(const ComparedJoint& joint)
{
  return joint.verdict.findings.front().reason;
}

/// Function that gets `value` of a joint from a recording, or null if the recording was not read.
template <class Value>
std::function<Json(const DatedRecording&)> ofJoint(std::size_t joint, const Value& value)
{
  return [joint, value](const DatedRecording& recording)
  { return recording.isRead() ? Json(value(recording.compared.joints[joint])) : Json(); };
}

std::optional<double> ofFriction(const ComparedJoint& joint, double JudgedFriction::*field)
{
  return joint.friction ? std::make_optional(joint.verdict.friction.*field) : std::nullopt;
}

/// Text of a table cell: "1.02 [0.92, 1.13]" with the level if it is not OK, or why the friction is not judged.
std::string cellOf(const ComparedJoint& joint)
{
  if (!joint.friction)
  {
    return reasonName(reasonOf(joint));
  }
  const JudgedFriction& friction = joint.verdict.friction;
  const std::string level = severityOf(joint.verdict.level) == HealthLevel::OK ?
                                std::string() :
                                std::string(" ") + levelName(joint.verdict.level);
  return fixedText(friction.factor, 2) + " [" + fixedText(friction.lower, 2) + ", " + fixedText(friction.upper, 2) +
         "]" + level;
}

bool hasTemperature(const ComparedJoint& joint)
{
  return std::string(joint.temperature_source) == "received";
}

/// Range of the joints' recorded temperatures [degC], for example "24 to 31"; "-" if no temperature was recorded.
std::string temperaturesOf(const DatedRecording& recording)
{
  double least = HUGE_VAL;
  double most = -HUGE_VAL;
  for (const ComparedJoint& joint : recording.compared.joints)
  {
    if (hasTemperature(joint))
    {
      least = std::min(least, joint.temperature);
      most = std::max(most, joint.temperature);
    }
  }
  const std::string low = least <= most ? fixedText(least, 0) : "-";
  const std::string high = least <= most ? fixedText(most, 0) : "-";
  return low == high ? low : low + " to " + high;
}

/// Columns for the fields of one joint. Each key begins with `before`.
std::vector<Column<DatedRecording>> fieldsOf(std::size_t i, const std::string& before)
{
  const auto of_verdict = [](double JudgedFriction::*field)
  { return [field](const ComparedJoint& joint) { return ofFriction(joint, field); }; };
  return { { before + "friction", ofJoint(i, of_verdict(&JudgedFriction::factor)) },
           { before + "friction_low", ofJoint(i, of_verdict(&JudgedFriction::lower)) },
           { before + "friction_high", ofJoint(i, of_verdict(&JudgedFriction::upper)) },
           { before + "friction_for_trend",
             [i](const DatedRecording& recording)
             {
               const std::optional<DatedFriction>& friction = recording.frictions[i];
               return friction ? std::make_optional(friction->factor) : std::nullopt;
             } },
           { before + "level", ofJoint(i, [](const ComparedJoint& joint) { return levelName(joint.verdict.level); }) },
           { before + "reason", ofJoint(i, [](const ComparedJoint& joint) { return reasonName(reasonOf(joint)); }) },
           { before + "temperature", ofJoint(i, [](const ComparedJoint& joint) { return joint.temperature; }) },
           { before + "temperature_source",
             ofJoint(i, [](const ComparedJoint& joint) { return joint.temperature_source; }) } };
}

/// Columns for the values of a whole recording, apart from those of its joints.
std::vector<Column<DatedRecording>> wholeFields()
{
  return { { "recording", &DatedRecording::path },
           { "date", dateOf },
           { "level", [](const DatedRecording& recording) { return recording.level(); } },
           { "friction_in_common", [](const DatedRecording& recording)
             { return recording.isRead() ? std::make_optional(recording.compared.friction.median) : std::nullopt; } },
           { "temperature_estimate",
             [](const DatedRecording& recording) { return recording.compared.friction.temperature; } } };
}

/// Converts a value to the text of a cell in a CSV file.
struct CellText
{
  std::string operator()(std::nullptr_t) const { return {}; }
  std::string operator()(bool value) const { return value ? "1" : "0"; }
  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(double value) const { return std::isfinite(value) ? numberText(value) : std::string(); }
  std::string operator()(std::string text) const
  {
    for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2)
    {
      text.insert(at, 1, '"');
    }
    return '"' + text + '"';
  }
  template <class Other>
  std::string operator()(const Other& /*list*/) const
  {
    return {};
  }
};
}  // namespace

std::string dateText(Stamp date)
{
  return dateText(date, "%Y-%m-%d %H:%M");
}

std::string isoDate(Stamp date)
{
  return dateText(date, "%Y-%m-%dT%H:%M:%SZ");
}

double trendUnit(const Trend& trend)
{
  return trend.has_dates ? 1000.0 : 1.0;
}

const char* trendUnitText(const Trend& trend)
{
  return trend.has_dates ? "per 1000 h" : "from one recording to the next";
}

Json documentOf(const Trend& trend)
{
  const double unit = trendUnit(trend);
  const auto if_known = [](double value) { return std::isfinite(value) ? std::make_optional(value) : std::nullopt; };
  const std::vector<Column<JointTrend>> joints{
    { "joint", &JointTrend::name },
    { "level", [](const JointTrend& joint) { return levelName(joint.level); } },
    { "text", &JointTrend::text },
    { "recordings", [](const JointTrend& joint) { return joint.friction.recordings; } },
    { "change", [&](const JointTrend& joint) { return if_known(joint.friction.change()); } },
    { "change_low", [&](const JointTrend& joint) { return if_known(joint.friction.changeLow()); } },
    { "change_high", [&](const JointTrend& joint) { return if_known(joint.friction.changeHigh()); } },
    { "slope", [&](const JointTrend& joint) { return if_known(unit * joint.friction.slope); } },
    { "slope_low", [&](const JointTrend& joint) { return if_known(unit * joint.friction.slopeLow()); } },
    { "slope_high", [&](const JointTrend& joint) { return if_known(unit * joint.friction.slopeHigh()); } }
  };
  std::vector<Column<DatedRecording>> rows = wholeFields();
  rows.push_back({ "text", [](const DatedRecording& recording) { return recording.text(); } });
  rows.push_back({ "remarks", &DatedRecording::remarks });
  rows.push_back({ "joints", [&](const DatedRecording& recording)
                   {
                     std::vector<Json> found;
                     for (std::size_t i = 0; i < recording.compared.joints.size(); ++i)
                     {
                       Json one{ { "joint", recording.compared.joints[i].name } };
                       for (const Column<DatedRecording>& field : fieldsOf(i, ""))
                       {
                         one[field.key] = field.value(recording);
                       }
                       found.push_back(one);
                     }
                     return found;
                   } });
  return { { "level", trend.level },
           { "text", trend.text },
           { "has_dates", trend.has_dates },
           { "slope_unit", trendUnitText(trend) },
           { "joints", Table(joints, trend.joints).rows() },
           { "recordings", Table(rows, trend.recordings).rows() } };
}

std::string csvOf(const Trend& trend)
{
  std::vector<Column<DatedRecording>> columns = wholeFields();
  for (std::size_t i = 0; i < trend.joints.size(); ++i)
  {
    for (const Column<DatedRecording>& field : fieldsOf(i, trend.joints[i].name + "_"))
    {
      columns.push_back(field);
    }
  }
  columns.push_back({ "text", [](const DatedRecording& recording) { return recording.text(); } });
  std::string text;
  for (const Column<DatedRecording>& column : columns)
  {
    text += (text.empty() ? "" : ",") + column.key;
  }
  for (const DatedRecording& recording : trend.recordings)
  {
    const char* before = "\n";
    for (const Column<DatedRecording>& column : columns)
    {
      text += before + column.value(recording).visit(CellText());
      before = ",";
    }
  }
  return text + "\n";
}

Table recordingsOf(const Trend& trend)
{
  std::vector<Column<DatedRecording>> columns;
  const auto add = [&](const char* heading, const std::function<std::string(const DatedRecording&)>& text)
  {
    if (std::any_of(trend.recordings.begin(), trend.recordings.end(),
                    [&](const DatedRecording& recording) { return text(recording) != "-"; }))
    {
      columns.push_back({ "", text, heading });
    }
  };
  add("date [UTC]",
      [](const DatedRecording& recording) { return recording.date ? dateText(*recording.date) : std::string("-"); });
  add("at [degC]", temperaturesOf);
  if (trend.is_arm)
  {
    columns.push_back({ "",
                        [](const DatedRecording& recording)
                        { return recording.isRead() ? fixedText(recording.compared.friction.median, 2) : "-"; },
                        "in common" });
  }
  for (std::size_t i = 0; i < trend.joints.size(); ++i)
  {
    columns.push_back({ "",
                        [i](const DatedRecording& recording)
                        { return recording.isRead() ? cellOf(recording.compared.joints[i]) : std::string("-"); },
                        trend.joints[i].name });
  }
  columns.push_back({ "", [](const DatedRecording& recording) { return recording.level(); }, "verdict" });
  columns.push_back(
      { "", [](const DatedRecording& recording) { return std::filesystem::path(recording.path).filename().string(); },
        "recording" });
  return { columns, trend.recordings };
}

Table jointsOf(const Trend& trend)
{
  constexpr double PER_CENT = 100.0;
  const auto interval = [](const JointTrend& joint, double value, double low, double high, int digits)
  {
    return joint.level == VerdictLevel::NOT_JUDGED ?
               std::string("-") :
               fixedText(value, digits) + " [" + fixedText(low, digits) + ", " + fixedText(high, digits) + "]";
  };
  const double unit = PER_CENT * trendUnit(trend);
  const std::vector<Column<JointTrend>> columns{
    { "", &JointTrend::name, "joint" },
    { "", [](const JointTrend& joint) { return joint.friction.recordings; }, "recordings" },
    { "",
      [&](const JointTrend& joint)
      {
        const FrictionTrend& friction = joint.friction;
        return interval(joint, friction.change(), friction.changeLow(), friction.changeHigh(), 2);
      },
      "change, times [95 %]" },
    { "",
      [&](const JointTrend& joint)
      {
        const FrictionTrend& friction = joint.friction;
        return interval(joint, unit * friction.slope, unit * friction.slopeLow(), unit * friction.slopeHigh(), 1);
      },
      trend.has_dates ? "% per 1000 h [95 %]" : "% to the next [95 %]" },
    { "", [](const JointTrend& joint) { return levelName(joint.level); }, "trend" }
  };
  return { columns, trend.joints };
}
}  // namespace hjt
