// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/number_text.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "tracking/motion_driven.hpp"
#include "tracking/observer.hpp"
#include "tracking/telemetry_rows.hpp"

namespace hjt
{
namespace
{
constexpr double DEVIATIONS = 3.0;  // half width of a band, in standard deviations [-]

/// Whether a load of this source contains all torques at the output, including weight and inertia.
bool holdsAll(LoadSource source)
{
  return source == LoadSource::TARGET_MOMENT || source == LoadSource::ARM;
}

LoadOrigin originOf(LoadSource source)
{
  return source == LoadSource::MODEL ? LoadOrigin::CONFIGURED :
         source == LoadSource::ARM   ? LoadOrigin::ARM :
                                       LoadOrigin::RECORDED;
}

}  // namespace

Tracker::Tracker(const Parameters& parameters, InputMode mode, const SurfaceSource& surface_source)
  : load_source_(parameters.telemetry.load)
  , load_(parameters.output)
  , telemetry_(parameters.telemetry)
  , ratio_(nominalRatio(parameters.gear))
  , grease_(parameters)
  , temperature_(parameters.input.temperature)
  , evidence_(parameters, originOf(parameters.telemetry.load))
{
  if (mode != InputMode::MOTION && holdsAll(load_source_) && parameters.output.gravity_torque != 0.0)
  {
    throw ParameterError(
        std::string("telemetry.load = ") + (load_source_ == LoadSource::ARM ? "arm" : "target_moment") +
        " contains the weight already, but output.gravity_torque = " + numberText(parameters.output.gravity_torque) +
        " [N.m]. Without a recorded load set telemetry.load = model. With a recorded load add "
        "config/recorded_load.yaml after the joint's own file");
  }
  torque_driven_ = mode == InputMode::TORQUE ? std::make_unique<TorqueDriven>(parameters, surface_source) : nullptr;
  observer_ = mode == InputMode::OBSERVER ? std::make_unique<Observer>(parameters) : nullptr;
}

Tracker::~Tracker() = default;

void Tracker::reset() noexcept
{
  loads_.clear();
  temperatures_.clear();
  restart();
}

/// Forgets all rows, but keeps loads and temperatures.
void Tracker::restart() noexcept
{
  refused_ += smoother_.refused();
  smoother_ = MotionDifferentiator();
  restarted_ = true;
  last_time_ = -HUGE_VAL;
  outside_share_ = 0.0;
  lag_.reset();
  evidence_.reset();
}

void Tracker::setFits(bool fits) noexcept
{
  if (fits_ && !fits)
  {
    evidence_.resetSignals();
  }
  fits_ = fits;
}

void Tracker::pushLoad(double time, double torque) noexcept
{
  if (std::isfinite(time) && std::isfinite(torque))
  {
    loads_.push(time, torque);
  }
}

/// Last load received for `time` or before [N.m]; none: there is no such load, or telemetry.load is `model`.
std::optional<double> Tracker::loadAt(double time) const noexcept
{
  return load_source_ == LoadSource::MODEL ? std::nullopt : loads_.at(time);
}

/// Prepares for a row at `time` [s]. If the time jumps back, the tracker starts again.
void Tracker::begin(double time) noexcept
{
  if (time < last_time_ - StreamTiming::RESTART)
  {
    loads_.jumpBack(last_time_ - StreamTiming::RESTART);
    temperatures_.jumpBack(last_time_ - StreamTiming::RESTART);
    restart();
    ++counters_.restarts;
  }
  loads_.mark();
  temperatures_.mark();
}

void Tracker::push(const MotionRow& row) noexcept
{
  if (!isPlausible(row))
  {
    ++refused_;
    return;
  }
  begin(row.time);
  if (smoother_.push(row))
  {
    last_time_ = row.time;
  }
}

std::optional<Comparison> Tracker::pop(bool at_end) noexcept
{
  std::optional<MotionSample> sample = smoother_.pop(at_end);
  return sample ? std::make_optional(comparisonOf(*sample)) : std::nullopt;
}

Comparison Tracker::compare(MotionSample sample) noexcept
{
  begin(sample.time);
  last_time_ = sample.time;
  return comparisonOf(sample);
}

Comparison Tracker::comparisonOf(MotionSample& sample) noexcept
{
  counters_.gaps += sample.after_gap ? 1 : 0;
  sample.after_gap = sample.after_gap || restarted_;
  restarted_ = false;

  if (!std::isfinite(sample.temperature))
  {
    sample.temperature = temperatures_.at(sample.time);
  }
  const double received_temperature = sample.temperature;
  const bool is_temperature_received = std::isfinite(received_temperature);
  temperature_ = grease_.at(sample);
  const double prediction_temperature =
      is_temperature_received ? temperature_ : estimated_temperature_.value_or(temperature_);

  const std::optional<double> received = loadAt(sample.time);
  const bool is_all = received && holdsAll(load_source_);
  const bool is_known = received || load_source_ == LoadSource::MODEL;
  load_is_known_ = is_known;
  sample.load = received.value_or(0.0) + (is_all ? 0.0 : ownTorque(load_, sample));
  // A load from the controller contains the part telemetry.inertia_in_load of the motor's inertia. The twin contains
  // this part too, so the program subtracts it here.
  const double external =
      received.value_or(0.0) - (is_all ? telemetry_.inertia_in_load * ratio_ * ratio_ * sample.acceleration : 0.0);

  Comparison now;
  now.time = sample.time;
  now.position = { sample.position, sample.position, 0.0 };
  now.velocity = { sample.velocity, sample.velocity, 0.0 };
  now.current = { sample.current, sample.current, 0.0 };
  now.load_torque = sample.load;
  now.load_provided = received.has_value();
  now.temperature = prediction_temperature;
  now.temperature_received = is_temperature_received;
  now.housing_temperature = grease_.housing(prediction_temperature);
  now.after_gap = sample.after_gap;
  // The evidence uses the received temperature near the motor, as `compare` does. The comparison uses the temperature
  // of the grease.
  evidence_.predict(sample);
  sample.temperature = prediction_temperature;
  if (torque_driven_)
  {
    predictByTorque(sample, external, now);
  }
  else if (observer_)
  {
    predictByObserver(sample, external, now);
  }
  else
  {
    predictByMotion(sample, now);
  }
  grease_.book(sample.velocity, now.friction_torque,
               telemetry_.torque_per_current * (sample.current - telemetry_.current_offset) / ratio_);
  now.current.band = is_known ? now.current.band : 0.0;  // without a known load the current cannot be judged
  now.residual_torque = telemetry_.torque_per_current * now.current.residual();

  sample.temperature = received_temperature;
  watch(sample, now, is_known);
  return now;
}

void Tracker::predictByTorque(const MotionSample& sample, double external, Comparison& now) noexcept
{
  const TorqueDriven::Motion motion = torque_driven_->step(sample, external);
  now.position.predicted = motion.position;
  now.velocity.predicted = motion.velocity;
  now.joint_torque = motion.joint_torque;
  now.friction_torque = motion.friction_torque;
}

/// Predicts without a step of its own, because the twin of evidence_ has already made the step to this sample.
void Tracker::predictByMotion(const MotionSample& sample, Comparison& now) const noexcept
{
  const MotionPrediction predicted = evidence_.twin().at(sample.temperature);
  now.current.predicted = predicted.current;
  now.current.band = DEVIATIONS * telemetry_.current_deviation + predicted.band;
  now.sticking = predicted.band > telemetry_.current_deviation;
  now.friction_torque = predicted.friction_torque;
  now.joint_torque = sample.load + sample.vibration + telemetry_.torque_per_current * now.current.residual();
}

void Tracker::predictByObserver(const MotionSample& sample, double external, Comparison& now) noexcept
{
  const double to_current = ratio_ / telemetry_.torque_per_current;
  const Observation seen =
      observer_->step({ sample.time, (sample.current - telemetry_.current_offset) / to_current, external,
                        sample.position, sample.motor_angle, sample.after_gap, sample.temperature });
  now.position.predicted = sample.position - seen.innovation;
  now.position.band = seen.innovation_band;
  // The predicted velocity is that of the rotor, because an error of the load makes the model's output oscillate.
  now.velocity.predicted = seen.motor_velocity / ratio_;
  now.current.predicted = sample.current + to_current * seen.residual_torque;
  now.current.band = std::hypot(DEVIATIONS * telemetry_.current_deviation, to_current * seen.residual_band);
  now.sticking = seen.sticking;
  now.friction_torque = ratio_ * seen.friction_torque;
  now.joint_torque = seen.joint_torque;
}

/// Adds a row to evidence, lag, counters and outsideShare().
void Tracker::watch(const MotionSample& sample, const Comparison& now, bool load_is_known) noexcept
{
  if (load_is_known)
  {
    evidence_.judge(sample, fits_);
  }
  const double step =
      now.after_gap || evidence_.isTouched() ? 0.0 : std::clamp(now.time - last_compared_, 0.0, OUTSIDE_MEMORY);
  outside_share_ += (1.0 - std::exp(-step / OUTSIDE_MEMORY)) * ((now.isOutside() ? 1.0 : 0.0) - outside_share_);
  last_compared_ = now.time;
  if (!observer_)  // the prediction of the observer depends on the measured current
  {
    const Compared& judged = torque_driven_ ? now.velocity : now.current;
    lag_.add(now.time, judged.predicted, judged.measured);
  }
  ++counters_.compared;
  counters_.outside += now.isOutside() ? 1 : 0;
  counters_.without_load += load_is_known ? 0 : 1;
}

TrackerCounters Tracker::counters() const noexcept
{
  TrackerCounters counters = counters_;
  counters.refused = refused_ + smoother_.refused();
  counters.refused_temperatures = temperatures_.refused();
  counters.solver_failures = torque_driven_ ? torque_driven_->solverFailures() : 0;
  return counters;
}
}  // namespace hjt
