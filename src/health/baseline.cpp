// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/health/baseline.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Core>
#include <boost/math/distributions/normal.hpp>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/health/fault_signatures.hpp"
#include "health/indicator_table.hpp"
#include "health/reference_fit.hpp"

namespace hjt
{
namespace
{
constexpr std::size_t TRIMMED = 5;        // one of so many is left out at either end
constexpr std::size_t LEAST_WINDOWS = 3;  // of which one can be left out at either end
constexpr double CARRIED_WINDOWS = 10.0;  // of the means that CarriedError is fitted to
constexpr std::size_t JUMPS = 2;          // no scatter: the onset of a fault, and the newest window beside the oldest

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

/// That so large a share lies beyond.
double normalQuantile(double share)
{
  return boost::math::quantile(boost::math::complement(boost::math::normal(), share));
}

/// What stays from one window to the next.
struct Persistence
{
  double stays;        // r
  double independent;  // e
};

Persistence persistenceOf(const ReferenceBin& bin, const Reference& reference) noexcept
{
  if (!(reference.within > 0.0 && reference.variance > 0.0))
  {
    return { 1.0, 1.0 };
  }
  const double found = 1.0 - reference.within / reference.variance;
  // Its standard error (von Neumann 1941): what is not seen to stay may, and what seems to may not.
  const double error = 1.0 / std::sqrt(std::max(reference.count - bin.runs, 1));
  const double least = std::clamp(found - error, 0.0, 1.0);
  const double runs = static_cast<double>(bin.runs) / bin.windows;
  return { std::clamp(found + error, error, 1.0), std::max((1.0 - least) / (1.0 + least), std::min(runs, 1.0)) };
}

/// What the drive differs from the model by: of a line the root of the sum of squares over the lines of its signal
/// whose phase stays, for resonances make any of them large in one motion and small in another.
double sizeOffModel(const ReferenceBin& bin, std::size_t indicator) noexcept
{
  if (indicator < SCALAR_COUNT)
  {
    return std::abs(bin.references[indicator].mean);
  }
  double square = 0.0;
  for (std::size_t line = 0; line < FIRST_LOCKED; ++line)
  {
    const double amplitude = bin.references[amplitudeIndex(signalOf(indicator), line)].mean;
    square += amplitude * amplitude;
  }
  return std::sqrt(square);
}

/// What a reference carried to another motion is less sure by, where a mean is of so many windows.
double carriedVariance(const ReferenceBin& bin, const CarriedError& error, std::size_t indicator,
                       double windows) noexcept
{
  const double off = error.share * sizeOffModel(bin, indicator);
  // Below CARRIED_WINDOWS as if all of it were noise.
  return (error.deviation * error.deviation + off * off) * std::max(CARRIED_WINDOWS / windows, 1.0);
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

Baseline::Baseline(const Parameters& parameters, std::shared_ptr<const SignatureSet> signatures)
  : signatures_(std::move(signatures))
  , windows_(parameters.indicators.baseline_windows)
  , evidence_windows_(static_cast<std::size_t>(parameters.indicators.evidence_windows))
  , least_spread_(parameters.indicators.least_spread)
  , load_step_(hjt::loadStep(parameters))
{
  const auto patterns = static_cast<double>(patternCount(*signatures_));
  const double rate = parameters.indicators.false_alarm_rate * (patterns > 0.0 ? 0.5 : 1.0);
  threshold_ = normalQuantile(rate / static_cast<double>(2 * INDICATOR_COUNT));
  pattern_threshold_ = normalQuantile(rate / std::max(patterns, 1.0));
  const double count = std::hypot(TWO_PI / parameters.sensors.motor_counts_per_turn / nominalRatio(parameters.gear),
                                  TWO_PI / parameters.sensors.output_counts_per_turn);
  const std::array<double, 3> unit{ 1.0, count, count * nominalRatio(parameters.gear) / TWO_PI };  // by FloorUnit
  for (const ScalarRow& row : SCALARS)
  {
    floor_[indexOf(row.indicator)] = row.floor * unit[static_cast<std::size_t>(row.floor_unit)];
  }
  const auto classes = static_cast<std::size_t>(parameters.indicators.baseline_classes);
  bins_.reserve(classes);
  sums_.reserve(classes);
  makeRoom(classes);
}

void Baseline::makeRoom(std::size_t bins)
{
  recent_.assign(bins, {});
  compared_ = std::vector<Compared>(bins * evidence_windows_);
}

void Baseline::setReference(std::vector<ReferenceBin> bins, bool carried)
{
  bins_ = std::move(bins);
  given_ = true;
  carried_ = carried;
  sums_ = std::vector<LearnedSums>();
  makeRoom(bins_.size());
}

void Baseline::reset() noexcept
{
  std::fill(recent_.begin(), recent_.end(), Recent{});
  if (!given_)
  {
    bins_.clear();
    sums_.clear();
  }
}

ReferenceBin* Baseline::find(const OperatingPoint& point) noexcept
{
  const OperatingBin bin = binOf(point, load_step_);
  ReferenceBin* own = nullptr;
  ReferenceBin* near = nullptr;  // with most windows
  for (ReferenceBin& known : bins_)
  {
    if (known.bin == bin)
    {
      own = &known;
    }
    else if (known.windows >= MIN_WINDOWS && isInReach(known.bin, point, load_step_) &&
             (near == nullptr || known.windows > near->windows))
    {
      near = &known;
    }
  }
  own = near != nullptr && (own == nullptr || own->windows < MIN_WINDOWS) ? near : own;
  if (own != nullptr || given_ || bins_.size() == recent_.size())
  {
    return own;
  }
  bins_.emplace_back().bin = bin;
  sums_.emplace_back();
  return &bins_.back();
}

ReferenceBin* Baseline::findCarried(const OperatingBin& bin) noexcept
{
  ReferenceBin* most = nullptr;
  for (ReferenceBin& known : bins_)
  {
    const bool serves = known.bin.direction == 0 && known.bin.temperature == bin.temperature;
    if (serves && (most == nullptr || known.windows > most->windows))
    {
      most = &known;
    }
  }
  return bin.direction == 0 ? most : nullptr;
}

BaselineState Baseline::update(const SignalIndicators& indicators, const SignalIndicators* model,
                               Deviations& deviations) noexcept
{
  deviations = {};
  residual_ = {};
  ReferenceBin* bin = carried_ ? findCarried(binOf(indicators.point, load_step_)) : find(indicators.point);
  windows_here_ = bin != nullptr ? bin->windows : 0;
  if (bin == nullptr || (given_ && windows_here_ < MIN_WINDOWS))
  {
    return BaselineState::NO_REFERENCE;
  }
  const auto index = static_cast<std::size_t>(bin - bins_.data());
  if (!given_ && bin->windows < windows_)
  {
    learnWindow(*bin, sums_[index], indicators, placeIn(bin->bin, indicators.point, load_step_));
    if (++windows_here_ == windows_)
    {
      fitReference(*bin, sums_[index], bins_, sums_, fit_room_);
    }
    return BaselineState::LEARNING;
  }
  Recent& recent = recent_[index];
  const std::size_t first = index * evidence_windows_;
  take(*bin, indicators, model, compared_[first + recent.next]);
  recent.next = (recent.next + 1) % evidence_windows_;
  windows_here_ = static_cast<int>(++recent.count);
  bin_ = bin->bin;
  compare(*bin, first, std::min(recent.count, evidence_windows_), deviations);
  return BaselineState::COMPARED;
}

double Baseline::variance(std::size_t indicator, const ReferenceBin& bin, const Average& average, double left,
                          const Widening& widening) const noexcept
{
  // Of a part of a line a share of its amplitude: the part itself may be near zero.
  const double least = least_spread_ * bin.references[amplitudeOf(indicator)].mean;
  const double usual = bin.references[indicator].relative_square;
  const double square = left * (usual > 0.0 ? std::max(average.relative_square / usual, 1.0) : 1.0);
  return square * widening.stays + std::max(square * widening.varies, average.scatter_square / average.weight) +
         least * least + floor_[indicator] * floor_[indicator] + widening.carried;
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

Deviation Baseline::pattern(double student) const noexcept
{
  const double freedom = std::max(residual_.freedom, 1.0);
  Deviation deviation;
  deviation.score = normalScore(student, freedom);
  deviation.threshold_factor = student / studentOf(pattern_threshold_, freedom);
  return deviation;
}

void Baseline::take(const ReferenceBin& bin, const SignalIndicators& indicators, const SignalIndicators* model,
                    Compared& window) noexcept
{
  const Place here = placeIn(bin.bin, indicators.point, load_step_);
  PlaceVector place = mapped(here) - mapped(bin.mean_place);
  if (carried_)
  {
    place.tail<PLACES - OWN_PLACES>().setZero();  // load and payload are the model's to follow
  }
  window.leverage = place.dot(mapped(bin.leverage) * place);
  window.relative = relativeErrors(indicators);
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    const Reference& reference = bin.references[i];
    window.difference[i] = std::numeric_limits<double>::quiet_NaN();
    expected_[i] = reference.mean + place.dot(mapped(reference.slopes));
    residual_.sound[i] =
        reference.count < MIN_WINDOWS ? 0.0 : expected_[i] + (model != nullptr ? model->values[i] : 0.0);
    if (reference.count < MIN_WINDOWS || !std::isfinite(indicators.values[i]))
    {
      continue;
    }
    window.difference[i] = indicators.values[i] - expected_[i];
    if (const double sound = residual_.sound[i]; isFreeAmplitude(i) && sound > 0.0)
    {
      // The mean of the power lies below the power of the mean.
      window.difference[i] =
          amplitudeChange(sound, window.difference[i]) + std::min(reference.variance / sound, sound) / 6.0;
    }
  }
}

Baseline::Average Baseline::average(std::size_t first, std::size_t count, std::size_t indicator) const noexcept
{
  std::array<double, MAX_EVIDENCE> differences;  // of which the first `found` count
  std::array<double, MAX_EVIDENCE> steps;        // half the square from each to the next
  std::size_t found = 0;
  Average average;
  for (std::size_t i = first; i < first + count; ++i)
  {
    const double difference = compared_[i].difference[indicator];
    if (std::isfinite(difference))
    {
      if (found > 0)
      {
        steps[found - 1] = 0.5 * std::pow(difference - differences[found - 1], 2);
      }
      differences[found++] = difference;
      average.relative_square += compared_[i].relative[indicator] * compared_[i].relative[indicator];
    }
  }
  if (2 * found < count || found < std::min(count, LEAST_WINDOWS))
  {
    return average;
  }
  const std::size_t left_out = found < LEAST_WINDOWS ? 0 : std::max<std::size_t>(found / TRIMMED, 1);
  std::sort(differences.begin(), differences.begin() + static_cast<std::ptrdiff_t>(found));
  const double sum = std::accumulate(differences.begin() + static_cast<std::ptrdiff_t>(left_out),
                                     differences.begin() + static_cast<std::ptrdiff_t>(found - left_out), 0.0);
  average.difference = sum / static_cast<double>(found - 2 * left_out);
  average.relative_square /= static_cast<double>(found);
  if (found > JUMPS + 1)
  {
    const std::size_t used = found - 1 - JUMPS;
    std::sort(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(found - 1));
    average.scatter_square = std::accumulate(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(used), 0.0) /
                             static_cast<double>(used);
  }
  average.weight = static_cast<double>(found - left_out);
  return average;
}

void Baseline::compare(const ReferenceBin& bin, std::size_t first, std::size_t count, Deviations& deviations) noexcept
{
  using Causes = Eigen::Matrix<double, COMMON_CAUSES, 1>;
  double causes = 0.0;
  double freedoms = 0.0;
  double compared = 0.0;
  double leverage = 0.0;
  for (std::size_t i = first; i < first + count; ++i)
  {
    leverage += compared_[i].leverage / static_cast<double>(count);
  }
  residual_.windows = static_cast<int>(count);
  const std::array<double, INDICATOR_COUNT> alike = varianceOfAlike(bin);
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    const bool sound_known = std::isfinite(residual_.sound[i]);  // else the model did not determine it in this window
    residual_.sound[i] = sound_known ? residual_.sound[i] : 0.0;
    const Average average = this->average(first, count, i);
    if (average.weight == 0.0)  // too few windows determined it
    {
      continue;
    }
    const Reference& reference = bin.references[i];
    const Persistence persistence = persistenceOf(bin, reference);
    const double n = reference.count;
    const double fitted = reference.fitted ? bin.slopes_freedom : 0.0;
    const double known_with = carried_ ? signatures_->carried[i].freedom : n;
    const double freedom = std::clamp(persistence.independent * n - 1.0 - fitted, 1.0, known_with);
    const double h = (1.0 + (reference.fitted ? leverage * bin.windows : 0.0)) / n / persistence.independent;
    const Widening widening{ persistence.stays + h, (1.0 - persistence.stays) / average.weight,
                             carried_ ? carriedVariance(bin, signatures_->carried[i], i, static_cast<double>(count)) :
                                        0.0 };
    const double prior = alike[i] > 0.0 && !carried_ ? ALIKE_FREEDOM : 0.0;
    const double usual = (freedom * reference.variance + prior * alike[i]) / (freedom + prior);
    freedoms += freedom;
    compared += 1.0;
    residual_.difference[i] = average.difference;
    deviations[i] = deviation(average.difference, expected_[i], std::sqrt(variance(i, bin, average, usual, widening)),
                              freedom + prior);
    if (!sound_known)
    {
      continue;
    }
    const Causes common = carried_ ? Causes(Causes::Zero()) : Causes(Eigen::Map<const Causes>(reference.common.data()));
    const double found = static_cast<double>((common.array() != 0.0).count());
    const double left =
        std::max(1.0 - common.squaredNorm(), LEAST_LEFT) * (n - 1.0 - fitted) / (n - 1.0 - fitted - found);
    causes = std::max(causes, found);
    residual_.own[i] = variance(i, bin, average, left * usual, widening);
    Eigen::Map<Causes>(residual_.common[i].data()) = std::sqrt(usual * (widening.stays + widening.varies)) * common;
  }
  residual_.freedom = compared > 0.0 ? std::max(freedoms / compared - causes, 1.0) : 0.0;
}
}  // namespace hjt
