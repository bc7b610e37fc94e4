// SPDX-License-Identifier: BSD-3-Clause
#include "identification/friction_fit.hpp"

#include <algorithm>
#include <cmath>

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>
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
constexpr std::size_t MIN_BLOCKS = 12;
constexpr std::size_t MAX_BLOCKS = 20000;  // a longer recording is thinned out

bool isFriction(std::size_t quantity)
{
  return quantity >= FrictionFit::PRELOAD;
}
}  // namespace

/// Residual of one block; each value is a parameter block.
struct FrictionFit::Residual
{
  const Block& block;

  template <class T>
  bool operator()(T const* const* values, T* residual) const
  {
    T torque(block.known);
    for (std::size_t i = INERTIA; i < QUANTITIES; ++i)
    {
      torque += *values[i] * block.column[i];
    }
    residual[0] = *values[GAIN] * torque + *values[OFFSET] - block.current;
    return true;
  }
};

FrictionFit::FrictionFit(const Parameters& parameters, const FrictionMap& friction,
                         const std::vector<MotionSample>& samples, const std::function<void()>& look)
{
  addBlocks(parameters, friction, samples);
  if (blocks_.size() < MIN_BLOCKS)
  {
    throw InputError("the joint hardly moves in the part to identify on: " + std::to_string(blocks_.size()) +
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
      refusal_[i] = "the motion narrows what was known before to " + percentText(share(i)) + " only";
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
  const auto add = [&](const MotionSample& sample, double weight, Block& block)
  {
    const double speed = ratio * sample.velocity;
    const double joint = weight * std::copysign(ratio, speed);
    const FrictionShares shares = friction.at(speed, sample.load, sample.temperatureOr(parameters.input.temperature));
    block.current += weight * sample.current;
    block.known += weight * (sample.load + sample.vibration) + joint * shares.rest;
    block.column[INERTIA] += weight * ratio * ratio * sample.acceleration;
    block.column[PRELOAD] += joint * preload_torque;
    block.column[GREASE] += joint * shares.grease;
    block.column[FLANKS] += joint * shares.flanks;
    block.column[VISCOUS] += joint * std::abs(speed);
    block.column[STRIBECK] += joint * std::exp(-std::pow(speed / parameters.motor.stribeck_velocity, 2));
  };
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
      Block block{};
      std::for_each(from, to,
                    [&](const MotionSample& sample) { add(sample, 1.0 / static_cast<double>(to - from), block); });
      blocks_.push_back(block);
    }
    from = to;
  }
  const std::size_t stride = blocks_.size() / MAX_BLOCKS + 1;
  for (std::size_t i = 1; stride * i < blocks_.size(); ++i)
  {
    blocks_[i] = blocks_[stride * i];
  }
  blocks_.resize((blocks_.size() + stride - 1) / stride);
}

/// Of the blocks at the present values [A].
Eigen::VectorXd FrictionFit::residuals() const
{
  std::array<const double*, QUANTITIES> values{};
  std::transform(values_.begin(), values_.end(), values.begin(), [](const double& value) { return &value; });
  Eigen::VectorXd residuals(static_cast<Eigen::Index>(blocks_.size()));
  for (std::size_t i = 0; i < blocks_.size(); ++i)
  {
    Residual{ blocks_[i] }(values.data(), &residuals[static_cast<Eigen::Index>(i)]);
  }
  return residuals;
}

/// The values, then their deviation and correlation, by which they are fitted again.
void FrictionFit::solve(const std::function<void()>& look)
{
  double correlation_rows = 1.0;
  Eigen::VectorXd errors = residuals();
  constexpr int ROUNDS = 3;
  for (int round = 0; round < ROUNDS; ++round)
  {
    look();
    solveOnce(std::max(robustDeviation(errors), 1e-6), correlation_rows);
    errors = residuals();
    correlation_rows = correlationRows(errors);
  }
}

/// @param deviation of the blocks, outliers left out [A]
void FrictionFit::solveOnce(double deviation, double correlation_rows)
{
  ceres::Problem problem;
  std::vector<double*> all;
  for (std::size_t i = 0; i < QUANTITIES; ++i)
  {
    all.push_back(&values_[i]);
    problem.AddParameterBlock(all.back(), 1);
    if (!asked_[i])
    {
      problem.SetParameterBlockConstant(all.back());
      continue;
    }
    problem.AddResidualBlock(
        new ceres::NormalPrior(Eigen::Matrix<double, 1, 1>(1.0 / known_[i]), Eigen::Matrix<double, 1, 1>(start_[i])),
        nullptr, all.back());
    if (isFriction(i))
    {
      problem.SetParameterLowerBound(all.back(), 0, i == GREASE ? LEAST_GREASE : 0.0);
    }
  }
  const double weight = 1.0 / (deviation * deviation * correlation_rows);
  for (const Block& block : blocks_)
  {
    auto* cost = new ceres::DynamicAutoDiffCostFunction<Residual, QUANTITIES>(new Residual{ block });
    std::for_each(all.begin(), all.end(), [&](double* /*value*/) { cost->AddParameterBlock(1); });
    cost->SetNumResiduals(1);
    problem.AddResidualBlock(
        cost, new ceres::ScaledLoss(new ceres::HuberLoss(OUTLIER * deviation), weight, ceres::TAKE_OWNERSHIP), all);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 100;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  findHalfWidths(weight);
}

/// From what was known before and what the blocks say of it, each with this weight.
void FrictionFit::findHalfWidths(double weight)
{
  using Normal = Eigen::Matrix<double, QUANTITIES, QUANTITIES>;
  using Row = Eigen::Matrix<double, QUANTITIES, 1>;
  const Row scale = Eigen::Map<const Row>(known_.data());
  Normal information = Normal::Identity();
  for (const Block& block : blocks_)
  {
    Row slope = values_[GAIN] * Eigen::Map<const Row>(block.column.data());
    slope[OFFSET] = 1.0;
    slope[GAIN] = block.known;
    for (std::size_t i = INERTIA; i < QUANTITIES; ++i)
    {
      slope[GAIN] += values_[i] * block.column[i];
    }
    slope = slope.cwiseProduct(scale);
    for (std::size_t i = 0; i < QUANTITIES; ++i)
    {
      slope[static_cast<Eigen::Index>(i)] *= asked_[i] ? 1.0 : 0.0;
    }
    information += weight * slope * slope.transpose();
  }
  const Row variance = information.ldlt().solve(Normal::Identity()).diagonal();
  for (std::size_t i = 0; i < QUANTITIES; ++i)
  {
    half_width_[i] = asked_[i] ? NORMAL_95 * known_[i] * std::sqrt(variance[static_cast<Eigen::Index>(i)]) : 0.0;
  }
}

/// Of the deviation before that is left after the motion.
double FrictionFit::share(std::size_t quantity) const
{
  return half_width_[quantity] / (NORMAL_95 * known_[quantity]);
}
}  // namespace hjt
