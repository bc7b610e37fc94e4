// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/health/baseline.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/normal.hpp>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "health/indicator_table.hpp"

namespace hjt
{
namespace
{
constexpr double LOAD_STEP = 0.375;        // of the rated torque
constexpr double TEMPERATURE_STEP = 10.0;  // [K]
constexpr double ONE_WAY = 0.5;            // share of travel one way less the other that counts as one direction
constexpr int MIN_COUNT = 8;  // windows before a spread means anything; as least of indicators.baseline_windows

int stepOf(double value, double step) noexcept
{
  constexpr double FARTHEST = 1e6;  // damaged recordings hold numbers that no int does
  return std::isfinite(value) ? static_cast<int>(std::clamp(std::floor(value / step), -FARTHEST, FARTHEST)) : 0;
}

/// Student's t with `freedom` as a normal deviate, and back.
double normalScore(double t, double freedom) noexcept
{
  return std::copysign(std::sqrt(freedom * std::log1p(t * t / freedom)), t) * (8.0 * freedom + 1.0) /
         (8.0 * freedom + 3.0);
}
double studentOf(double score, double freedom) noexcept
{
  const double plain = score * (8.0 * freedom + 3.0) / (8.0 * freedom + 1.0);
  return std::sqrt(freedom * std::expm1(plain * plain / freedom));
}

/// For the parts of a line the floor is a share of its amplitude: the part itself may be near zero.
std::size_t sizeOf(std::size_t indicator) noexcept
{
  for (const LineSignal signal : { LineSignal::KINEMATIC_ERROR, LineSignal::MOTOR_TORQUE })
  {
    if (indicator >= cosineIndex(signal, 0) && indicator <= sineIndex(signal, PHASE_LOCKED - 1))
    {
      return amplitudeIndex(signal, (indicator - cosineIndex(signal, 0)) / 2);
    }
  }
  return indicator;
}
}  // namespace

double loadStep(const Parameters& parameters) noexcept
{
  return LOAD_STEP * parameters.life.rated_torque;
}

OperatingBin binOf(const OperatingPoint& point, double load_step) noexcept
{
  OperatingBin bin;
  bin.speed = point.speed > 0.0 ? stepOf(std::log2(point.speed), 1.0) : -100;
  bin.direction = point.direction > ONE_WAY ? 1 : point.direction < -ONE_WAY ? -1 : 0;
  bin.load = stepOf(point.load, load_step);
  bin.temperature = stepOf(point.temperature, TEMPERATURE_STEP);
  return bin;
}

void Reference::add(double value) noexcept
{
  ++count;
  const double before = value - mean;
  mean += before / count;
  squares += before * (value - mean);
}

Baseline::Baseline(const Parameters& parameters)
  : windows_(parameters.indicators.baseline_windows)
  , least_spread_(parameters.indicators.least_spread)
  , load_step_(hjt::loadStep(parameters))
{
  const double share = parameters.indicators.false_alarm_rate / static_cast<double>(2 * INDICATOR_COUNT);
  threshold_ = boost::math::quantile(boost::math::complement(boost::math::normal(), share));
  const double count = std::hypot(TWO_PI / parameters.sensors.motor_counts_per_turn / nominalRatio(parameters.gear),
                                  TWO_PI / std::exp2(parameters.sensors.output_bits));
  const std::array<double, 3> unit{ 1.0, count, count * nominalRatio(parameters.gear) / TWO_PI };  // by FloorUnit
  for (const ScalarRow& row : SCALARS)
  {
    floor_[indexOf(row.indicator)] = row.floor * unit[static_cast<std::size_t>(row.floor_unit)];
  }
  bins_.reserve(MAX_BINS);
}

void Baseline::setReference(std::vector<ReferenceBin> bins)
{
  bins_ = std::move(bins);
  given_ = true;
}

void Baseline::reset() noexcept
{
  if (!given_)
  {
    bins_.clear();
  }
}

ReferenceBin* Baseline::find(const OperatingBin& bin) noexcept
{
  const auto found =
      std::find_if(bins_.begin(), bins_.end(), [&bin](const ReferenceBin& known) { return known.bin == bin; });
  if (found != bins_.end())
  {
    return &*found;
  }
  if (given_ || bins_.size() == MAX_BINS)
  {
    return nullptr;
  }
  bins_.emplace_back();
  bins_.back().bin = bin;
  return &bins_.back();
}

BaselineState Baseline::update(const SignalIndicators& indicators, Deviations& deviations) noexcept
{
  deviations.fill({});
  ReferenceBin* bin = find(binOf(indicators.point, load_step_));
  if (bin == nullptr)
  {
    return BaselineState::NO_REFERENCE;
  }
  if (!given_ && bin->windows < windows_)
  {
    ++bin->windows;
    for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
    {
      if (std::isfinite(indicators.values[i]))
      {
        bin->references[i].add(indicators.values[i]);
      }
    }
    return BaselineState::LEARNING;
  }
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    deviations[i] = compare(i, *bin, indicators);
  }
  return BaselineState::COMPARED;
}

Deviation Baseline::compare(std::size_t indicator, const ReferenceBin& bin,
                            const SignalIndicators& indicators) const noexcept
{
  const Reference& reference = bin.references[indicator];
  Deviation deviation;
  const double value = indicators.values[indicator];
  if (reference.count < MIN_COUNT || !std::isfinite(value))
  {
    return deviation;
  }
  const double n = reference.count;
  const double least = least_spread_ * bin.references[sizeOf(indicator)].mean;
  const double error = indicators.uncertainty[indicator];
  const double variance = std::max(reference.variance(), error * error) * (1.0 + 1.0 / n) + least * least +
                          floor_[indicator] * floor_[indicator];
  deviation.expected = reference.mean;
  deviation.spread = std::sqrt(variance);
  if (variance > 0.0)
  {
    const double student = (value - reference.mean) / deviation.spread;
    deviation.score = normalScore(student, n - 1.0);
    deviation.threshold_factor = std::abs(student) / studentOf(threshold_, n - 1.0);
  }
  return deviation;
}
}  // namespace hjt
