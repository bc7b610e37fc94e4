// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/run_duty.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include "base/csv_table.hpp"

#include "base/number_text.hpp"

namespace hjt
{
namespace
{
constexpr Range LARGE{ -1e6, 1e6 };  // allowed values of a waveform, in its unit
constexpr double BANDWIDTH = 8.0;    // default bandwidth of the speed control [Hz]

/// Unit of the values of this key in a duty cycle.
const char* unitOf(const std::string& key)
{
  return key == "speed" ? "rad/s" : key == "temperature" ? "degC" : "N.m";
}

std::shared_ptr<const Waveform> trapezoid(const PlanNode& shape, const char* unit, const PlanValues& values)
{
  allowOnly(shape, { "peak", "slope", "hold", "pause" });
  const double peak = values.number(shape, "peak", unit, LARGE);
  const double slope = values.number(shape, "slope", (std::string(unit) + "/s").c_str(), { 1e-6, 1e9 });
  const double hold = values.number(shape, "hold", "s", { 0.0, 1e6 }, 0.0);
  const double pause = values.number(shape, "pause", "s", { 0.0, 1e6 }, 0.0);
  const TrapezoidWaveform wave(peak, slope, hold, pause);
  if (peak != 0.0 && wave.halfPeriod() < TrapezoidWaveform::SHORTEST)
  {
    shape.refuse("has a half period, 2 peak / slope + hold + pause, of " + numberText(wave.halfPeriod()) +
                 " [s], allowed: >= " + numberText(TrapezoidWaveform::SHORTEST) + " [s]");
  }
  return std::make_shared<TrapezoidWaveform>(wave);
}
}  // namespace

SinusWaveform::SinusWaveform(double mean, double amplitude, double frequency, double phase)
  : mean_(mean), amplitude_(amplitude), angular_frequency_(TWO_PI * frequency), phase_(phase)
{
}

double SinusWaveform::value(double time) const
{
  return mean_ + amplitude_ * std::sin(angular_frequency_ * time + phase_);
}

double SinusWaveform::slope(double time) const
{
  return amplitude_ * angular_frequency_ * std::cos(angular_frequency_ * time + phase_);
}

TrapezoidWaveform::TrapezoidWaveform(double peak, double slope, double hold, double pause)
  : peak_(peak), slope_(slope), rise_(std::abs(peak) / slope), hold_(hold), half_period_(2.0 * rise_ + hold + pause)
{
}

TrapezoidWaveform::Place TrapezoidWaveform::place(double time) const
{
  if (half_period_ < SHORTEST)
  {
    return { 1.0, 0.0 };
  }
  const double halves = std::floor(time / half_period_);
  const bool forth = (std::fmod(halves, 2.0) == 0.0) == (peak_ >= 0.0);
  return { forth ? 1.0 : -1.0, time - halves * half_period_ };
}

double TrapezoidWaveform::value(double time) const
{
  const Place at = place(time);
  const double falling = 2.0 * rise_ + hold_ - at.time;
  return at.sign * std::clamp(slope_ * std::min(at.time, falling), 0.0, std::abs(peak_));
}

double TrapezoidWaveform::slope(double time) const
{
  const Place at = place(time);
  if (at.time < rise_)
  {
    return at.sign * slope_;
  }
  return at.time >= rise_ + hold_ && at.time < 2.0 * rise_ + hold_ ? -at.sign * slope_ : 0.0;
}

std::shared_ptr<const TableWaveform::Rows> TableWaveform::read(const std::string& path, const std::string& column,
                                                               const Range& range, const std::string& unit)
{
  NumberTable<2> table(path, { "time", column });
  auto rows = std::make_shared<Rows>();
  for (std::array<double, 2> row{}; table.read(row);)
  {
    if (row[0] < 0.0 || (!rows->empty() && row[0] <= rows->back().first))
    {
      throw InputError(table.place() + ": column 'time' must be >= 0 and ascending");
    }
    table.requireRange(1, row[1], range, unit);
    if (!rows->empty() && !std::isfinite((row[1] - rows->back().second) / (row[0] - rows->back().first)))
    {
      throw InputError(table.place() + ": column '" + column + "' must be finite and change at a finite rate");
    }
    rows->emplace_back(row[0], row[1]);
  }
  if (rows->empty())
  {
    throw InputError(path + " has no rows");
  }
  return rows;
}

Range TableWaveform::range() const
{
  const auto [least, most] = std::minmax_element(rows_->begin(), rows_->end(),
                                                 [](const auto& a, const auto& b) { return a.second < b.second; });
  return { least->second, most->second };
}

std::size_t TableWaveform::rowAfter(double time) const
{
  return static_cast<std::size_t>(
      std::upper_bound(rows_->begin(), rows_->end(), time, [](double t, const auto& row) { return t < row.first; }) -
      rows_->begin());
}

double TableWaveform::value(double time) const
{
  const std::size_t after = rowAfter(time);
  if (after == 0 || after == rows_->size())
  {
    return after == 0 ? rows_->front().second : rows_->back().second;
  }
  return (*rows_)[after - 1].second + slope(time) * (time - (*rows_)[after - 1].first);
}

double TableWaveform::slope(double time) const
{
  const std::size_t after = rowAfter(time);
  if (after == 0 || after == rows_->size())
  {
    return 0.0;
  }
  const auto& [t0, v0] = (*rows_)[after - 1];
  const auto& [t1, v1] = (*rows_)[after];
  return (v1 - v0) / (t1 - t0);
}

void DutyReader::readTables(const PlanNode& duties, const std::string& directory)
{
  for (const auto& [number, duty] : duties.entries)
  {
    for (const auto& [key, shape] : duty.entries)
    {
      const PlanNode* csv = shape.find("csv");
      if (csv == nullptr)
      {
        continue;
      }
      allowOnly(*csv, { "file", "column" });
      for (const std::string& file : textsOf(*csv, "file"))
      {
        for (const std::string& column : textsOf(*csv, "column"))
        {
          const std::string path = (std::filesystem::path(directory) / file).string();
          tables_[{ file, column }] = TableWaveform::read(path, column, LARGE, unitOf(key));
        }
      }
    }
  }
}

RunDuty DutyReader::read(const PlanNode& duty, const PlanValues& values) const
{
  allowOnly(duty, { "name", "torque", "speed", "bandwidth", "load", "temperature" });
  RunDuty cycle;
  const bool torque = duty.find("torque") != nullptr;
  if (torque == (duty.find("speed") != nullptr))
  {
    duty.refuse("must have either torque or speed");
  }
  if (torque)
  {
    cycle.torque = waveform(duty, "torque", values);
  }
  else
  {
    cycle.speed = waveform(duty, "speed", values);
    cycle.bandwidth = values.number(duty, "bandwidth", "Hz", { 0.1, 100 }, BANDWIDTH);
  }
  if (duty.find("load") != nullptr)
  {
    cycle.load = waveform(duty, "load", values);
  }
  if (duty.find("temperature") != nullptr)
  {
    cycle.temperature = waveform(duty, "temperature", values);
    const Range reached = cycle.temperature->range();
    if (reached.min < MIN_TEMPERATURE || reached.max > MAX_TEMPERATURE)
    {
      required(duty, "temperature")
          .refuse("reaches " + rangeText(reached) +
                  " [degC], allowed: " + rangeText({ MIN_TEMPERATURE, MAX_TEMPERATURE }) + " [degC]");
    }
  }
  return cycle;
}

std::shared_ptr<const Waveform> DutyReader::waveform(const PlanNode& map, const std::string& key,
                                                     const PlanValues& values) const
{
  const char* unit = unitOf(key);
  const PlanNode& node = required(map, key, PlanNode::Kind::MAP);
  allowOnly(node, { "constant", "sinus", "trapezoid", "csv" });
  if (node.entries.size() != 1)
  {
    node.refuse("must be one of constant, sinus, trapezoid, csv");
  }
  const auto& [kind, shape] = node.entries.front();
  if (kind == "constant")
  {
    return std::make_shared<ConstantWaveform>(values.number(node, kind, unit, LARGE));
  }
  if (kind == "sinus")
  {
    allowOnly(shape, { "mean", "amplitude", "frequency", "phase" });
    return std::make_shared<SinusWaveform>(values.number(shape, "mean", unit, LARGE, 0.0),
                                           values.number(shape, "amplitude", unit, { 0.0, LARGE.max }),
                                           values.number(shape, "frequency", "Hz", { 0.0, 1e4 }),
                                           values.number(shape, "phase", "rad", { -1e3, 1e3 }, 0.0));
  }
  if (kind == "trapezoid")
  {
    return trapezoid(shape, unit, values);
  }
  return std::make_shared<TableWaveform>(tables_.at({ values.text(shape, "file"), values.text(shape, "column") }));
}

OrderedJson DutyReader::tables() const
{
  OrderedJson json = OrderedJson::object();
  for (const auto& [table, rows] : tables_)
  {
    json[table.first][table.second] = *rows;
  }
  return json;
}
}  // namespace hjt
