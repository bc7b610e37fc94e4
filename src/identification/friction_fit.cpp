// SPDX-License-Identifier: BSD-3-Clause
#include "identification/friction_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "arm/residual_statistics.hpp"
#include "base/number_text.hpp"
#include "elements/motor.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "identification/regression.hpp"

namespace hjt
{
namespace
{
constexpr double OUTLIER = 3.0;        // blocks that many deviations off count less
constexpr double LEAST_GREASE = 0.05;  // least share of the configured viscosity
constexpr double NARROWED = 0.5;       // deviation after the motion over that before
constexpr Eigen::Index MIN_BLOCKS = 12;
}  // namespace

FrictionFit::FrictionFit(const Parameters& parameters, const FrictionMap& friction,
                         const std::vector<MotionSample>& samples, const std::function<void()>& look)
{
  addBlocks(parameters, friction, samples);
  if (blocks_.rows() < MIN_BLOCKS)
  {
    throw InputError("the joint hardly moves in the part to identify on: " + std::to_string(blocks_.rows()) +
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
      refusal_[i] = "the motion narrows what was known before to " + roundedText(100.0 * share(i), 2) + " % only";
      asked_[i] = false;
      values_[i] = start_[i];
      half_width_[i] = 0.0;
    }
  }
  solve(look);

  // Reported beside the result, not used: on other motions of a recorded arm it made wrist_3 worse by a half.
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
  refusal_[STRIBECK] = is_there ? "" : "its 95 % interval holds zero";
}

/// Sets the prior, a joint of this type: gain within 10 %; offset 0.03 A; the motor's inertia within
/// half of it; parts of its friction within half of all friction at 1 rad/s of the joint and without load.
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
    // As many rows as follow each other, move one way and fit into a block.
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

/// Of the factors in the values.
Eigen::Matrix<double, FrictionFit::QUANTITIES + 1, FrictionFit::QUANTITIES> FrictionFit::slopes(const Values& values)
{
  Eigen::Matrix<double, QUANTITIES + 1, QUANTITIES> slopes = Eigen::Matrix<double, QUANTITIES + 1, QUANTITIES>::Zero();
  slopes.diagonal().setConstant(values[GAIN]);
  slopes.col(GAIN).head<QUANTITIES>() = values;
  slopes.row(OFFSET).setZero();
  slopes(GAIN, GAIN) = slopes(OFFSET, OFFSET) = 1.0;
  return slopes;
}

/// The values, then their deviation and correlation, by which they are fitted again.
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

/// @param deviation of the blocks, outliers left out [A]
void FrictionFit::solveOnce(double deviation, double correlation_rows)
{
  const double weight = 1.0 / (deviation * deviation * correlation_rows);
  const Values prior = known_.cwiseAbs2().cwiseInverse();  // its weight
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
  // From what was known before and what the blocks say of it, each with this weight.
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

/// Of the deviation before that is left after the motion.
double FrictionFit::share(std::size_t quantity) const
{
  return half_width_[quantity] / (NORMAL_95 * known_[quantity]);
}
}  // namespace hjt
