// SPDX-License-Identifier: BSD-3-Clause
#include "identification/friction_fit.hpp"

#include <algorithm>
#include <cmath>

#include <ceres/ceres.h>

#include "base/number_text.hpp"
#include "elements/motor.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "identification/regression.hpp"

namespace hjt
{
namespace
{
constexpr double MIN_TOLERANCE = 1e-3;  // share of a column's square that the others do not explain
constexpr double STRIBECK_SPEED = 5.0;  // of the motor, where the static rise has faded [rad/s]
constexpr double OUTLIER = 3.0;         // blocks that many deviations off count less
constexpr std::size_t MIN_BLOCKS = 12;
constexpr std::size_t MAX_BLOCKS = 20000;  // a longer recording is thinned out

/// Largest half width of an interval over its value. The gain, which is known within some percent before, is asked more
/// of.
double widest(std::size_t quantity)
{
  return quantity == FrictionFit::GAIN ? 0.1 : 0.5;
}

bool isFriction(std::size_t quantity)
{
  return quantity >= FrictionFit::PRELOAD;
}

/// What is refused first: what the twin does without, then what is known best before. Higher first.
double rank(std::size_t quantity)
{
  switch (quantity)
  {
    case FrictionFit::FLANKS:
    case FrictionFit::VISCOUS:
      return 1e9;
    case FrictionFit::OFFSET:
    case FrictionFit::GAIN:
      return 1e6;
    case FrictionFit::INERTIA:
      return 1e3;
    default:
      return 1.0;
  }
}
}  // namespace

/// Of one block, each value a parameter block of its own.
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
                         const std::vector<MotionSample>& samples)
{
  addBlocks(parameters, friction, samples);
  if (blocks_.size() < MIN_BLOCKS)
  {
    throw InputError("the joint hardly moves in the part to identify on: " + std::to_string(blocks_.size()) +
                     " stretches of " + numberText(BLOCK) + " s are faster than " + numberText(MOVING) + " rad/s, " +
                     std::to_string(MIN_BLOCKS) + " are needed");
  }
  values_[GAIN] = 1.0 / parameters.telemetry.torque_per_current;
  values_[OFFSET] = parameters.telemetry.current_offset;
  values_[INERTIA] = Motor(parameters.motor).inertia() - parameters.telemetry.inertia_in_load;
  values_[PRELOAD] = parameters.bearing.race_preload;
  values_[GREASE] = 1.0;
  values_[FLANKS] = 1.0;
  values_[VISCOUS] = parameters.motor.viscous_friction;
  start_ = values_;
  asked_.fill(true);
  asked_[STRIBECK] = false;
  solve();
  do
  {
    solve();  // outliers are those of the solution before
  } while (refuseWorst());

  // Beside what was found, and without changing it: the twin has no parameter for it.
  const Values found = values_;
  const Values width = half_width_;
  asked_[STRIBECK] = true;
  solve();
  const std::string refusal = whyRefused(STRIBECK).reason;
  const double rise = refusal.empty() ? values_[STRIBECK] : 0.0;
  const double rise_width = refusal.empty() ? half_width_[STRIBECK] : 0.0;
  values_ = found;
  half_width_ = width;
  values_[STRIBECK] = rise;
  half_width_[STRIBECK] = rise_width;
  refusal_[STRIBECK] = refusal;
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
    const FrictionShares shares = friction.at(speed, sample.load, parameters.input.temperature);
    block.current += weight * sample.current;
    block.known += weight * (sample.load + sample.vibration) + joint * shares.rest;
    block.column[INERTIA] += weight * ratio * ratio * sample.acceleration;
    block.column[PRELOAD] += joint * preload_torque;
    block.column[GREASE] += joint * shares.grease;
    block.column[FLANKS] += joint * shares.flanks;
    block.column[VISCOUS] += joint * std::abs(speed);
    block.column[STRIBECK] += joint * std::exp(-std::pow(speed / STRIBECK_SPEED, 2));
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

/// Standard deviation of the blocks about the present values, outliers left out [A].
double FrictionFit::deviation() const
{
  std::vector<double> sizes;
  std::array<const double*, QUANTITIES> values{};
  std::transform(values_.begin(), values_.end(), values.begin(), [](const double& value) { return &value; });
  for (const Block& block : blocks_)
  {
    double residual{};
    Residual{ block }(values.data(), &residual);
    sizes.push_back(std::abs(residual));
  }
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  constexpr double NORMAL_MEDIAN = 0.6745;
  return std::max(*middle / NORMAL_MEDIAN, 1e-6);
}

void FrictionFit::solve()
{
  ceres::Problem problem;
  std::vector<double*> all;
  std::vector<double*> asked;
  for (std::size_t i = 0; i < QUANTITIES; ++i)
  {
    all.push_back(&values_[i]);
    problem.AddParameterBlock(all.back(), 1);
    if (!asked_[i])
    {
      problem.SetParameterBlockConstant(all.back());
      continue;
    }
    asked.push_back(all.back());
    if (isFriction(i))
    {
      problem.SetParameterLowerBound(all.back(), 0, 0.0);
    }
  }
  const double outlier = OUTLIER * deviation();
  for (const Block& block : blocks_)
  {
    auto* cost = new ceres::DynamicAutoDiffCostFunction<Residual, QUANTITIES>(new Residual{ block });
    std::for_each(all.begin(), all.end(), [&](double* /*value*/) { cost->AddParameterBlock(1); });
    cost->SetNumResiduals(1);
    problem.AddResidualBlock(cost, new ceres::HuberLoss(outlier), all);
  }
  constexpr int MAX_ITERATIONS = 100;
  const Regression found = hjt::solve(problem, asked, MAX_ITERATIONS);
  for (std::size_t k = 0; k < asked.size(); ++k)
  {
    const std::ptrdiff_t i = asked[k] - values_.data();
    const auto at = static_cast<Eigen::Index>(k);
    norm_[i] = found.norm[at];
    tolerance_[i] = found.tolerance[at];
    half_width_[i] = found.half_width[at];
  }
}

FrictionFit::Verdict FrictionFit::whyRefused(std::size_t i) const
{
  // An inertia is compared with the motor's, since what the load holds of it may leave nothing.
  const double size = std::abs(i == INERTIA ? start_[i] : values_[i]);
  if (norm_[i] <= 0.0)
  {
    return { 1e3, "nothing in this motion depends on it" };
  }
  if (tolerance_[i] < MIN_TOLERANCE)
  {
    return { MIN_TOLERANCE / tolerance_[i],
             "the other quantities explain all but " + percentText(tolerance_[i]) + " of its effect" };
  }
  if (size <= 1e-6 * half_width_[i] && i != PRELOAD && i != GREASE)
  {
    return { 1e3, "its estimate is zero" };
  }
  if (half_width_[i] > widest(i) * size && size > 1e-6 * half_width_[i])
  {
    return { half_width_[i] / (widest(i) * size),
             "its 95 % interval is " + percentText(half_width_[i] / size) + " of the value wide to either side" };
  }
  return {};
}

/// True if a parameter was dropped, so that the rest must be refitted.
bool FrictionFit::refuseWorst()
{
  double worst = 0.0;
  std::size_t quantity = QUANTITIES;
  Verdict verdict;
  for (std::size_t i = 0; i < QUANTITIES; ++i)
  {
    const Verdict candidate = asked_[i] ? whyRefused(i) : Verdict{};
    if (candidate.badness * rank(i) > worst)
    {
      worst = candidate.badness * rank(i);
      quantity = i;
      verdict = candidate;
    }
  }
  if (quantity == QUANTITIES)
  {
    return false;
  }
  refusal_[quantity] = verdict.reason;
  half_width_[quantity] = 0.0;
  asked_[quantity] = false;
  values_[quantity] = start_[quantity];
  return true;
}
}  // namespace hjt
