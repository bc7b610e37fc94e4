// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "params/field_table.hpp"

namespace hjt
{
/// A quantity over time, and its slope.
class Waveform
{
public:
  virtual ~Waveform() = default;
  virtual double value(double time) const = 0;  ///< `time` [s] from 0 on
  virtual double slope(double time) const = 0;  ///< [1/s] of the quantity's unit
  virtual Range range() const = 0;              ///< it never leaves
};

class ConstantWaveform : public Waveform
{
public:
  explicit ConstantWaveform(double value) : value_(value) {}
  double value(double) const override { return value_; }
  double slope(double) const override { return 0.0; }
  Range range() const override { return { value_, value_ }; }

private:
  double value_;
};

/// mean + amplitude sin(2 pi frequency t + phase): phase [rad], frequency [Hz].
class SinusWaveform : public Waveform
{
public:
  SinusWaveform(double mean, double amplitude, double frequency, double phase);
  double value(double time) const override;
  double slope(double time) const override;
  Range range() const override { return { mean_ - amplitude_, mean_ + amplitude_ }; }

private:
  double mean_, amplitude_, angular_frequency_, phase_;
};

/// Periodic: up to the peak at a constant slope, there for `hold`, down to zero, there for `pause`; then the same
/// with the opposite sign. Without a peak, where these times may all be zero, it stands still.
class TrapezoidWaveform : public Waveform
{
public:
  static constexpr double SHORTEST = 1e-9;  ///< half period of one with a peak [s]

  /// `slope` [1/s] of the quantity's unit, > 0; `hold`, `pause` [s].
  TrapezoidWaveform(double peak, double slope, double hold, double pause);
  double value(double time) const override;
  double slope(double time) const override;
  Range range() const override { return { -std::abs(peak_), std::abs(peak_) }; }
  double halfPeriod() const { return half_period_; }  ///< [s]

private:
  struct Place
  {
    double sign;
    double time;  // since the half period began [s]
  };
  Place place(double time) const;

  double peak_, slope_, rise_, hold_, half_period_;
};

/// Straight lines between the rows of a table; before the first and after the last row its value holds.
class TableWaveform : public Waveform
{
public:
  using Rows = std::vector<std::pair<double, double>>;

  /// One column over the column `time` [s] of a CSV file. @throws InputError naming line and column.
  static std::shared_ptr<const Rows> read(const std::string& path, const std::string& column, const Range& range,
                                          const std::string& unit);

  explicit TableWaveform(std::shared_ptr<const Rows> rows) : rows_(std::move(rows)) {}
  double value(double time) const override;
  double slope(double time) const override;
  Range range() const override;

private:
  std::size_t rowAfter(double time) const;

  std::shared_ptr<const Rows> rows_;
};
}  // namespace hjt
