// SPDX-License-Identifier: BSD-3-Clause
#include "apps/compare/recording_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "gear/ratio.hpp"
#include "tracking/plausible.hpp"

namespace hjt
{
namespace
{
constexpr double MAX_PRESLIDING = 0.05;  // share of the friction not mobilised in rows that tell friction [-]
}  // namespace

RecordingComparison::RecordingComparison(const Parameters& parameters, std::vector<ReferenceBin> baseline,
                                         std::function<void(const JudgedWindow&)> watch)
  : parameters_(parameters)
  , ratio_(nominalRatio(parameters.gear))
  , twin_(parameters)
  , spectrum_(ratio_)
  , torsion_(parameters)
  , contact_(parameters.output.load_torque_limit)
  , load_step_(std::max(parameters.output.load_torque_limit, 1.0) / LOAD_STEPS)
  , loads_(static_cast<std::size_t>(LOAD_STEPS) + 2)
  , health_(parameters)
  , baseline_given_(!baseline.empty())
  , watch_(std::move(watch))
{
  if (baseline_given_)
  {
    health_.setReference(std::move(baseline));
  }
}

void RecordingComparison::update(const MotionSample& sample)
{
  if (!isPossible(sample, parameters_))
  {
    ++reach_.impossible;
    return;
  }
  const ComparedRow row{ sample, twin_.step(sample) };
  course_.add(row);
  current_squares_ += sample.current * sample.current;
  predicted_squares_ += row.predicted.current * row.predicted.current;
  const Eigen::Vector3d terms(1.0, row.predicted.friction_torque / parameters_.telemetry.torque_per_current,
                              row.residual());
  products_ += terms * terms.transpose();
  contact_.update(sample, parameters_.telemetry.torque_per_current * row.residual(), row.predicted.friction_torque,
                  row.predicted.band > parameters_.telemetry.current_deviation);
  ++loads_[static_cast<std::size_t>(std::abs(sample.load) / load_step_)];
  if (reach_.rows++ == 0)
  {
    reach_.least_load = reach_.most_load = sample.load;
    reach_.least_angle = reach_.most_angle = sample.position;
  }
  reach_.least_load = std::min(reach_.least_load, sample.load);
  reach_.most_load = std::max(reach_.most_load, sample.load);
  reach_.least_angle = std::min(reach_.least_angle, sample.position);
  reach_.most_angle = std::max(reach_.most_angle, sample.position);

  const bool both_encoders = std::isfinite(sample.motor_angle);
  if (both_encoders)
  {
    torsion_.follow(sample.load);
  }
  if (std::abs(sample.velocity) > MOVING)
  {
    const double gain = parameters_.telemetry.torque_per_current;
    if (gain * row.predicted.band < MAX_PRESLIDING * std::abs(row.predicted.friction_torque))
    {
      const double way = sample.velocity < 0.0 ? -1.0 : 1.0;
      const double friction = row.predicted.friction_torque;
      friction_.add(sample.velocity, way * (friction + gain * row.residual()), way * friction);
      spectrum_.add(sample.position, sample.velocity, row.residual());
    }
    if (both_encoders)
    {
      torsion_.add(sample.load, sample.motor_angle / ratio_ - sample.position, sample.position, sample.velocity);
    }
  }
  reach_.motor_rows += both_encoders ? 1 : 0;
  reach_.temperature_rows += std::isfinite(sample.temperature) ? 1 : 0;
  temperatures_ += sample.temperatureOr(parameters_.input.temperature);
  watchSignals(sample);
}

void RecordingComparison::watchSignals(const MotionSample& sample)
{
  if (!health_.update(sample))
  {
    return;
  }
  JudgedWindow window;
  window.indicators = health_.indicators();
  window.assessment = health_.assessor().assessment();
  window.deviations = health_.assessor().deviations();
  watch_(window);
  const bool compared = std::any_of(window.deviations.begin(), window.deviations.end(),
                                    [](const Deviation& deviation) { return std::isfinite(deviation.score); });
  if (window.assessment.state != AssessmentState::ASSESSED || !compared)
  {
    return;
  }
  ++assessed_;
  const HealthLevel before = worst_ ? worst_->assessment.level : HealthLevel::OK;
  if (window.assessment.level != HealthLevel::OK)
  {
    ++votes_[static_cast<std::size_t>(window.assessment.cause)];
    if (before == HealthLevel::OK)
    {
      alarm_time_ = sample.time;
    }
  }
  if (window.assessment.level >= before)
  {
    worst_ = window;
  }
}

Cause RecordingComparison::cause() const
{
  return static_cast<Cause>(std::max_element(votes_.begin(), votes_.end()) - votes_.begin());
}

double RecordingComparison::currentRms() const
{
  return reach_.rows == 0 ? 0.0 : std::sqrt(current_squares_ / static_cast<double>(reach_.rows));
}

double RecordingComparison::predictedRms() const
{
  return reach_.rows == 0 ? 0.0 : std::sqrt(predicted_squares_ / static_cast<double>(reach_.rows));
}

double RecordingComparison::residualRms() const
{
  return reach_.rows == 0 ? 0.0 : std::sqrt(products_(2, 2) / static_cast<double>(reach_.rows));
}

double RecordingComparison::residualSpread() const
{
  const double rows = std::max(static_cast<double>(reach_.rows), 1.0);
  const double mean = products_(0, 2) / rows;
  return std::sqrt(std::max(products_(2, 2) / rows - mean * mean, 0.0));
}

double RecordingComparison::unexplainedRms() const
{
  const Eigen::Vector2d with = products_.topRightCorner<2, 1>();
  const Eigen::Vector2d best = products_.topLeftCorner<2, 2>().ldlt().solve(with);
  const double rows = std::max(static_cast<double>(reach_.rows), 1.0);
  return std::sqrt(std::max(products_(2, 2) - best.dot(with), 0.0) / rows);
}

double RecordingComparison::loadQuantile(double share) const
{
  const auto enough = static_cast<std::uint64_t>(share * static_cast<double>(reach_.rows));
  std::uint64_t rows = 0;
  std::size_t step = 0;
  while (step + 1 < loads_.size() && (rows += loads_[step]) <= enough)
  {
    ++step;
  }
  return load_step_ * (static_cast<double>(step) + 0.5);
}

double RecordingComparison::temperature() const
{
  return reach_.rows == 0 ? parameters_.input.temperature : temperatures_ / static_cast<double>(reach_.rows);
}

double RecordingComparison::twinFrictionAt(double temperature) const
{
  double sum = 0.0;
  double rows = 0.0;
  for (const FrictionPoint& point : friction_.points())
  {
    const auto weight = static_cast<double>(point.rows);
    sum += weight * twin_.frictionAt(point.speed, typicalLoad(), temperature);
    rows += weight;
  }
  return sum / std::max(rows, 1.0);
}

double RecordingComparison::typicalLoad() const
{
  return loadQuantile(0.5);
}

double RecordingComparison::largestLoad() const
{
  return loadQuantile(0.999);
}
}  // namespace hjt
