// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/health/baseline.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
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
constexpr int MIN_FITTED = 16;             // windows before slopes and correlations mean anything
// Of a place, rms: nearer ones count as one, 0.025 K and a quarter of a percent of the class of load [-].
constexpr double PLACE_ERROR = 0.005;
constexpr double LEAST_LEFT = 1e-4;  // of a variance by the common causes: they are known no better
constexpr int ITERATIONS = 30;       // for a principal component: its line is narrow enough long before it is exact
constexpr int MIN_COUNT = 8;         // windows before a spread means anything; as least of indicators.baseline_windows

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
  for (const LineSignal signal : ALL_LINE_SIGNALS)
  {
    if (indicator >= cosineIndex(signal, 0) && indicator <= sineIndex(signal, PHASE_LOCKED - 1))
    {
      return amplitudeIndex(signal, (indicator - cosineIndex(signal, 0)) / 2);
    }
  }
  return indicator;
}
}  // namespace

double amplitudeChange(double sound, double change) noexcept
{
  if (sound <= 0.0)
  {
    return change;
  }
  const double root = std::cbrt(std::max(1.0 + change / sound, 0.0));
  return 1.5 * sound * (root * root - 1.0);
}

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

Place placeIn(const OperatingBin& bin, const OperatingPoint& point, double load_step) noexcept
{
  const auto place = [](double value, int step, double size)
  { return std::isfinite(value) ? std::clamp(2.0 * (value / size - step) - 1.0, -1.0, 1.0) : 0.0; };
  const double temperature = place(point.temperature, bin.temperature, TEMPERATURE_STEP);
  return { temperature, temperature * temperature, place(point.load, bin.load, load_step) };
}

Baseline::Baseline(const Parameters& parameters)
  : windows_(parameters.indicators.baseline_windows)
  , least_spread_(parameters.indicators.least_spread)
  , load_step_(hjt::loadStep(parameters))
{
  const double share = parameters.indicators.false_alarm_rate / static_cast<double>(4 * INDICATOR_COUNT);
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

void fitReference(ReferenceBin& bin) noexcept
{
  using Vector = Eigen::Matrix<double, INDICATOR_COUNT, 1>;
  using Square = Eigen::Matrix<double, INDICATOR_COUNT, INDICATOR_COUNT, Eigen::RowMajor>;
  using Places = Eigen::Matrix<double, PLACES, PLACES, Eigen::RowMajor>;
  using Mixed = Eigen::Matrix<double, PLACES, INDICATOR_COUNT, Eigen::RowMajor>;
  const double freedom = bin.windows - 1.0 - PLACES;
  if (bin.windows < MIN_FITTED)
  {
    return;
  }
  const Eigen::Map<const Mixed> mixed(bin.sums.mixed.front().data());
  Eigen::Map<Places> leverage(bin.leverage.front().data());
  leverage = Eigen::Map<const Places>(bin.sums.places.front().data());
  leverage.diagonal().array() += bin.windows * PLACE_ERROR * PLACE_ERROR;
  leverage = leverage.inverse().eval();
  const Mixed slopes = leverage * mixed;
  Square left = Eigen::Map<const Square>(bin.sums.indicators.front().data());
  left.noalias() -= mixed.transpose() * slopes;
  Vector scale = Vector::Zero();  // 0: left out
  int used = 0;
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    const auto column = static_cast<Eigen::Index>(i);
    Reference& reference = bin.references[i];
    reference.common = {};
    reference.fitted = reference.count == bin.windows && left(column, column) > 0.0;
    if (reference.fitted)
    {
      Eigen::Map<Eigen::Matrix<double, PLACES, 1>>(reference.slopes.data()) = slopes.col(column);
      reference.variance = left(column, column) / freedom;
      scale[column] = 1.0 / std::sqrt(left(column, column));
      ++used;
    }
  }
  left = scale.asDiagonal() * left * scale.asDiagonal();
  const double edge = std::pow(1.0 + std::sqrt(used / freedom), 2);
  for (std::size_t cause = 0; cause < COMMON_CAUSES && used > 0; ++cause)
  {
    Eigen::Index widest = 0;
    left.diagonal().maxCoeff(&widest);
    Vector direction = left.col(widest);
    double size = 0.0;
    for (int i = 0; i < ITERATIONS && direction.squaredNorm() > 0.0; ++i)
    {
      direction.normalize();
      direction = left * direction;
      size = direction.norm();
    }
    if (!(size > edge))
    {
      return;
    }
    direction.normalize();
    left -= size * direction * direction.transpose();
    for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
    {
      bin.references[i].common[cause] = std::sqrt(size) * direction[static_cast<Eigen::Index>(i)];
    }
  }
}

BaselineState Baseline::update(const SignalIndicators& indicators, const SignalIndicators* model,
                               WindowDeviations& deviations) noexcept
{
  deviations = {};
  ReferenceBin* bin = find(binOf(indicators.point, load_step_));
  if (bin == nullptr || (given_ && bin->windows < MIN_COUNT))
  {
    return BaselineState::NO_REFERENCE;
  }
  if (!given_ && bin->windows < windows_)
  {
    learn(*bin, indicators);
    return BaselineState::LEARNING;
  }
  compare(*bin, indicators, model, deviations);
  return BaselineState::COMPARED;
}

void Baseline::learn(ReferenceBin& bin, const SignalIndicators& indicators) const noexcept
{
  ++bin.windows;
  const double weight = (bin.windows - 1.0) / bin.windows;
  Place place = placeIn(bin.bin, indicators.point, load_step_);  // from here on less the mean so far
  for (std::size_t i = 0; i < PLACES; ++i)
  {
    place[i] -= bin.mean_place[i];
    bin.mean_place[i] += place[i] / bin.windows;
  }
  std::array<double, INDICATOR_COUNT> before{};  // differences from the means so far
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    Reference& reference = bin.references[i];
    if (!std::isfinite(indicators.values[i]))
    {
      continue;
    }
    ++reference.count;
    before[i] = indicators.values[i] - reference.mean;
    reference.mean += before[i] / reference.count;
    if (reference.count > 1)
    {
      reference.variance += before[i] * before[i] / reference.count - reference.variance / (reference.count - 1.0);
    }
  }
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    for (std::size_t j = 0; j < INDICATOR_COUNT; ++j)
    {
      bin.sums.indicators[i][j] += weight * before[i] * before[j];
    }
  }
  for (std::size_t i = 0; i < PLACES; ++i)
  {
    for (std::size_t j = 0; j < INDICATOR_COUNT; ++j)
    {
      bin.sums.mixed[i][j] += weight * place[i] * before[j];
    }
    for (std::size_t j = 0; j < PLACES; ++j)
    {
      bin.sums.places[i][j] += weight * place[i] * place[j];
    }
  }
  if (bin.windows == windows_)
  {
    fitReference(bin);
  }
}

double Baseline::variance(std::size_t indicator, const ReferenceBin& bin, const SignalIndicators& indicators,
                          double left, double widening) const noexcept
{
  const double least = least_spread_ * bin.references[sizeOf(indicator)].mean;
  const double error = indicators.uncertainty[indicator];
  return std::max(left, error * error) * widening + least * least + floor_[indicator] * floor_[indicator];
}

Deviation Baseline::deviation(double difference, double expected, double spread, double freedom) const noexcept
{
  Deviation deviation;
  deviation.expected = expected;
  deviation.spread = spread;
  if (spread > 0.0)
  {
    const double student = difference / spread;
    deviation.score = normalScore(student, freedom);
    deviation.threshold_factor = std::abs(student) / studentOf(threshold_, freedom);
  }
  return deviation;
}

void Baseline::compare(const ReferenceBin& bin, const SignalIndicators& indicators, const SignalIndicators* model,
                       WindowDeviations& deviations) noexcept
{
  // Woodbury's identity: C^-1 = D^-1 - D^-1 F (1 + F' D^-1 F)^-1 F' D^-1, F with a row for each indicator.
  using Causes = Eigen::Matrix<double, COMMON_CAUSES, 1>;
  Eigen::Matrix<double, COMMON_CAUSES, COMMON_CAUSES> inner;
  inner.setIdentity();
  Causes projected = Causes::Zero();
  double causes = 0.0;
  double least = 0.0;  // degrees of freedom
  residual_ = {};
  using PlaceVector = Eigen::Matrix<double, PLACES, 1>;
  const Place here = placeIn(bin.bin, indicators.point, load_step_);
  const PlaceVector place =
      Eigen::Map<const PlaceVector>(here.data()) - Eigen::Map<const PlaceVector>(bin.mean_place.data());
  const double leverage = place.dot(
      Eigen::Map<const Eigen::Matrix<double, PLACES, PLACES, Eigen::RowMajor>>(bin.leverage.front().data()) * place);
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    const Reference& reference = bin.references[i];
    if (reference.count < MIN_COUNT || !std::isfinite(indicators.values[i]))
    {
      continue;
    }
    const double n = reference.count;
    const double freedom = reference.fitted ? n - 1.0 - PLACES : n - 1.0;
    const double widening = 1.0 + 1.0 / n + (reference.fitted ? leverage : 0.0);
    const double expected = reference.mean + place.dot(Eigen::Map<const PlaceVector>(reference.slopes.data()));
    least = least == 0.0 ? freedom : std::min(least, freedom);
    residual_.sound[i] = expected + (model != nullptr ? model->values[i] : 0.0);
    residual_.difference[i] = indicators.values[i] - expected;
    if (const double sound = residual_.sound[i]; isFreeAmplitude(i) && sound > 0.0)
    {
      // The mean of the power lies below the power of the mean.
      residual_.difference[i] =
          amplitudeChange(sound, residual_.difference[i]) + std::min(reference.variance / sound, sound) / 6.0;
    }
    deviations.plain[i] = deviation(residual_.difference[i], expected,
                                    std::sqrt(variance(i, bin, indicators, reference.variance, widening)), freedom);
    const Causes common = Eigen::Map<const Causes>(reference.common.data());
    const double found = static_cast<double>((common.array() != 0.0).count());
    const double left = std::max(1.0 - common.squaredNorm(), LEAST_LEFT) * freedom / (freedom - found);
    causes = std::max(causes, found);
    residual_.own[i] = variance(i, bin, indicators, left * reference.variance, widening);
    if (residual_.own[i] > 0.0)
    {
      Eigen::Map<Causes> row(residual_.common[i].data());
      row = std::sqrt(reference.variance * widening) * common;
      inner += row * row.transpose() / residual_.own[i];
      projected += row * (residual_.difference[i] / residual_.own[i]);
    }
  }
  residual_.freedom = std::max(least - causes, 1.0);
  if (causes == 0.0)
  {
    return;
  }
  inner = inner.inverse().eval();
  const Causes explained = inner * projected;
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    const double own = residual_.own[i];
    if (own > 0.0)
    {
      const Eigen::Map<const Causes> row(residual_.common[i].data());
      const double weighted = (residual_.difference[i] - row.dot(explained)) / own;  // of C^-1 (x - m)
      const double precision = (1.0 - row.dot(inner * row) / own) / own;             // of C^-1
      const double spread = 1.0 / std::sqrt(precision);
      const double unexpected = weighted / precision;
      const double expected = deviations.plain[i].expected + (residual_.difference[i] - unexpected);
      deviations.conditional[i] = deviation(unexpected, expected, spread, residual_.freedom);
    }
  }
}
}  // namespace hjt
