// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/joint_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>

#include "gear/ratio.hpp"
#include "tracking/current_lag.hpp"

namespace hjt
{
JointEvidence::JointEvidence(const Parameters& parameters, LoadOrigin load)
  : parameters_(parameters)
  , load_(load)
  , ratio_(nominalRatio(parameters.gear))
  , load_step_(std::max(parameters.output.load_torque_limit, 1.0) / LOAD_STEPS)
  , twin_(parameters)
  , course_(parameters)
  , contact_(parameters.output.load_torque_limit)
  , health_(parameters)
  , torsion_(parameters)
{
}

void JointEvidence::setReference(std::vector<ReferenceBin> bins)
{
  baseline_given_ = !bins.empty();
  if (baseline_given_)
  {
    health_.setReference(std::move(bins));
  }
}

void JointEvidence::forget() noexcept
{
  const double end = now_.reach.end;
  torsion_.reset();
  now_ = {};
  now_.reach.begin = now_.reach.end = end;
}

void JointEvidence::reset() noexcept
{
  torsion_.reset();
  now_ = {};
  course_.reset();
  contact_.reset();
  health_.reset();
}

JointEvidence::Row JointEvidence::judge(const MotionSample& sample, bool fits) noexcept
{
  if (!(std::abs(sample.load) <= parameters_.output.load_torque_limit &&
        std::abs(sample.current) <= parameters_.possible_current))
  {
    ++now_.reach.impossible;
    return Row::IMPOSSIBLE;
  }
  const double gain = parameters_.telemetry.torque_per_current;
  const double residual = sample.current - predicted_.current;
  const bool was_touched = isTouched();
  contact_.update(sample, gain * residual, predicted_.friction_torque,
                  predicted_.band > parameters_.telemetry.current_deviation);
  const double step = addToReach(sample);
  if (std::isfinite(sample.motor_angle))
  {
    twin_torsion_ = course_.to(sample.load);
  }
  if (!contact_.isTouching())
  {
    addGain(sample, residual, step);
  }
  if (isTouched())
  {
    ++now_.reach.touched_rows;
    if (!was_touched)
    {
      health_.reset();
    }
    return Row::TOUCHED;
  }
  addRow(sample, residual);
  return fits && watchSignals(sample) ? Row::WINDOW : Row::COUNTED;
}

/// Adds a row to MotionReach. Returns the time since the row before [s], or 0 for the first row, also after a gap.
double JointEvidence::addToReach(const MotionSample& sample) noexcept
{
  MotionReach& reach = now_.reach;
  const double since = sample.time - reach.end;
  const double step = reach.rows > 0 && since > 0.0 && since <= MotionDifferentiator::MAX_GAP ? since : 0.0;
  if (reach.rows++ == 0)
  {
    reach.begin = sample.time;
    reach.least_load = reach.most_load = sample.load;
    reach.least_angle = reach.most_angle = sample.position;
  }
  reach.end = sample.time;
  reach.sampled += step;
  reach.least_load = std::min(reach.least_load, sample.load);
  reach.most_load = std::max(reach.most_load, sample.load);
  reach.least_angle = std::min(reach.least_angle, sample.position);
  reach.most_angle = std::max(reach.most_angle, sample.position);
  reach.motor_rows += std::isfinite(sample.motor_angle) ? 1 : 0;
  reach.temperature_rows += std::isfinite(sample.temperature) ? 1 : 0;
  return step;
}

/// Adds a row to the sums for loadFactor(). Rows shortly after a contact count too, because a wrong gain can look like
/// a contact.
void JointEvidence::addGain(const MotionSample& sample, double residual, double step) noexcept
{
  if (std::abs(sample.velocity) > FrictionPoints::SLOWEST && predicted_.tellsFriction())
  {
    const double friction = predicted_.friction_torque / parameters_.telemetry.torque_per_current;
    const Eigen::Vector4d parts(1.0, friction, predicted_.current - friction, residual);
    now_.gains += parts * parts.transpose();
    now_.gains_time += step;
  }
}

void JointEvidence::addRow(const MotionSample& sample, double residual) noexcept
{
  const double gain = parameters_.telemetry.torque_per_current;
  const double friction = predicted_.friction_torque;
  Eigen::Matrix<double, PRODUCTS, 1> terms;
  terms << 1.0, friction / gain, residual, predicted_.current, sample.current;
  now_.products += terms * terms.transpose();
  ++now_.loads[static_cast<std::size_t>(std::abs(sample.load) / load_step_)];
  now_.temperatures += sample.temperatureOr(parameters_.input.temperature);
  if (std::abs(sample.velocity) <= FrictionPoints::SLOWEST)
  {
    return;
  }
  if (predicted_.tellsFriction())
  {
    const double way = sample.velocity < 0.0 ? -1.0 : 1.0;
    const double measured = friction + gain * residual;
    now_.friction.add(sample.time, sample.velocity, way * measured, way * friction, sample.load);
    if (std::isfinite(sample.target_current))
    {
      const double expected = friction + gain * (sample.target_current - predicted_.current);
      now_.beside_controller.add(sample.time, sample.velocity, way * measured, way * expected, sample.load);
    }
  }
  if (std::isfinite(sample.motor_angle))
  {
    torsion_.add(sample.load, twin_torsion_, sample.motor_angle / ratio_ - sample.position, sample.position,
                 sample.velocity);
  }
}

bool JointEvidence::watchSignals(const MotionSample& sample) noexcept
{
  if (!health_.update(sample))
  {
    return false;
  }
  const Assessment& assessment = health_.assessor().assessment();
  const Deviations& deviations = health_.assessor().deviations();
  const bool compared = std::any_of(deviations.begin(), deviations.end(),
                                    [](const Deviation& deviation) { return std::isfinite(deviation.score); });
  if (assessment.state != AssessmentState::ASSESSED || !compared)
  {
    now_.too_few = assessment.state == AssessmentState::TOO_FEW_WINDOWS ? assessment : now_.too_few;
    return true;
  }
  ++now_.assessed;
  const HealthLevel before = now_.worst ? now_.worst->assessment.level : HealthLevel::OK;
  if (assessment.level != HealthLevel::OK)
  {
    ++now_.votes[static_cast<std::size_t>(assessment.cause)];
    if (before == HealthLevel::OK)
    {
      now_.alarm_time = sample.time;
    }
  }
  if (assessment.level >= before)
  {
    now_.worst = JudgedWindow{ health_.indicators(), deviations, assessment };
  }
  return true;
}

double JointEvidence::counted() const
{
  return std::max(static_cast<double>(now_.reach.rows - now_.reach.touched_rows), 1.0);
}

Cause JointEvidence::cause() const
{
  return static_cast<Cause>(std::max_element(now_.votes.begin(), now_.votes.end()) - now_.votes.begin());
}

double JointEvidence::causeShare() const
{
  const std::uint64_t all = std::accumulate(now_.votes.begin(), now_.votes.end(), std::uint64_t{ 0 });
  const std::uint64_t own = now_.votes[static_cast<std::size_t>(cause())];
  return all > 0 ? static_cast<double>(own) / static_cast<double>(all) : 0.0;
}

double JointEvidence::rms(Product of) const
{
  return std::sqrt(now_.products(of, of) / counted());
}

double JointEvidence::residualSpread() const
{
  const double rows = counted();
  const double mean = now_.products(ONE, RESIDUAL) / rows;
  return std::sqrt(std::max(now_.products(RESIDUAL, RESIDUAL) / rows - mean * mean, 0.0));
}

double JointEvidence::unexplainedRms() const
{
  const Eigen::Vector2d with = now_.products.block<2, 1>(ONE, RESIDUAL);
  const Eigen::Vector2d best = now_.products.topLeftCorner<2, 2>().ldlt().solve(with);
  const double rows = counted();
  return std::sqrt(std::max(now_.products(RESIDUAL, RESIDUAL) - best.dot(with), 0.0) / rows);
}

FittedFactor JointEvidence::loadFactor() const
{
  const Eigen::Matrix2d others = now_.gains.topLeftCorner<2, 2>();
  const Eigen::Matrix2d with = now_.gains.topRightCorner<2, 2>();
  const Eigen::Matrix2d left =
      now_.gains.bottomRightCorner<2, 2>() - with.transpose() * Eigen::Matrix2d(others.ldlt().solve(with));
  FittedFactor factor = LoadRegression::slopeOf(left * now_.gains_time / now_.gains(0, 0), now_.gains_time);
  factor.value += 1.0;
  return factor;
}

double JointEvidence::loadQuantile(double share) const
{
  const auto enough = static_cast<std::uint64_t>(share * counted());
  std::uint64_t rows = 0;
  std::size_t step = 0;
  while (step + 1 < now_.loads.size() && (rows += now_.loads[step]) <= enough)
  {
    ++step;
  }
  return load_step_ * (static_cast<double>(step) + 0.5);
}

double JointEvidence::temperature() const
{
  return now_.reach.rows == now_.reach.touched_rows ? parameters_.input.temperature : now_.temperatures / counted();
}

double JointEvidence::twinFrictionAt(double temperature) const
{
  double sum = 0.0;
  double rows = 0.0;
  for (const FrictionPoint& point : now_.friction.points())
  {
    const auto weight = static_cast<double>(point.rows);
    sum += weight * twin_.frictionAt(point.speed, typicalLoad(), temperature);
    rows += weight;
  }
  return sum / std::max(rows, 1.0);
}

}  // namespace hjt
