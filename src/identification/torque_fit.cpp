// SPDX-License-Identifier: BSD-3-Clause
#include "identification/torque_fit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>
#include <utility>

#include <Eigen/Cholesky>
#include <unsupported/Eigen/FFT>

#include "base/number_text.hpp"
#include "base/statistics.hpp"
#include "elements/motor.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
double correlationRows(const Eigen::VectorXd& residuals)
{
  const Eigen::Index rows = residuals.size();
  Eigen::Index size = 2;
  while (size < 2 * rows)
  {
    size *= 2;
  }
  // Zeros follow the rows, because the Fourier transform would otherwise join the end of the rows to the begin.
  Eigen::VectorXd padded = Eigen::VectorXd::Zero(size);
  padded.head(rows) = residuals;
  Eigen::FFT<double> transform;
  Eigen::VectorXcd spectrum;
  transform.fwd(spectrum, padded);
  spectrum = spectrum.cwiseAbs2().cast<std::complex<double>>();
  Eigen::VectorXd products;  // sums of the products of two rows, by the distance of the rows
  transform.inv(products, spectrum, size);
  double length = 1.0;
  for (Eigen::Index lag = 1; lag < rows / 4 && products[lag] > 0.0; ++lag)
  {
    length += 2.0 * products[lag] / products[0];
  }
  return length;
}

NormalEquations huberEquations(const Eigen::VectorXd& errors, const Eigen::MatrixXd& columns, Eigen::MatrixXd products,
                               double outlier)
{
  const Eigen::VectorXd counted = errors.cwiseMax(-outlier).cwiseMin(outlier);
  for (Eigen::Index i = 0; i < errors.size(); ++i)
  {
    if (counted[i] != errors[i])
    {
      products.noalias() -= columns.row(i).transpose() * columns.row(i);
    }
  }
  return { counted.dot(errors - 0.5 * counted), columns.transpose() * counted, products };
}

Eigen::VectorXd leastCost(const Eigen::VectorXd& start, const Eigen::VectorXd& lowest, const Eigen::VectorXd& highest,
                          const std::function<NormalEquations(const Eigen::VectorXd& values)>& equations)
{
  constexpr int MOST_STEPS = 100;
  constexpr double SMALL = 1e-9;  // least relative decrease of the cost for another step [-]
  Eigen::VectorXd values = start.cwiseMax(lowest).cwiseMin(highest);
  NormalEquations here = equations(values);
  double damping = 1e-4;
  double change = here.cost;
  for (int step = 0; step < MOST_STEPS && std::abs(change) > SMALL * here.cost; ++step)
  {
    for (Eigen::Index i = 0; i < values.size(); ++i)
    {
      // A value stays at its bound if the cost would decrease only beyond the bound.
      if (here.gradient[i] > 0.0 ? values[i] <= lowest[i] : values[i] >= highest[i])
      {
        here.normal.row(i).setZero();
        here.normal.col(i).setZero();
        here.normal(i, i) = 1.0;
        here.gradient[i] = 0.0;
      }
    }
    Eigen::MatrixXd damped = here.normal;
    damped.diagonal() *= 1.0 + damping;
    const Eigen::VectorXd there = (values - damped.ldlt().solve(here.gradient)).cwiseMax(lowest).cwiseMin(highest);
    NormalEquations next = equations(there);
    change = here.cost - next.cost;
    damping *= change > 0.0 ? 0.1 : 10.0;
    if (change > 0.0)
    {
      values = there;
      here = std::move(next);
    }
  }
  return values;
}

Eigen::VectorXd halfWidths(const Eigen::VectorXd& errors, const Eigen::MatrixXd& columns)
{
  const Eigen::VectorXd norm = columns.colwise().norm();
  const Eigen::VectorXd size = norm.unaryExpr([](double length) { return length > 0.0 ? length : 1.0; });
  const Eigen::Index n = columns.cols();
  const Eigen::MatrixXd scaled = columns * size.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd normal = scaled.transpose() * scaled + 1e-12 * Eigen::MatrixXd::Identity(n, n);
  const Eigen::VectorXd inverse = normal.ldlt().solve(Eigen::MatrixXd::Identity(n, n)).diagonal();
  const Eigen::Index asked = (norm.array() > 0.0).count();
  const double variance = errors.squaredNorm() / std::max(1.0, static_cast<double>(errors.size() - asked));
  return (norm.array() > 0.0)
      .select(NORMAL_95 * (variance * correlationRows(errors) * inverse).cwiseSqrt().cwiseQuotient(size), 0.0);
}

namespace
{
constexpr double OUTLIER = 3.0;        // error beyond which a block has less weight, over the standard deviation [-]
constexpr double LEAST_GREASE = 0.05;  // least friction of the grease over the configured one [-]
constexpr double NARROWED = 0.5;  // largest standard deviation of an identified quantity over that of its prior [-]
constexpr Eigen::Index MIN_BLOCKS = 12;
}  // namespace

FrictionFit::FrictionFit(const Parameters& parameters, const FrictionMap& friction,
                         const std::vector<MotionSample>& samples, const std::function<void()>& look)
{
  addBlocks(parameters, friction, samples);
  if (blocks_.rows() < MIN_BLOCKS)
  {
    throw InputError("the joint hardly moves in the part for the identification: " + std::to_string(blocks_.rows()) +
                     " stretches of " + numberText(BLOCK) + " s are faster than " + numberText(MOVING) + " rad/s, " +
                     std::to_string(MIN_BLOCKS) + " are needed");
  }
  setKnown(parameters, friction);
  values_ = start_;
  asked_.fill(true);
  asked_[STRIBECK] = false;
  solve(look);
  for (std::size_t i = 0; i < STRIBECK; ++i)
  {
    if (share(i) > NARROWED)
    {
      refusal_[i] = "the motion hardly shows this quantity: its standard deviation is still " +
                    roundedText(100.0 * share(i), 2) + " % of the prior's";
      asked_[i] = false;
      values_[i] = start_[i];
      half_width_[i] = 0.0;
    }
  }
  solve(look);

  // The result contains the Stribeck term, the overlay does not. With this term, the prediction of wrist_3 in other
  // motions of a recorded arm was 50 % worse.
  const Values found = values_;
  const Values width = half_width_;
  asked_[STRIBECK] = true;
  solve(look);
  const bool is_there = values_[STRIBECK] > half_width_[STRIBECK];
  const double rise = is_there ? values_[STRIBECK] : 0.0;
  const double rise_width = is_there ? half_width_[STRIBECK] : 0.0;
  values_ = found;
  half_width_ = width;
  values_[STRIBECK] = rise;
  half_width_[STRIBECK] = rise_width;
  refusal_[STRIBECK] = is_there ? "" : "its 95 % interval contains zero";
}

/// Sets standard deviations of the prior for a joint of this type. They are 10 % for the gain, 0.03 A for the offset,
/// 50 % for the inertia of the motor, and for each part of the friction 50 % of the whole friction at 1 rad/s of the
/// joint without load.
void FrictionFit::setKnown(const Parameters& parameters, const FrictionMap& friction)
{
  const double inertia = Motor(parameters.motor).inertia();
  const double speed = nominalRatio(parameters.gear);
  const double typical = friction.at(speed, 0.0, parameters.input.temperature).sum();
  const double preload_torque = parameters.bearing.load_factor * parameters.bearing.pitch_diameter;  // [N.m/N]
  const auto set = [&](Quantity quantity, double start, double deviation)
  {
    start_[quantity] = start;
    known_[quantity] = deviation;
  };
  set(GAIN, 1.0 / parameters.telemetry.torque_per_current, 0.1 / parameters.telemetry.torque_per_current);
  set(OFFSET, parameters.telemetry.current_offset, 0.03);
  set(INERTIA, inertia - parameters.telemetry.inertia_in_load, 0.5 * inertia);
  set(PRELOAD, parameters.bearing.race_preload, 0.5 * typical / preload_torque);
  set(GREASE, 1.0, 0.5);
  set(FLANKS, 1.0, 0.5);
  set(VISCOUS, parameters.motor.viscous_friction, 0.5 * typical / speed);
  set(STRIBECK, parameters.motor.stribeck_torque, typical);
}

void FrictionFit::addBlocks(const Parameters& parameters, const FrictionMap& friction,
                            const std::vector<MotionSample>& samples)
{
  const double ratio = nominalRatio(parameters.gear);
  const double preload_torque = parameters.bearing.load_factor * parameters.bearing.pitch_diameter;  // [N.m/N]
  const auto moving = [](const MotionSample& sample) { return std::abs(sample.velocity) > MOVING; };
  const auto add = [&](const MotionSample& sample, double weight, Row& block)
  {
    const double speed = ratio * sample.velocity;
    const double joint = weight * std::copysign(ratio, speed);
    const FrictionShares shares = friction.at(speed, sample.load, sample.temperatureOr(parameters.input.temperature));
    block[QUANTITIES] += weight * sample.current;
    block[GAIN] += weight * (sample.load + sample.vibration) + joint * shares.rest;
    block[OFFSET] += weight;
    block[INERTIA] += weight * ratio * ratio * sample.acceleration;
    block[PRELOAD] += joint * preload_torque;
    block[GREASE] += joint * shares.grease;
    block[FLANKS] += joint * shares.flanks;
    block[VISCOUS] += joint * std::abs(speed);
    block[STRIBECK] += joint * std::exp(-std::pow(speed / parameters.motor.stribeck_velocity, 2));
  };
  std::vector<Row> blocks;
  for (auto from = samples.begin(); from != samples.end();)
  {
    // A block consists of successive rows with motion in one direction, over a time of at most BLOCK.
    auto to = from + 1;
    while (to != samples.end() && !to->after_gap && moving(*to) && to->velocity * from->velocity > 0.0 &&
           to->time < from->time + BLOCK)
    {
      ++to;
    }
    if (moving(*from) && (to - 1)->time > from->time + 0.5 * BLOCK)
    {
      Row block = Row::Zero();
      std::for_each(from, to,
                    [&](const MotionSample& sample) { add(sample, 1.0 / static_cast<double>(to - from), block); });
      blocks.push_back(block);
    }
    from = to;
  }
  blocks_.resize(static_cast<Eigen::Index>(blocks.size()), QUANTITIES + 1);
  for (std::size_t i = 0; i < blocks.size(); ++i)
  {
    blocks_.row(static_cast<Eigen::Index>(i)) = blocks[i];
  }
  products_ = blocks_.transpose() * blocks_;
}

FrictionFit::Row FrictionFit::factors(const Values& values)
{
  Row factors;
  factors << values[GAIN] * values, -1.0;
  factors[GAIN] = values[GAIN];
  factors[OFFSET] = values[OFFSET];
  return factors;
}

/// Derivatives of `factors` with respect to the values.
Eigen::Matrix<double, FrictionFit::QUANTITIES + 1, FrictionFit::QUANTITIES> FrictionFit::slopes(const Values& values)
{
  Eigen::Matrix<double, QUANTITIES + 1, QUANTITIES> slopes = Eigen::Matrix<double, QUANTITIES + 1, QUANTITIES>::Zero();
  slopes.diagonal().setConstant(values[GAIN]);
  slopes.col(GAIN).head<QUANTITIES>() = values;
  slopes.row(OFFSET).setZero();
  slopes(GAIN, GAIN) = slopes(OFFSET, OFFSET) = 1.0;
  return slopes;
}

/// Fits the values. Then estimates standard deviation and correlation of the errors, and repeats the fit with these.
void FrictionFit::solve(const std::function<void()>& look)
{
  double correlation_rows = 1.0;
  Eigen::VectorXd errors = blocks_ * factors(values_);
  constexpr int ROUNDS = 3;
  for (int round = 0; round < ROUNDS; ++round)
  {
    look();
    solveOnce(std::max(robustDeviation(errors), 1e-6), correlation_rows);
    errors = blocks_ * factors(values_);
    correlation_rows = correlationRows(errors);
  }
}

/// @param deviation standard deviation of the blocks' errors, estimated without outliers [A]
void FrictionFit::solveOnce(double deviation, double correlation_rows)
{
  const double weight = 1.0 / (deviation * deviation * correlation_rows);
  const Values prior = known_.cwiseAbs2().cwiseInverse();  // weights of the prior
  Values lowest = values_;
  Values highest = values_;
  for (int i = 0; i < QUANTITIES; ++i)
  {
    if (asked_[i])
    {
      lowest[i] = i == GREASE ? LEAST_GREASE : i >= PRELOAD ? 0.0 : -HUGE_VAL;
      highest[i] = HUGE_VAL;
    }
  }
  values_ = leastCost(values_, lowest, highest,
                      [&](const Values& values)
                      {
                        const auto turned = slopes(values);
                        const Values away = (values - start_).cwiseProduct(prior);
                        NormalEquations data =
                            huberEquations(blocks_ * factors(values), blocks_, products_, OUTLIER * deviation);
                        NormalEquations all;
                        all.cost = weight * data.cost + 0.5 * away.dot(values - start_);
                        all.gradient = weight * turned.transpose() * data.gradient + away;
                        all.normal = weight * turned.transpose() * data.normal * turned;
                        all.normal.diagonal() += prior;
                        return all;
                      });
  // The half widths follow from the information of the prior and of the blocks together.
  Values scale = known_;
  for (int i = 0; i < QUANTITIES; ++i)
  {
    scale[i] *= asked_[i] ? 1.0 : 0.0;
  }
  using Normal = Eigen::Matrix<double, QUANTITIES, QUANTITIES>;
  const Eigen::Matrix<double, QUANTITIES + 1, QUANTITIES> scaled = slopes(values_) * scale.asDiagonal();
  const Normal information = Normal::Identity() + weight * scaled.transpose() * products_ * scaled;
  half_width_ = NORMAL_95 * scale.cwiseProduct(information.ldlt().solve(Normal::Identity()).diagonal().cwiseSqrt());
}

/// Standard deviation after the fit over the standard deviation of the prior [-].
double FrictionFit::share(std::size_t quantity) const
{
  return half_width_[quantity] / (NORMAL_95 * known_[quantity]);
}

namespace
{
constexpr double WIDEST = 0.5;  // largest half width of a line's interval over its amplitude [-]
// Bounds of the fit: resonance of the load [Hz], its damping ratio [-], lag of the ripple behind the angle [s].
const Eigen::Vector3d LOWEST(2.0, 0.05, -0.02);
const Eigen::Vector3d HIGHEST(100.0, 1.0, 0.02);
}  // namespace

RippleFit::RippleFit(std::vector<RippleRow> rows, double period, const TelemetryParameters& start, double ratio,
                     const std::function<void()>& look)
  : rows_(std::move(rows)), orders_(TorqueRipple::orders(ratio)), fastest_(start.ripple_fastest)
{
  std::vector<double> speeds;
  std::transform(rows_.begin(), rows_.end(), std::back_inserter(speeds),
                 [](const RippleRow& row) { return std::abs(row.velocity); });
  if (!speeds.empty())
  {
    const auto fast = speeds.begin() + static_cast<std::ptrdiff_t>(KNOWN * static_cast<double>(speeds.size() - 1));
    std::nth_element(speeds.begin(), fast, speeds.end());
    fastest_ = std::min(*fast, M_PI / (period * orders_[1]) * (1.0 - 1e-12));
    rows_.erase(std::remove_if(rows_.begin(), rows_.end(),
                               [&](const RippleRow& row) { return std::abs(row.velocity) > fastest_; }),
                rows_.end());
  }
  torque_.resize(static_cast<Eigen::Index>(rows_.size()));
  std::transform(rows_.begin(), rows_.end(), torque_.data(), [](const RippleRow& row) { return row.torque; });
  for (std::size_t i = 0; i < TorqueRipple::LINES; ++i)
  {
    present_[i] = orders_[i] * fastest_ * period <= M_PI;
    refusal_[i] = present_[i] ? "" : "the sampling period is too long for this line";
  }
  values_.tail<3>() << start.ripple_resonance, start.ripple_damping, start.ripple_lag;
  const Values configured = values_;
  chooseResonance(look);
  while (anyLine())
  {
    look();
    solve();
    if (!refuseWorst())
    {
      break;
    }
  }
  if (!anyLine())
  {
    values_ = configured;
  }
}

bool RippleFit::anyLine() const
{
  return std::any_of(present_.begin(), present_.end(), [](bool present) { return present; });
}

/// Real and imaginary part of each line of TorqueRipple in each row, for amplitude 1; 0 for a refused line.
Eigen::MatrixXd RippleFit::waves(const double* response) const
{
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(torque_.size(), RESONANCE);
  for (Eigen::Index i = 0; i < torque_.size(); ++i)
  {
    const RippleRow& row = rows_[i];
    const TorqueRipple::Waves felt = TorqueRipple::waves(orders_, row.position, row.velocity, response);
    for (std::size_t k = 0; k < felt.size(); ++k)
    {
      columns(i, 2 * k) = present_[k] ? felt[k].real() : 0.0;
      columns(i, 2 * k + 1) = present_[k] ? felt[k].imag() : 0.0;
    }
  }
  return columns;
}

/// Derivative of the ripple torque in each row with respect to each value.
Eigen::MatrixXd RippleFit::slopes(const Values& values) const
{
  const double* response = values.data() + RESONANCE;
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(torque_.size(), VALUES);
  slopes.leftCols(RESONANCE) = waves(response);
  for (Eigen::Index i = 0; i < torque_.size(); ++i)
  {
    for (std::size_t k = 0; k < orders_.size(); ++k)
    {
      const double w = orders_[k] * rows_[i].velocity;
      const std::complex<double> torque = std::complex<double>(values[2 * k], -values[2 * k + 1]) *
                                          std::complex<double>(slopes(i, 2 * k), slopes(i, 2 * k + 1));
      const std::complex<double> in_stiffness = -torque / TorqueRipple::stiffness(w, response);
      const double natural = TWO_PI * response[0];
      slopes(i, RESONANCE) +=
          TWO_PI * (in_stiffness * std::complex<double>(2.0 * natural, 2.0 * response[1] * w)).real();
      slopes(i, RESONANCE + 1) -= 2.0 * natural * w * in_stiffness.imag();
      slopes(i, RESONANCE + 2) += w * torque.imag();
    }
  }
  return slopes;
}

/// Chooses start values of resonance, damping and lag: the best point of a coarse grid. At each point of the grid, the
/// lines are fitted linearly.
void RippleFit::chooseResonance(const std::function<void()>& look)
{
  double most = -1.0;
  for (const double resonance : { 5.0, 8.0, 12.0, 16.0, 20.0, 25.0, 32.0, 45.0 })
  {
    for (const double damping : { 0.1, 0.3, 0.6 })
    {
      look();
      for (const double lag : { -0.004, 0.0, 0.004, 0.008, 0.012 })
      {
        const Eigen::Vector3d response(resonance, damping, lag);
        const Eigen::MatrixXd columns = waves(response.data());
        const Eigen::VectorXd right = columns.transpose() * torque_;
        Eigen::MatrixXd normal = columns.transpose() * columns;
        normal.diagonal().array() += 1e-9;
        const Eigen::VectorXd lines = normal.ldlt().solve(right);
        if (lines.dot(right) > most)
        {
          most = lines.dot(right);
          values_ << lines, response;
        }
      }
    }
  }
}

void RippleFit::solve()
{
  Values lowest = Values::Constant(-HUGE_VAL);
  Values highest = Values::Constant(HUGE_VAL);
  lowest.tail<3>() = LOWEST;
  highest.tail<3>() = HIGHEST;
  const double outlier = 2.0 * torque_.norm() / std::sqrt(static_cast<double>(torque_.size())) + 1e-9;
  const auto errors = [&](const Eigen::MatrixXd& columns, const Values& values) -> Eigen::VectorXd
  { return columns.leftCols(RESONANCE) * values.head<RESONANCE>() - torque_; };
  values_ = leastCost(values_, lowest, highest,
                      [&](const Values& values)
                      {
                        const Eigen::MatrixXd columns = slopes(values);
                        return huberEquations(errors(columns, values), columns, columns.transpose() * columns, outlier);
                      });
  const Eigen::MatrixXd columns = slopes(values_);
  half_width_ = halfWidths(errors(columns, values_), columns);
}

/// Refuses the line with the widest interval, if wider than WIDEST. @returns whether the others need another fit.
bool RippleFit::refuseWorst()
{
  double worst = WIDEST;
  std::size_t line = TorqueRipple::LINES;
  for (std::size_t i = 0; i < TorqueRipple::LINES; ++i)
  {
    const double share = present_[i] ? halfWidth(i) / std::max(amplitude(i), 1e-12) : 0.0;
    if (share > worst)
    {
      worst = share;
      line = i;
    }
  }
  if (line == TorqueRipple::LINES)
  {
    return false;
  }
  refusal_[line] = "below the residual";
  present_[line] = false;
  values_.segment<2>(2 * line).setZero();
  half_width_.segment<2>(2 * line).setZero();
  return true;
}

double RippleFit::amplitude(std::size_t line) const
{
  return std::hypot(values_[2 * line], values_[2 * line + 1]);
}

double RippleFit::halfWidth(std::size_t line) const
{
  return std::max(half_width_[2 * line], half_width_[2 * line + 1]);
}

double RippleFit::phase(std::size_t line) const
{
  return std::atan2(-values_[2 * line + 1], values_[2 * line]);
}

void RippleFit::store(TelemetryParameters& p) const
{
  Eigen::Index at = 0;
  for (auto* line :
       { &p.ripple_circular_spline_2, &p.ripple_flexspline_2, &p.ripple_circular_spline_4, &p.ripple_flexspline_4 })
  {
    *line = { values_[at], values_[at + 1] };
    at += 2;
  }
  p.ripple_resonance = values_[RESONANCE];
  p.ripple_damping = values_[RESONANCE + 1];
  p.ripple_lag = values_[RESONANCE + 2];
  p.ripple_fastest = fastest_;
}
}  // namespace hjt
