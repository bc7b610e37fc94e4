// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/health/baseline.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Dense>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/health/fault_signatures.hpp"
#include "health/indicator_table.hpp"
#include "health/reference_fit.hpp"

namespace hjt
{
namespace
{
using Causes = Eigen::Matrix<double, COMMON_CAUSES, 1>;

constexpr std::size_t TRIMMED = 5;              // the trimmed mean omits one window in 5 at either end
constexpr std::size_t LEAST_WINDOWS = 3;        // least number of windows of which the mean omits one at either end
constexpr double OTHER_PAYLOAD_WIDENING = 4.0;  // a spread 2.2 times as large would hide most faults [-]
constexpr double LEAST_RIDGE = 4e-4;            // square of the covariates' noise, which is 0.02 of half a class [-]
// Number of differences that are no scatter: at the onset of a fault, and from newest to oldest window in the buffer.
constexpr std::size_t JUMPS = 2;

/// Mean of Baseline::Compared::along over `count` windows.
template <class Window>
PlaceVector meanAlong(const Window* windows, std::size_t count) noexcept
{
  PlaceVector sum = PlaceVector::Zero();
  std::for_each(windows, windows + count, [&](const Window& window) { sum += mapped(window.along); });
  return sum / static_cast<double>(count);
}

Deviation deviationOf(double difference, double expected, double spread, const Uncertainty& uncertainty,
                      double threshold) noexcept
{
  Deviation deviation;
  deviation.expected = expected;
  deviation.spread = spread;
  if (spread > 0.0)
  {
    deviation.freedom = uncertainty.freedom();
    deviation.stretch = uncertainty.stretch();
    const double student = deviation.stretch * difference / spread;
    deviation.score = normalScore(student, deviation.freedom);
    deviation.threshold_factor = std::abs(student) / studentOf(threshold, deviation.freedom);
  }
  return deviation;
}

constexpr double LOAD_STEP = 0.375;        // width of a class of load, as a share of the rated torque [-]
constexpr double TEMPERATURE_STEP = 10.0;  // width of a class of temperature [K]
constexpr double ONE_WAY = 0.5;            // OperatingPoint::direction above which a motion counts as one-way [-]
constexpr double REACH = 0.25;  // distance beyond the edge of a class that isInReach accepts, as a share of a step [-]
constexpr double INERTIA_ACCELERATION = 5.0;  // acceleration that converts the inertia to a torque [rad/s^2]

int stepOf(double value, double step) noexcept
{
  constexpr double FARTHEST = 1e6;  // limit, because damaged recordings have numbers that no int can hold
  return std::isfinite(value) ? static_cast<int>(std::clamp(std::floor(value / step), -FARTHEST, FARTHEST)) : 0;
}

bool isNear(double value, double step, int known) noexcept
{
  return std::isfinite(value) ? std::abs(value / step - known - 0.5) <= 0.5 + REACH : known == 0;
}

/// Whether the point lies within the class or at most REACH beyond the edges of the class.
bool isInReach(const OperatingBin& bin, const OperatingPoint& point, double load_step) noexcept
{
  const OperatingBin own = binOf(point, load_step);
  const bool is_speed_near =
      point.speed > 0.0 ? isNear(std::log2(point.speed), 1.0, bin.speed) : own.speed == bin.speed;
  return is_speed_near && own.direction == bin.direction && isNear(point.load, load_step, bin.load) &&
         isNear(point.temperature, TEMPERATURE_STEP, bin.temperature);
}

/// Covariates of a point [-]. Temperature and load go from -1 to 1 between the edges of the class, to 1.5 outside. The
/// payload is in half steps of load, its inertia as the torque at INERTIA_ACCELERATION. A value that is not known is 0.
Place placeIn(const OperatingBin& bin, const OperatingPoint& point, double load_step) noexcept
{
  const auto place = [](double value, int step, double size, double farthest)
  { return std::isfinite(value) ? std::clamp(2.0 * (value / size - step) - 1.0, -farthest, farthest) : 0.0; };
  const double temperature = place(point.temperature, bin.temperature, TEMPERATURE_STEP, 1.0 + 2.0 * REACH);
  constexpr double FARTHEST = 100.0;
  return { temperature,
           temperature * temperature,
           place(point.load, bin.load, load_step, 1.0 + 2.0 * REACH),
           place(point.load_constant, 0, load_step, FARTHEST),
           place(point.load_sine, 0, load_step, FARTHEST),
           place(point.load_cosine, 0, load_step, FARTHEST),
           place(INERTIA_ACCELERATION * point.inertia, 0, load_step, FARTHEST) };
}
}  // namespace

OperatingBin binOf(const OperatingPoint& point, double load_step) noexcept
{
  OperatingBin bin;
  bin.speed = point.speed > 0.0 ? stepOf(std::log2(point.speed), 1.0) : -100;
  bin.direction = point.direction > ONE_WAY ? 1 : point.direction < -ONE_WAY ? -1 : 0;
  bin.load = stepOf(point.load, load_step);
  bin.temperature = stepOf(point.temperature, TEMPERATURE_STEP);
  return bin;
}

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
  , repeatability_(repeatabilityOf(parameters))
  , load_step_(hjt::loadStep(parameters))
{
  const auto patterns = static_cast<double>(patternCount(*signatures_));
  const double rate = parameters.indicators.false_alarm_rate * (patterns > 0.0 ? 0.5 : 1.0);
  threshold_ = normalQuantile(rate / static_cast<double>(2 * INDICATOR_COUNT));
  pattern_threshold_ = normalQuantile(rate / std::max(patterns, 1.0));
  const double count = std::hypot(TWO_PI / parameters.sensors.motor_counts_per_turn / nominalRatio(parameters.gear),
                                  TWO_PI / parameters.sensors.output_counts_per_turn);
  const std::array<double, 3> unit{ 1.0, count,
                                    count * nominalRatio(parameters.gear) / TWO_PI };  // size of each FloorUnit
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
  ReferenceBin* near = nullptr;  // class within reach that has the most windows
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

AssessmentState Baseline::update(const SignalIndicators& indicators, const SignalIndicators* model,
                                 Deviations& deviations) noexcept
{
  deviations = {};
  residual_ = {};
  ReferenceBin* bin = carried_ ? findCarried(binOf(indicators.point, load_step_)) : find(indicators.point);
  windows_here_ = bin != nullptr ? bin->windows : 0;
  if (bin == nullptr || (given_ && windows_here_ < MIN_WINDOWS))
  {
    return AssessmentState::NO_REFERENCE;
  }
  const auto index = static_cast<std::size_t>(bin - bins_.data());
  if (!given_ && bin->windows < windows_)
  {
    learnWindow(*bin, sums_[index], indicators, model, placeIn(bin->bin, indicators.point, load_step_));
    if (++windows_here_ == windows_)
    {
      fitReference(*bin, sums_[index], bins_, sums_, repeatability_, fit_room_);
    }
    return AssessmentState::LEARNING;
  }
  const Place place = placeFrom(*bin, indicators.point);
  if (isOtherPayload(*bin, place))
  {
    return AssessmentState::OTHER_PAYLOAD;
  }
  Recent& recent = recent_[index];
  const std::size_t first = index * evidence_windows_;
  take(*bin, place, indicators, model, compared_[first + recent.next]);
  recent.next = (recent.next + 1) % evidence_windows_;
  windows_here_ = static_cast<int>(++recent.count);
  bin_ = bin->bin;
  compare(*bin, first, std::min(recent.count, evidence_windows_), deviations);
  return AssessmentState::ASSESSED;
}

Baseline::Variance Baseline::variance(std::size_t indicator, const ReferenceBin& bin, const Average& average,
                                      double left, const Widening& widening) const noexcept
{
  const double repeats = repeatsWithin(repeatability_, bin, indicator);
  const double usual = bin.references[indicator].relative_square;
  const double square = left * (usual > 0.0 ? std::max(average.relative_square / usual, 1.0) : 1.0);
  const double learned =
      square * widening.stays + std::max(square * widening.varies, average.scatter_square / average.weight);
  return { learned + repeats * repeats + floor_[indicator] * floor_[indicator] +
               (square + repeats * repeats) * widening.slopes + widening.carried,
           learned };
}

double Deviation::scoreOf(double difference) const noexcept
{
  return spread > 0.0 ? normalScore(stretch * difference / spread, freedom) : 0.0;
}

Deviation Baseline::pattern(double student) const noexcept
{
  Deviation deviation;
  deviation.spread = 1.0;
  deviation.freedom = residual_.pattern_freedom;
  deviation.stretch = residual_.pattern_stretch;
  deviation.score = deviation.scoreOf(student);
  deviation.threshold_factor = deviation.stretch * student / studentOf(pattern_threshold_, deviation.freedom);
  return deviation;
}

Place Baseline::placeFrom(const ReferenceBin& bin, const OperatingPoint& point) const noexcept
{
  const Place here = placeIn(bin.bin, point, load_step_);
  Place place;
  mapped(place) = mapped(here) - mapped(bin.mean_place);
  if (carried_)
  {
    mapped(place).tail<PLACES - OWN_PLACES>().setZero();  // the subtracted model has the effects of load and payload
  }
  return place;
}

bool Baseline::isOtherPayload(const ReferenceBin& bin, const Place& place) const noexcept
{
  Squares information = mapped(bin.information);
  information.diagonal().array() += std::max(std::pow(repeatability_.share / SLOPE_SHARE, 2), LEAST_RIDGE);
  PlaceVector off = mapped(place);
  off.head<OWN_PLACES>().setZero();
  return off.dot(information.ldlt().solve(off)) > OTHER_PAYLOAD_WIDENING;
}

void Baseline::take(const ReferenceBin& bin, const Place& place, const SignalIndicators& indicators,
                    const SignalIndicators* model, Compared& window) noexcept
{
  const Eigen::SelfAdjointEigenSolver<Squares> axes(mapped(bin.information));
  mapped(axes_sizes_) = axes.eigenvalues().cwiseMax(0.0);
  mapped(window.along) = (axes.eigenvectors().transpose() * mapped(place)).array().square();
  window.relative = relativeErrors(indicators);
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    const Reference& reference = bin.references[i];
    window.difference[i] = std::numeric_limits<double>::quiet_NaN();
    expected_[i] = reference.mean + mapped(place).dot(mapped(reference.slopes));
    residual_.sound[i] =
        reference.count < MIN_WINDOWS ? 0.0 : expected_[i] + (model != nullptr ? model->values[i] : 0.0);
    if (reference.count < MIN_WINDOWS || !std::isfinite(indicators.values[i]))
    {
      continue;
    }
    window.difference[i] = indicators.values[i] - expected_[i];
    if (const double sound = residual_.sound[i]; isFreeAmplitude(i) && sound > 0.0)
    {
      // The last term corrects for the mean of amplitudes^(2/3), which is below (mean amplitude)^(2/3).
      window.difference[i] =
          amplitudeChange(sound, window.difference[i]) + std::min(reference.variance / sound, sound) / 6.0;
    }
  }
}

Baseline::Average Baseline::average(std::size_t first, std::size_t count, std::size_t indicator) const noexcept
{
  std::array<double, MAX_EVIDENCE> differences;  // first `found` values are valid
  std::array<double, MAX_EVIDENCE> steps;        // half the square of the difference of successive windows
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
  double causes = 0.0;
  double freedoms = 0.0;
  double compared = 0.0;
  Eigen::Vector3d scalars = Eigen::Vector3d::Zero();  // number of compared scalars, sums of Uncertainty's two fields
  const PlaceVector along = meanAlong(&compared_[first], count);
  residual_.windows = static_cast<int>(count);
  const std::array<double, INDICATOR_COUNT> alike = varianceOfAlike(bin);
  const std::array<CommonPersistence, TAILS> persistences{ commonPersistence(bin, 0), commonPersistence(bin, 1) };
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    const bool sound_known = std::isfinite(residual_.sound[i]);  // NaN: the model did not determine the indicator
    residual_.sound[i] = sound_known ? residual_.sound[i] : 0.0;
    const Average average = this->average(first, count, i);
    if (average.weight == 0.0)  // too few windows determined the indicator
    {
      continue;
    }
    const Reference& reference = bin.references[i];
    const Persistence persistence = persistenceOf(bin, reference, persistences[tailOf(i)]);
    const double n = reference.count;
    const double fitted = reference.slopes_freedom;
    const double known_with = carried_ ? signatures_->carried[i].freedom : n;
    const double freedom = std::clamp(persistence.independent * n - 1.0 - fitted, 1.0, known_with);
    const double leverage =
        reference.fitted ? (along.array() / (mapped(axes_sizes_).array() + reference.ridge)).sum() : 0.0;
    const Widening widening{ persistence.stays + 1.0 / n / persistence.independent,
                             (1.0 - persistence.stays) / average.weight,
                             leverage * bin.windows / n / persistence.independent,
                             carried_ ? carriedVariance(bin, signatures_->carried[i], i, static_cast<double>(count)) :
                                        0.0 };
    const double prior = alike[i] > 0.0 && !carried_ ? ALIKE_FREEDOM : 0.0;
    const double usual = (freedom * reference.variance + prior * alike[i]) / (freedom + prior);
    freedoms += freedom;
    compared += 1.0;
    residual_.difference[i] = average.difference;
    const Variance variance = this->variance(i, bin, average, usual, widening);
    const Uncertainty uncertainty =
        uncertaintyOf(variance.learned / variance.all, bin.tail[tailOf(i)], average.weight, freedom + prior);
    deviations[i] = deviationOf(average.difference, expected_[i], std::sqrt(variance.all), uncertainty, threshold_);
    if (i < SCALAR_COUNT)
    {
      scalars += Eigen::Vector3d(1.0, uncertainty.inverse, uncertainty.of_mean);
    }
    if (sound_known)
    {
      const Causes common =
          carried_ ? Causes(Causes::Zero()) : Causes(Eigen::Map<const Causes>(reference.common.data()));
      const double found = static_cast<double>((common.array() != 0.0).count());
      const double spread = std::max(1.0 - common.squaredNorm(), LEAST_LEFT);
      const double left = spread * (n - 1.0 - fitted) / std::max(n - 1.0 - fitted - found, 1.0);
      causes = std::max(causes, found);
      residual_.own[i] = this->variance(i, bin, average, left * usual, widening).all;
      Eigen::Map<Causes>(residual_.common[i].data()) = std::sqrt(usual * (widening.stays + widening.varies)) * common;
    }
  }
  residual_.freedom = compared > 0.0 ? std::max(freedoms / compared - causes, 1.0) : 0.0;
  scalars /= std::max(scalars[0], 1.0);
  const Uncertainty mean{ scalars[1], scalars[2] };
  residual_.pattern_freedom = mean.freedom();
  residual_.pattern_stretch = mean.stretch();
}

double loadStep(const Parameters& parameters) noexcept
{
  return LOAD_STEP * parameters.life.rated_torque;
}
}  // namespace hjt
