// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/waveform.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/number_table.hpp"
#include "gear/angle.hpp"

namespace hjt
{
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
      throw InputError(table.place() + ": column 'time' must start at 0 or later and ascend");
    }
    table.requireRange(1, row[1], range, unit);
    if (!rows->empty() && !std::isfinite((row[1] - rows->back().second) / (row[0] - rows->back().first)))
    {
      throw InputError(table.place() + ": column '" + column + "' rises without bound");
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
}  // namespace hjt
