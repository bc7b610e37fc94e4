// SPDX-License-Identifier: BSD-3-Clause
#include "health/reference_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <boost/math/distributions/normal.hpp>

#include "gear/ratio.hpp"
#include "health/indicator_table.hpp"

namespace hjt
{
namespace
{
constexpr double CARRIED_WINDOWS = 10.0;  // number of windows in each mean that CarriedError was fitted to
constexpr double LEAST_INVERSE = 1e-6;    // least 1 / degrees of freedom, at which a distribution is practically normal
constexpr int MIN_COMMON = 4;             // least number of indicators for a CommonPersistence

// Repeatability of the friction, divided by Repeatability::share.
constexpr double FRICTION_SHARE = 3.0;    // part in proportion to the friction [-]
constexpr double FRICTION_TORQUE = 22.0;  // constant part at the joint [N.m]

/// Magnitude of an indicator's difference between drive and twin. For a line it is the root of the sum of squares over
/// all phase-locked lines of a signal, because resonances make a line large in one motion and small in another motion.
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

/// Standard error of the share of the variance that persists from window to window (von Neumann 1941).
double errorOfStay(const ReferenceBin& bin, const Reference& reference) noexcept
{
  return 1.0 / std::sqrt(std::max(reference.count - bin.runs, 1));
}
}  // namespace

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

double normalQuantile(double share)
{
  return boost::math::quantile(boost::math::complement(boost::math::normal(), share));
}

Repeatability repeatabilityOf(const Parameters& parameters)
{
  const double share = parameters.indicators.least_spread;
  return { share, FRICTION_SHARE * share, FRICTION_TORQUE * share / nominalRatio(parameters.gear) };
}

double repeatsWithin(const Repeatability& repeatability, const ReferenceBin& bin, std::size_t indicator) noexcept
{
  const double own = bin.references[amplitudeOf(indicator)].scale;  // amplitude, because a line's part may be near zero
  const auto friction = [&](double torque)
  { return std::hypot(repeatability.friction_share * torque, repeatability.friction_torque); };
  switch (static_cast<ScalarIndicator>(indicator))
  {
    case ScalarIndicator::RUNNING_TORQUE:
    case ScalarIndicator::COULOMB_TORQUE:
      return friction(own);
    case ScalarIndicator::LOAD_FRICTION:
      return repeatability.friction_share * own;
    case ScalarIndicator::VISCOUS_FRICTION:
    {
      const double speed = std::exp2(bin.bin.speed + 0.5);  // middle of the octave [rad/s]
      return friction(bin.references[indexOf(ScalarIndicator::RUNNING_TORQUE)].scale) / speed;
    }
    default:
      return repeatability.share * own;
  }
}

CommonPersistence commonPersistence(const ReferenceBin& bin, std::size_t kind) noexcept
{
  CommonPersistence common;
  double sum = 0.0;
  double square = 0.0;
  double errors = 0.0;
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    const Reference& reference = bin.references[i];
    if (tailOf(i) == kind && reference.within > 0.0 && reference.variance > 0.0)
    {
      const double found = 1.0 - reference.within / reference.variance;
      const double error = errorOfStay(bin, reference);
      sum += found;
      square += found * found;
      errors += error * error;
      ++common.count;
    }
  }
  if (common.count >= MIN_COMMON)
  {
    common.mean = sum / common.count;
    common.variance = std::max((square - sum * common.mean) / (common.count - 1) - errors / common.count, 0.0);
  }
  return common;
}

Persistence persistenceOf(const ReferenceBin& bin, const Reference& reference, const CommonPersistence& common) noexcept
{
  if (!(reference.within > 0.0 && reference.variance > 0.0))
  {
    return { 1.0, 1.0 };
  }
  double stays = 1.0 - reference.within / reference.variance;
  double error = errorOfStay(bin, reference);
  if (common.count >= MIN_COMMON)
  {
    const double all = common.variance + error * error;
    const double own = common.variance / all;
    stays = common.mean + own * (stays - common.mean);
    error = std::sqrt(own * error * error + (1.0 - own) * (1.0 - own) * all / common.count);
  }
  // The share that persists may be larger or smaller than the estimate by the standard error.
  const double least = std::clamp(stays - error, 0.0, 1.0);
  const double runs = static_cast<double>(bin.runs) / bin.windows;
  return { std::clamp(stays + error, 0.0, 1.0), std::max((1.0 - least) / (1.0 + least), std::min(runs, 1.0)) };
}

double carriedVariance(const ReferenceBin& bin, const CarriedError& error, std::size_t indicator,
                       double windows) noexcept
{
  const double off = error.share * sizeOffModel(bin, indicator);
  // With fewer windows than CARRIED_WINDOWS the variance grows in inverse proportion to their number, as that of noise.
  return (error.deviation * error.deviation + off * off) * std::max(CARRIED_WINDOWS / windows, 1.0);
}

double excessOf(double tail) noexcept
{
  return tail / (1.0 - 4.0 * std::min(tail, MOST_TAIL));
}

double Uncertainty::freedom() const noexcept
{
  return 1.0 / std::clamp(inverse, LEAST_INVERSE, 1.0);
}

double Uncertainty::stretch() const noexcept
{
  return 1.0 / std::sqrt(1.0 - 2.0 * of_mean);
}

Uncertainty uncertaintyOf(double learned, double tail, double weight, double freedom) noexcept
{
  const double of_mean = learned * learned * tail / weight;
  return { learned * learned * (1.0 + 3.0 * excessOf(tail)) / freedom + of_mean, of_mean };
}

namespace
{
constexpr double LEAST_OTHERS = 0.05;  // lower bound of 1 - leverage of a window in its own fit [-]
constexpr double TAIL_STEP = 0.01;     // step of 1 / degrees of freedom
// Least gain of log likelihood by a tail over the normal distribution: half the 95 % quantile of chi square with one
// degree of freedom. Without a tail, chance gives a larger gain in 5 % of all cases.
constexpr double LEAST_GAIN = 1.92;

/// Whether the tail can be estimated from an indicator. Kurtosis and crest of the residual and amplitudes of lines with
/// a free phase do not show the tail, because they are not normally distributed even if there is no tail.
bool tellsTail(std::size_t indicator) noexcept
{
  return indicator != indexOf(ScalarIndicator::RESIDUAL_KURTOSIS) &&
         indicator != indexOf(ScalarIndicator::RESIDUAL_CREST) && !isFreeAmplitude(indicator);
}

/// Histogram, with logarithmic classes, of the deviation of a window from all other windows over their spread.
struct Residuals
{
  static constexpr std::size_t CLASSES = 48;
  static constexpr double LEAST = 0.1;
  static constexpr double PER_UNIT = 6.0;  // number of classes for a unit of the natural logarithm

  void add(double off, double with_freedom) noexcept
  {
    const double place = PER_UNIT * std::log(std::max(std::abs(off) / LEAST, 1.0));
    counts[static_cast<std::size_t>(std::min(place, CLASSES - 1.0))] += 1.0;
    freedom += with_freedom;
    count += 1.0;
  }

  /// Logarithm of the likelihood of the deviations if single windows have the tail `tail`.
  double likelihood(double tail) const noexcept
  {
    const double inverse = tail + (1.0 + 3.0 * excessOf(tail)) * count / freedom;
    const double v = 1.0 / inverse;
    const double stretch = 1.0 / std::sqrt(1.0 - 2.0 * tail);
    double sum = count * (std::lgamma(0.5 * (v + 1.0)) - std::lgamma(0.5 * v) - 0.5 * std::log(v) + std::log(stretch));
    for (std::size_t i = 0; i < CLASSES; ++i)
    {
      const double off = stretch * LEAST * std::exp((static_cast<double>(i) + 0.5) / PER_UNIT);
      sum -= counts[i] * 0.5 * (v + 1.0) * std::log1p(off * off / v);
    }
    return sum;
  }

  std::array<double, CLASSES> counts{};
  double freedom{};
  double count{};
};

/// Sets ReferenceBin::tail after the fit of the slopes, by maximum likelihood. The data are the deviations of each of
/// the KeptWindows from all other windows, with the distribution of single windows' scores (Baseline). For normally
/// distributed windows the tail is 0 to 0.01.
void fitTails(ReferenceBin& bin, const LearnedSums& sums) noexcept
{
  const Eigen::SelfAdjointEigenSolver<Squares> axes(mapped(bin.information));
  const KeptWindows& kept = sums.kept;
  std::array<Residuals, TAILS> residuals;
  for (std::size_t window = 0; window < kept.count; ++window)
  {
    const PlaceVector place = mapped(kept.places[window]) - mapped(bin.mean_place);
    const PlaceVector along = (axes.eigenvectors().transpose() * place).array().square();
    for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
    {
      const Reference& reference = bin.references[i];
      const double freedom = bin.windows - 1.0 - reference.slopes_freedom;
      if (!tellsTail(i) || reference.count != bin.windows || !(reference.variance > 0.0) || freedom < 3.0)
      {
        continue;
      }
      const double off =
          static_cast<double>(kept.values[window][i]) - reference.mean - place.dot(mapped(reference.slopes));
      const double own =
          1.0 / bin.windows +
          (reference.fitted ? (along.array() / (axes.eigenvalues().array().max(0.0) + reference.ridge)).sum() : 0.0);
      const double square = off * off / std::max(1.0 - own, LEAST_OTHERS);
      const double others = (freedom * reference.variance - square) / (freedom - 1.0);
      if (others > 0.0)
      {
        residuals[tailOf(i)].add(std::sqrt(square / others), freedom - 1.0);
      }
    }
  }
  for (std::size_t kind = 0; kind < TAILS; ++kind)
  {
    bin.tail[kind] = 0.0;
    double most = residuals[kind].count > 0.0 ? residuals[kind].likelihood(0.0) + LEAST_GAIN : HUGE_VAL;
    for (double tail = TAIL_STEP; tail <= MOST_TAIL; tail += TAIL_STEP)
    {
      if (const double likelihood = residuals[kind].likelihood(tail); likelihood > most)
      {
        most = likelihood;
        bin.tail[kind] = tail;
      }
    }
  }
}

constexpr int MIN_FITTED = 4;  // least number of windows for slopes
constexpr int RIDGE_STEPS = 4;
constexpr double LEAST_FREEDOM = 1.0;  // least degrees of freedom of a spread
constexpr int MIN_STEPS = 8;           // least number of pairs of successive windows for Reference::within
// Rms error of a covariate [-]: 0.025 K, or 0.25 % of the width of a class of load. Closer values count as equal.
constexpr double PLACE_ERROR = 0.005;
constexpr int MIN_ALIKE = 4;    // least number of similar lines for varianceOfAlike
constexpr int ITERATIONS = 30;  // power iterations for a principal component

/// Adds the products of an indicator's difference `indicator` and the covariates' difference `place` to the sums.
void add(double indicator, const PlaceVector& place, double weight, IndicatorSums& sums) noexcept
{
  ++sums.count;
  sums.square += weight * indicator * indicator;
  mapped(sums.mixed) += weight * indicator * place;
  mapped(sums.places).noalias() += weight * place * place.transpose();
}

/// Sum of squares of the indicator that the regression with the slopes `slopes` does not explain.
double squareLeft(const IndicatorSums& sums, const PlaceVector& slopes) noexcept
{
  return sums.square + slopes.dot(mapped(sums.places) * slopes - 2.0 * mapped(sums.mixed));
}

constexpr int OWN = OWN_PLACES;
constexpr int SHARED = PLACES - OWN_PLACES;
using SharedSquares = Eigen::Matrix<double, SHARED, SHARED>;
using SharedVector = Eigen::Matrix<double, SHARED, 1>;

/// Covariates whose slopes all classes share, minus their regression on the covariates with a slope for each class.
struct SharedPlaces
{
  SharedPlaces(const PlaceSquares& places, int windows) noexcept
  {
    const Squares whole = mapped(places);
    Eigen::Matrix<double, OWN, OWN> own = whole.topLeftCorner<OWN, OWN>();
    own.diagonal().array() += windows * PLACE_ERROR * PLACE_ERROR;
    by_own.noalias() = own.inverse() * whole.topRightCorner<OWN, SHARED>();
    squares = whole.bottomRightCorner<SHARED, SHARED>() - whole.bottomLeftCorner<SHARED, OWN>() * by_own;
  }

  SharedVector mixed(const Place& with) const noexcept
  {
    return mapped(with).tail<SHARED>() - by_own.transpose() * mapped(with).head<OWN>();
  }

  Eigen::Matrix<double, OWN, SHARED> by_own;  // slopes of the regression
  SharedSquares squares;
};

/// Whether the class `other` differs from the class `bin` in temperature alone.
bool serves(const ReferenceBin& other, const ReferenceBin& bin) noexcept
{
  OperatingBin there = other.bin;
  there.temperature = bin.bin.temperature;
  return there == bin.bin && other.bin.temperature != bin.bin.temperature;
}

/// Sets ReferenceBin::information, the information on the slopes in this class, from the windows of all classes.
void fitInformation(ReferenceBin& bin, const LearnedSums& sums, const std::vector<ReferenceBin>& bins,
                    const std::vector<LearnedSums>& all_sums) noexcept
{
  bin.information = sums.windows.places;
  for (std::size_t i = 0; i < bins.size(); ++i)
  {
    if (serves(bins[i], bin))
    {
      mapped(bin.information).bottomRightCorner<SHARED, SHARED>() +=
          SharedPlaces(all_sums[i].windows.places, bins[i].windows).squares;
    }
  }
}

void fitSlopes(ReferenceBin& bin, const LearnedSums& learned, const std::vector<ReferenceBin>& bins,
               const std::vector<LearnedSums>& all_sums, const Repeatability& repeatability,
               std::size_t indicator) noexcept
{
  Reference& reference = bin.references[indicator];
  const IndicatorSums& sums = learned.windows.by_indicator[indicator];
  const IndicatorSums& steps = learned.steps.by_indicator[indicator];
  const double usual = SLOPE_SHARE * bin.references[amplitudeOf(indicator)].scale;
  PlaceVector slopes = PlaceVector::Zero();
  reference.fitted = sums.count >= MIN_FITTED && sums.square > 0.0 && usual > 0.0;
  if (reference.fitted)
  {
    Squares information = mapped(sums.places);
    PlaceVector mixed = mapped(sums.mixed);
    for (std::size_t i = 0; i < bins.size(); ++i)
    {
      const IndicatorSums& others = all_sums[i].windows.by_indicator[indicator];
      if (serves(bins[i], bin) && others.count >= MIN_FITTED)
      {
        const SharedPlaces places(others.places, others.count);
        information.bottomRightCorner<SHARED, SHARED>() += places.squares;
        mixed.tail<SHARED>() += places.mixed(others.mixed);
      }
    }
    const double repeats = repeatsWithin(repeatability, bin, indicator);
    reference.variance = sums.square / (sums.count - 1.0);
    for (int i = 0; i < RIDGE_STEPS; ++i)  // iterates, because the ridge depends on the spread that the slopes leave
    {
      reference.ridge = std::max((reference.variance + repeats * repeats) / (usual * usual), PLACE_ERROR * PLACE_ERROR);
      Squares ridged = information;
      ridged.diagonal().array() += reference.ridge;
      const Eigen::LDLT<Squares> solver(ridged);
      slopes = solver.solve(mixed);
      const Squares own = solver.solve(mapped(sums.places));
      reference.slopes_freedom = (2.0 * own - solver.solve(information) * own).trace();
      reference.variance = std::max(squareLeft(sums, slopes), 0.0) /
                           std::max(sums.count - 1.0 - reference.slopes_freedom, LEAST_FREEDOM);
    }
    reference.mean = learned.windows.means[indicator] +
                     slopes.dot(mapped(bin.mean_place) - mapped(learned.windows.mean_places[indicator]));
  }
  mapped(reference.slopes) = slopes;
  // The mean of `within` over independent windows is the variance, and chance makes `within` smaller or larger. The
  // upper bound is therefore twice the variance: a bound at the variance would bias the mean over many indicators.
  reference.within = steps.count >= MIN_STEPS && reference.variance > 0.0 ?
                         std::clamp(0.5 * squareLeft(steps, slopes) / steps.count, LEAST_LEFT * reference.variance,
                                    2.0 * reference.variance) :
                         0.0;
}

constexpr std::size_t KINDS_OF_LINE = 2 * LINE_SIGNALS + 1;

/// Kind of similar lines: amplitudes of one signal with a free phase, parts of phase-locked lines of one signal, or
/// parts of lines in proportion to the load. KINDS_OF_LINE: the indicator has no similar line.
std::size_t kindOfLine(std::size_t indicator) noexcept
{
  if (indicator < SCALAR_COUNT || (indicator >= LOADED_BLOCK && indicator < LOADED_BLOCK + LOADED_COUNT))
  {
    return KINDS_OF_LINE;
  }
  if (indicator >= LOADED_BLOCK)
  {
    return 2 * LINE_SIGNALS;
  }
  const std::size_t signal = (indicator - SCALAR_COUNT) / LINE_BLOCK;
  const bool is_part = (indicator - SCALAR_COUNT) % LINE_BLOCK >= FIRST_LOADED;
  return isFreeAmplitude(indicator) ? signal : is_part ? LINE_SIGNALS + signal : KINDS_OF_LINE;
}

/// Fits the common causes of the indicators that every window determined.
void fitCommonCauses(ReferenceBin& bin, const ReferenceSums& sums, FitRoom& room) noexcept
{
  using Vector = Eigen::Matrix<double, INDICATOR_COUNT, 1>;
  using Square = Eigen::Matrix<double, INDICATOR_COUNT, INDICATOR_COUNT, Eigen::RowMajor>;
  using Mixed = Eigen::Matrix<double, PLACES, INDICATOR_COUNT>;
  Mixed slopes = Mixed::Zero();
  Mixed mixed = Mixed::Zero();
  Vector scale = Vector::Zero();  // factor that gives each indicator a sum of squares of 1; 0: not used
  int used = 0;
  double slopes_freedom = 0.0;
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    Reference& reference = bin.references[i];
    reference.common = {};
    if (reference.fitted && reference.count == bin.windows && reference.variance > 0.0)
    {
      const auto column = static_cast<Eigen::Index>(i);
      slopes.col(column) = mapped(reference.slopes);
      mixed.col(column) = mapped(sums.by_indicator[i].mixed);
      scale[column] = 1.0 / std::sqrt(squareLeft(sums.by_indicator[i], slopes.col(column)));
      ++used;
      slopes_freedom += reference.slopes_freedom;
    }
  }
  mixed -= 0.5 * mapped(sums.places) * slopes;
  Eigen::Map<Square> left(room.correlations.data());
  std::size_t pair = 0;
  for (Eigen::Index i = 0; i < left.rows(); ++i)
  {
    for (Eigen::Index j = 0; j <= i; ++j)
    {
      left(i, j) = left(j, i) = sums.indicators[pair++];
    }
  }
  left.noalias() -= slopes.transpose() * mixed;
  left.noalias() -= mixed.transpose() * slopes;
  left = scale.asDiagonal() * left * scale.asDiagonal();
  const double left_freedom = bin.windows - 1.0 - (used > 0 ? slopes_freedom / used : 0.0);
  const double edge = std::pow(1.0 + std::sqrt(used / std::max(left_freedom, LEAST_FREEDOM)), 2);
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
    left.noalias() -= size * direction * direction.transpose();
    for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
    {
      bin.references[i].common[cause] = std::sqrt(size) * direction[static_cast<Eigen::Index>(i)];
    }
  }
}
}  // namespace

std::array<double, INDICATOR_COUNT> varianceOfAlike(const ReferenceBin& bin) noexcept
{
  std::array<double, KINDS_OF_LINE + 1> sums{};
  std::array<int, KINDS_OF_LINE + 1> counts{};
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    const Reference& reference = bin.references[i];
    const double freedom = reference.count - 1.0 - reference.slopes_freedom;
    if (freedom >= 1.0 && reference.variance > 0.0 && reference.relative_square > 0.0)
    {
      sums[kindOfLine(i)] +=
          std::log(reference.variance / reference.relative_square) + (1.0 + 1.0 / (3.0 * freedom)) / freedom;
      ++counts[kindOfLine(i)];
    }
  }
  std::array<double, INDICATOR_COUNT> variance{};
  for (std::size_t i = SCALAR_COUNT; i < INDICATOR_COUNT; ++i)
  {
    const std::size_t kind = kindOfLine(i);
    if (kind != KINDS_OF_LINE && counts[kind] >= MIN_ALIKE)
    {
      variance[i] = bin.references[i].relative_square * std::exp(sums[kind] / counts[kind]);
    }
  }
  return variance;
}

std::array<double, INDICATOR_COUNT> relativeErrors(const SignalIndicators& indicators) noexcept
{
  std::array<double, LINE_SIGNALS> least{};
  least.fill(HUGE_VAL);
  for (std::size_t i = SCALAR_COUNT; i < LOADED_BLOCK; ++i)
  {
    double& of_signal = least[static_cast<std::size_t>(signalOf(i))];
    of_signal = indicators.uncertainty[i] > 0.0 ? std::min(of_signal, indicators.uncertainty[i]) : of_signal;
  }
  std::array<double, INDICATOR_COUNT> relative{};
  for (std::size_t i = SCALAR_COUNT; i < INDICATOR_COUNT; ++i)
  {
    const double error = indicators.uncertainty[i];  // can be NaN in a file of another program
    relative[i] = error > 0.0 ? error / least[static_cast<std::size_t>(signalOf(i))] : 0.0;
  }
  return relative;
}

void learnWindow(ReferenceBin& bin, LearnedSums& learned, const SignalIndicators& indicators,
                 const SignalIndicators* model, const Place& here) noexcept
{
  ++bin.windows;
  ReferenceSums& sums = learned.windows;
  StepSums& steps = learned.steps;
  const bool follows = bin.windows > 1 && indicators.windows == steps.last_window + 1;
  bin.runs += follows ? 0 : 1;
  const double weight = (bin.windows - 1.0) / bin.windows;
  const PlaceVector place = mapped(here) - mapped(bin.mean_place);
  mapped(bin.mean_place) += place / bin.windows;
  mapped(sums.places).noalias() += weight * place * place.transpose();
  const PlaceVector moved = mapped(here) - mapped(steps.last_place);
  const std::array<double, INDICATOR_COUNT> errors = relativeErrors(indicators);
  std::array<double, INDICATOR_COUNT> before{};  // differences from the means of the earlier windows
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    if (!std::isfinite(indicators.values[i]))
    {
      continue;
    }
    before[i] = indicators.values[i] - sums.means[i];
    const PlaceVector own_place = mapped(here) - mapped(sums.mean_places[i]);
    const double count = sums.by_indicator[i].count + 1.0;
    sums.means[i] += before[i] / count;
    mapped(sums.mean_places[i]) += own_place / count;
    add(before[i], own_place, (count - 1.0) / count, sums.by_indicator[i]);
    bin.references[i].count = sums.by_indicator[i].count;
    bin.references[i].mean = sums.means[i];
    bin.references[i].variance = sums.by_indicator[i].square / std::max(count - 1.0, 1.0);
    const double whole =
        indicators.values[i] + (model != nullptr && std::isfinite(model->values[i]) ? model->values[i] : 0.0);
    bin.references[i].scale += (std::abs(whole) - bin.references[i].scale) / count;
    if (const double error = errors[i]; error > 0.0)
    {
      double& square = bin.references[i].relative_square;
      square += (error * error - square) / (square > 0.0 ? count : 1.0);
    }
    if (follows && std::isfinite(steps.last[i]))
    {
      add(indicators.values[i] - steps.last[i], moved, 1.0, steps.by_indicator[i]);
    }
  }
  if (KeptWindows& kept = learned.kept; kept.count < KeptWindows::MOST)
  {
    kept.places[kept.count] = here;
    std::transform(indicators.values.begin(), indicators.values.end(), kept.values[kept.count].begin(),
                   [](double value) { return static_cast<float>(value); });
    ++kept.count;
  }
  std::size_t pair = 0;
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    for (std::size_t j = 0; j <= i; ++j)
    {
      sums.indicators[pair++] += weight * before[i] * before[j];
    }
  }
  steps.last_window = indicators.windows;
  steps.last = indicators.values;
  steps.last_place = here;
}

void fitReference(ReferenceBin& bin, const LearnedSums& sums, const std::vector<ReferenceBin>& bins,
                  const std::vector<LearnedSums>& all_sums, const Repeatability& repeatability, FitRoom& room) noexcept
{
  fitInformation(bin, sums, bins, all_sums);
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    fitSlopes(bin, sums, bins, all_sums, repeatability, i);
  }
  fitTails(bin, sums);
  fitCommonCauses(bin, sums.windows, room);
}
}  // namespace hjt
