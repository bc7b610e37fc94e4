// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "output/report.hpp"
#include "recordings/identify.hpp"

#include "base/number_text.hpp"

namespace hjt
{
namespace
{
const std::vector<Column<IdentifiedValue>> VALUE_COLUMNS{
  { "name", &IdentifiedValue::name },      { "key", &IdentifiedValue::key },
  { "unit", &IdentifiedValue::unit },      { "configured", &IdentifiedValue::configured },
  { "value", &IdentifiedValue::value },    { "half_width", &IdentifiedValue::half_width },
  { "refusal", &IdentifiedValue::refusal }
};
const std::vector<Column<RippleLine>> LINE_COLUMNS{ { "key", &RippleLine::key },
                                                    { "order", &RippleLine::order },
                                                    { "amplitude", &RippleLine::amplitude },
                                                    { "half_width", &RippleLine::half_width },
                                                    { "phase", &RippleLine::phase },
                                                    { "refusal", &RippleLine::refusal } };

void addErrors(const std::string& key, const JudgedErrors& judged, bool shown, std::vector<ReportLine>& lines)
{
  const auto add = [&](const std::string& name, const std::string& label, const CurrentError& error)
  {
    const std::string path = key + "." + name;
    lines.insert(lines.end(), { { path + ".rows", "", error.rows },
                                { path + ".all", "", error.all },
                                { path + ".moving", "", error.moving },
                                { path + ".resting", "", error.resting },
                                { path + ".signal", "", error.signal } });
    if (shown)
    {
      lines.push_back({ "", label,
                        shortNumber(error.all) + " (moving " + shortNumber(error.moving) + ", resting " +
                            shortNumber(error.resting) + ")",
                        "A" });
    }
  };
  add("configured", "as configured", judged.configured);
  add("without_ripple", "identified, without ripple", judged.without_ripple);
  add("identified", "identified", judged.identified);
  add("gain_coulomb_viscous", "gain, Coulomb and viscous fitted alike", judged.gain_coulomb_viscous);
}

Report valuesOf(const IdentifiedJoint& joint, std::vector<std::string>& refused)
{
  const Identification& found = joint.found;
  const TelemetryParameters& telemetry = found.parameters.telemetry;
  std::vector<ReportLine> lines{ { "train", "", std::vector<double>{ joint.train.from, joint.train.to } },
                                 { "judge", "", std::vector<double>{ joint.judge.from, joint.judge.to } },
                                 { "values", "", Table(VALUE_COLUMNS, found.values).rows() },
                                 { "lines", "", Table(LINE_COLUMNS, found.lines).rows() },
                                 { "ripple_resonance", "", telemetry.ripple_resonance },
                                 { "ripple_damping", "", telemetry.ripple_damping },
                                 { "ripple_lag", "", telemetry.ripple_lag },
                                 { "ripple_fastest", "", telemetry.ripple_fastest } };
  const auto tell = [&](const std::string& name, const auto& value, double size, const std::string& unit)
  {
    if (value.refusal.empty())
    {
      lines.push_back({ "", name, shortNumber(size) + " +- " + shortNumber(value.half_width), unit });
    }
    else
    {
      refused.push_back(name + ": " + value.refusal);
    }
  };
  for (const IdentifiedValue& value : found.values)
  {
    tell(value.name, value, value.value, value.unit);
  }
  for (const RippleLine& line : found.lines)
  {
    tell("ripple, " + shortNumber(line.order) + " a turn", line, line.amplitude, "N.m");
  }
  const auto span = [&](const std::string& name, const Span& part) {
    lines.push_back({ "", name, shortNumber(part.from) + " to " + shortNumber(part.to), "s" });
  };
  span("identified on", joint.train);
  span("judged on", joint.judge);
  return { lines, {} };
}

std::vector<ReportLine> errorsOf(const IdentifiedJoint& joint)
{
  std::vector<ReportLine> errors{ { "", "the current itself, rms", joint.found.judged.identified.signal, "A" },
                                  { "", "error of the current on the judged part, rms", "" } };
  addErrors("judged", joint.found.judged, true, errors);
  const bool folded = joint.left_out.identified.rows > 0;
  if (folded)
  {
    errors.push_back({ "", "on pieces left out in turn", "" });
  }
  addErrors("left_out", joint.left_out, folded, errors);
  return errors;
}

std::vector<ReportLine> linesOf(const IdentifiedPayload& found)
{
  const auto list = [](const std::array<double, 3>& values)
  { return std::vector<double>(values.begin(), values.end()); };
  constexpr double KNOWN = 5.0;  // half width of a mass that says anything of these arms' payloads [kg]
  const std::string mass = found.mass_half_width < KNOWN ?
                               shortNumber(found.mass) + " +- " + shortNumber(found.mass_half_width) + " kg" :
                               "not known: the arm hardly moves, or is in too few poses";
  std::vector<ReportLine> lines{ { "payload.configured", "", found.configured.mass },
                                 { "payload.mass", "", found.mass },
                                 { "payload.mass_half_width", "", found.mass_half_width },
                                 { "payload.moment", "", list(found.moment) },
                                 { "payload.moment_half_width", "", list(found.moment_half_width) },
                                 { "", "payload by the currents", mass },
                                 { "", "payload configured", found.configured.mass, "kg" } };
  if (found.differs() && found.isCarried())
  {
    std::string centre;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      centre += (axis > 0 ? ", " : "") + shortNumber(found.moment[axis] / found.mass) + " +- " +
                shortNumber(found.moment_half_width[axis] / found.mass);
    }
    lines.push_back({ "", "its centre in the frame of the tip", centre, "m" });
    lines.push_back({ "", "if the arm carries it", "set payload in the arm's file, identify again" });
  }
  return lines;
}

const std::vector<Column<IdentifiedJoint>> JOINT_TABLE{
  { "joint", &IdentifiedJoint::name, "joint" },
  { "signal", [](const IdentifiedJoint& joint) { return joint.left_out.identified.signal; }, "current, rms [A]" },
  { "configured", [](const IdentifiedJoint& joint) { return joint.left_out.configured.all; }, "as configured [A]" },
  { "identified", [](const IdentifiedJoint& joint) { return joint.left_out.identified.all; }, "identified [A]" },
  { "identified_moving", [](const IdentifiedJoint& joint) { return joint.left_out.identified.moving; }, "moving [A]" },
  { "gain_coulomb_viscous", [](const IdentifiedJoint& joint) { return joint.left_out.gain_coulomb_viscous.all; },
    "gain, Coulomb, viscous [A]" },
  { "values", [](const IdentifiedJoint& joint)
    { return joint.found.values.empty() ? Json() : Table(VALUE_COLUMNS, joint.found.values).rows(); } },
  { "refusal", &IdentifiedJoint::refusal, "stays as configured" }
};
}  // namespace

IdentifyReport reportOf(const Identified& identified)
{
  IdentifyReport report;
  if (!identified.is_arm)
  {
    report.values = valuesOf(identified.joints.front(), report.refused);
    report.errors = errorsOf(identified.joints.front());
    return report;
  }
  report.values.lines = { { "rows", "rows", identified.found.rows }, { "load", "load", identified.load } };
  const std::vector<ReportLine> payload = linesOf(*identified.payload);
  report.values.lines.insert(report.values.lines.end(), payload.begin(), payload.end());
  report.values.tables = { { "joints", Table(JOINT_TABLE, identified.joints) } };
  return report;
}

Report IdentifyReport::whole() const
{
  Report report = values;
  report.lines.insert(report.lines.end(), errors.begin(), errors.end());
  return report;
}
}  // namespace hjt
