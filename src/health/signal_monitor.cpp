// SPDX-License-Identifier: BSD-3-Clause
#include "health/signal_monitor.hpp"

#include <algorithm>
#include <cmath>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/stamp.hpp"

namespace hjt
{
namespace
{
constexpr double MEAN_TRAVEL = 0.5 * TWO_PI;     // travel after which a speed has weight 1/e in the mean speed [rad]
constexpr double MEAN_TIME = 0.5;                // time after which a speed has weight 1/e in the mean speed [s]
constexpr double LARGEST_RIPPLE = 12e-3;         // largest ripple of the measured speed in a calm motion [rad]
constexpr double SETTLING_TIME = 0.1;            // time after uneven motion until the motion counts as calm [s]
constexpr std::int64_t WAITING_TIME = 20000000;  // time before uneven motion in which the motion is not calm [ns]
// After a change of speed the drive rings at 33 to 45 Hz. At the change the ripple has a pulse, about six times
// as large as the ringing and at least ten times as large as the ripple by lines.
constexpr double RINGING_SHARE = 0.15;      // amplitude of the ringing over the pulse of the ripple [-]
constexpr double RINGING_TIME = 0.45;       // time in which the ringing decays by a factor of e [s]
constexpr double CALM_RINGING = 0.3e-3;     // amplitude of a ringing as large as the noise in one line [rad]
constexpr double LEAST_WEIGHT = 0.04;       // least weight of a sample whose residual counts: at a ringing of 1.5 mrad
constexpr double RESIDUAL_TRAVEL = TWO_PI;  // travel after which a residual has weight 1/e in the mean residual [rad]
constexpr int MIN_RESIDUALS = 100;          // number of residuals for moments of the fourth order
constexpr double FRICTION_WINDOWS = 10.0;   // memory of FrictionEstimate, over the travel of a window [-]
}  // namespace

SignalMonitor::SignalMonitor(const Parameters& parameters)
  : ratio_(nominalRatio(parameters.gear))
  , output_(parameters.output)
  , output_inertia_(parameters.output.circular_spline_inertia + parameters.output.load_inertia)
  , motor_inertia_(ratio_ * ratio_ * (parameters.motor.rotor_inertia + parameters.motor.wave_generator_inertia))
  , parameters_(parameters.indicators)
  , tracker_(trackedOrders(parameters.gear, parameters.bearing), parameters.life.rated_torque)
  , friction_(FRICTION_WINDOWS * TWO_PI * parameters.indicators.window_turns)
  , loop_(parameters.health, parameters.indicators)
  , turn_(parameters.gear)
  , efficiency_(parameters.health)
{
}

void SignalMonitor::reset() noexcept
{
  resetLines();
  friction_.reset();
  loop_.restart();
  turn_.reset();
  efficiency_.reset();
  balance_.reset();
  lag_.reset();
  indicators_ = {};
  refused_ = 0;
  started_ = false;
  mean_velocity_ = 0.0;
  speed_ = RippleFilter();
  angle_ = RippleFilter();
  ringing_ = 0.0;
  calm_ = 0.0;
  waiting_count_ = 0;
  turn_travel_ = 0.0;
  tracked_ = false;
  residual_mean_ = 0.0;
  window_ = {};
}

double SignalMonitor::progress() const noexcept
{
  return std::max(window_.travel / (TWO_PI * parameters_.window_turns),
                  1e-9 * static_cast<double>(window_.elapsed) / parameters_.window_time);
}

void SignalMonitor::start(const SignalSample& sample, double motor_angle) noexcept
{
  started_ = true;
  last_ = sample;
  last_angle_ = motor_angle;
  mean_velocity_ = std::isfinite(sample.motor_velocity) ? sample.motor_velocity : 0.0;
  speed_ = RippleFilter(mean_velocity_);
  angle_ = RippleFilter(mean_velocity_);
  torsion_zero_ = motor_angle / ratio_ - sample.output_angle;
}

double SignalMonitor::weightAt(double output_angle) const noexcept
{
  return output_.gravity_torque != 0.0 ? output_.gravity_torque * std::sin(output_angle - output_.gravity_angle) : 0.0;
}

/// Adds a sample to the torsion loop. The torque T_0 of the loop is the estimated load, without this estimate the
/// weight, and without a weight the motor's torque, which includes friction. The inertia J lies between the place of
/// T_0 and the gear.
void SignalMonitor::addLoop(const SignalSample& sample, double motor_angle, double torsion, double velocity,
                            double seconds) noexcept
{
  const bool load_known = std::isfinite(sample.load_torque);
  const bool weight_known = output_.gravity_torque != 0.0;
  const double other_torque = weight_known ? weightAt(sample.output_angle) : ratio_ * sample.motor_torque;
  const bool at_output = load_known || weight_known;
  const double output_speed = (sample.output_angle - last_.output_angle) / seconds;
  loop_.add({ torsion, load_known ? sample.load_torque : other_torque, motor_angle, sample.output_angle },
            at_output && std::isfinite(output_speed) ? output_speed : velocity / ratio_,
            at_output ? output_inertia_ : -motor_inertia_, seconds);
}

bool SignalMonitor::update(const SignalSample& given) noexcept
{
  SignalSample sample = given;
  sample.load_torque += weightAt(sample.output_angle);  // SignalSample::load_torque is without the weight
  // Without a motor encoder the output encoder gives the angle of the motor.
  const bool motor_known = std::isfinite(sample.motor_angle);
  const double motor_angle = motor_known ? sample.motor_angle : ratio_ * sample.output_angle;
  if (!std::isfinite(motor_angle) || !std::isfinite(sample.motor_torque) || !isStamp(sample.stamp) ||
      (started_ && sample.stamp <= last_.stamp))
  {
    ++refused_;
    return false;
  }
  if (!started_)
  {
    start(sample, motor_angle);
    return false;
  }
  const std::int64_t elapsed = sample.stamp - last_.stamp;
  const double seconds = 1e-9 * static_cast<double>(elapsed);
  const double travel = motor_angle - last_angle_;
  const double velocity = std::isfinite(sample.motor_velocity) ? sample.motor_velocity : travel / seconds;
  const double kept = std::exp(-std::abs(travel) / MEAN_TRAVEL - seconds / MEAN_TIME);
  mean_velocity_ = kept * mean_velocity_ + (1.0 - kept) * velocity;
  speed_.update(velocity, seconds);
  angle_.update(travel / seconds, seconds);
  window_.elapsed += elapsed;

  const bool both = motor_known && std::isfinite(sample.output_angle);
  window_.motor_encoder = window_.motor_encoder && motor_known;
  window_.both_encoders = window_.both_encoders && both;
  const double torsion = both ? motor_angle / ratio_ - sample.output_angle - torsion_zero_ : 0.0;
  const bool moving = std::abs(mean_velocity_) >= parameters_.least_speed;
  const bool even = judgeMotion(velocity, seconds, motor_known);
  const double output_angle = std::isfinite(sample.output_angle) ? sample.output_angle : motor_angle / ratio_;
  const bool load_known = std::isfinite(sample.load_torque);
  if (both)
  {
    addTurn(motor_angle, travel, torsion);
    addLoop(sample, motor_angle, torsion, velocity, seconds);
  }
  else
  {
    loop_.interrupt();
  }
  if (load_known)
  {
    efficiency_.update(elapsed, sample.motor_torque * velocity, sample.load_torque * velocity / ratio_);
  }
  if (moving && even)
  {
    addSteady(sample, motor_angle, output_angle, travel, torsion);
  }
  addAny(sample, velocity, motor_angle, output_angle, seconds);
  last_ = sample;
  last_angle_ = motor_angle;
  if (progress() < 1.0)
  {
    return false;
  }
  complete(sample.stamp);
  return true;
}

/// Adds a sample to the estimates that use every motion: torque balance, lag, load and temperature.
void SignalMonitor::addAny(const SignalSample& sample, double velocity, double motor_angle, double output_angle,
                           double seconds) noexcept
{
  const bool load_known = std::isfinite(sample.load_torque);
  const bool moving = std::abs(mean_velocity_) >= parameters_.least_speed;
  const double load = sample.load_torque / ratio_;
  balance_.add(sample.motor_torque - (load_known ? load : 0.0), load, velocity, output_angle, seconds, moving);
  lag_.add(ratio_ * (sample.output_angle - sample.target_angle), motor_angle, motor_angle - last_angle_, seconds,
           moving);
  if (load_known)
  {
    window_.load.add(std::abs(sample.load_torque), seconds);
    window_.load_over_angle.add(output_angle, sample.load_torque, seconds);
  }
  if (std::isfinite(sample.temperature))
  {
    window_.temperature.add(sample.temperature, seconds);
  }
}

/// Updates the time for which the motion has been calm. Returns whether the speed is even (near the mean speed).
bool SignalMonitor::judgeMotion(double velocity, double seconds, bool motor_known) noexcept
{
  const bool moving = std::abs(mean_velocity_) >= parameters_.least_speed;
  const bool even = std::abs(velocity - mean_velocity_) <=
                    parameters_.speed_change * std::abs(mean_velocity_) + parameters_.least_speed;
  ringing_ = std::max(ringing_ * std::exp(-seconds / RINGING_TIME), RINGING_SHARE * std::abs(speed_.ripple()));
  const bool calm = moving && even && (!motor_known || std::abs(speed_.ripple()) < LARGEST_RIPPLE);
  calm_ = calm ? calm_ + seconds : 0.0;
  waiting_count_ = calm ? waiting_count_ : 0;
  return even;
}

void SignalMonitor::addSteady(const SignalSample& sample, double motor_angle, double output_angle, double travel,
                              double torsion) noexcept
{
  const double direction = std::copysign(1.0, mean_velocity_);
  const double load = std::isfinite(sample.load_torque) ? sample.load_torque : 0.0;
  if (calm_ > SETTLING_TIME || !window_.motor_encoder)
  {
    const double ringing = window_.motor_encoder ? ringing_ / CALM_RINGING : 0.0;
    addLines({ motor_angle, output_angle, direction, mean_velocity_, load, torsion, sample.motor_torque,
               angle_.ripple(), 1.0 / (1.0 + ringing * ringing) },
             travel, sample.stamp);
  }
  friction_.add(travel, mean_velocity_, output_angle, sample.motor_torque - load / ratio_);
  window_.travel += std::abs(travel);
  ++window_.samples;
  window_.speed.add(std::abs(mean_velocity_));
  window_.direction.add(direction);
  window_.running_torque.add(direction * (sample.motor_torque - load / ratio_));
}

/// Lets a sample wait for WAITING_TIME, or less if no place is left, before the function adds it to the lines' fit.
void SignalMonitor::addLines(const LineSample& sample, double travel, std::int64_t stamp) noexcept
{
  while (waiting_count_ > 0 &&
         (waiting_count_ == waiting_.size() || stamp - waiting_[first_waiting_].stamp > WAITING_TIME))
  {
    const Waiting& oldest = waiting_[first_waiting_];
    tracker_.add(oldest.sample);
    if (slip_)
    {
      slip_->add(oldest.sample);
    }
    if (tracked_ && window_.both_encoders && oldest.sample.weight > LEAST_WEIGHT)
    {
      addResidual(oldest.travel);
    }
    window_.line_travel += std::abs(oldest.travel);
    ++window_.line_samples;
    first_waiting_ = (first_waiting_ + 1) % waiting_.size();
    --waiting_count_;
  }
  waiting_[(first_waiting_ + waiting_count_++) % waiting_.size()] = { sample, travel, stamp };
}

void SignalMonitor::addTurn(double motor_angle, double travel, double torsion) noexcept
{
  turn_.update(motor_angle, torsion);
  turn_travel_ += std::abs(travel);
  if (turn_travel_ < TWO_PI)
  {
    return;
  }
  turn_travel_ = 0.0;
  const Indicator ratio = turn_.transmissionRatio();
  if (ratio.valid)
  {
    window_.ratio.add(ratio.value / ratio_ - 1.0);
  }
  const Indicator error = turn_.kinematicError();
  if (error.valid)
  {
    window_.kinematic_error.add(error.value);
  }
}

void SignalMonitor::addResidual(double travel) noexcept
{
  const double residual = tracker_.residual();
  const double kept = std::exp(-std::abs(travel) / RESIDUAL_TRAVEL);
  residual_mean_ = window_.residuals > 0.0 ? kept * residual_mean_ + (1.0 - kept) * residual : residual;
  const double square = (residual - residual_mean_) * (residual - residual_mean_);
  window_.residuals += 1.0;
  window_.residual_square += square;
  window_.residual_fourth += square * square;
  window_.residual_largest = std::max(window_.residual_largest, square);
}

void SignalMonitor::complete(std::int64_t stamp) noexcept
{
  const std::uint64_t windows = indicators_.windows + 1;
  indicators_ = {};
  indicators_.stamp = stamp;
  indicators_.windows = windows;
  indicators_.turns = window_.travel / TWO_PI;
  const LoadOverAngle::Coefficients load = window_.load_over_angle.coefficients();
  indicators_.point = { window_.samples > 0 ? window_.speed.value() : 0.0,
                        window_.samples > 0 ? window_.direction.value() : 0.0,
                        window_.load.value(),
                        window_.temperature.value(),
                        load[0],
                        load[1],
                        load[2],
                        ratio_ * ratio_ * balance_.fit(window_.load.weight > 0.0) };
  set(ScalarIndicator::RATIO_DEVIATION, window_.ratio.value());
  set(ScalarIndicator::KINEMATIC_ERROR, window_.kinematic_error.value());
  set(ScalarIndicator::RUNNING_TORQUE, window_.running_torque.value());
  set(ScalarIndicator::EFFICIENCY, efficiency_.efficiency());
  set(ScalarIndicator::LOAD_FRICTION, balance_.loadFriction());
  set(ScalarIndicator::LAG_RIPPLE, lag_.ripple());
  set(ScalarIndicator::LAG_ORDER_1, lag_.line(0));
  set(ScalarIndicator::LAG_ORDER_2, lag_.line(1));
  set(ScalarIndicator::LAG_ORDER_4, lag_.line(2));
  const TorsionLoopEstimate::Found torsion = loop_.fit();
  set(ScalarIndicator::TORSIONAL_STIFFNESS, torsion.stiffness);
  set(ScalarIndicator::SECOND_STIFFNESS, torsion.second_stiffness);
  set(ScalarIndicator::LOST_MOTION, torsion.lost_motion);
  set(ScalarIndicator::HYSTERESIS, torsion.hysteresis);
  set(ScalarIndicator::HYSTERESIS_AREA, torsion.loop_area);
  friction_.fit();
  set(ScalarIndicator::COULOMB_TORQUE, friction_.coulomb());
  set(ScalarIndicator::VISCOUS_FRICTION, friction_.viscous());
  if (window_.residuals >= MIN_RESIDUALS && window_.residual_square > 0.0)
  {
    const double mean_square = window_.residual_square / window_.residuals;
    set(ScalarIndicator::RESIDUAL_RMS, std::sqrt(mean_square));
    set(ScalarIndicator::RESIDUAL_KURTOSIS, window_.residual_fourth / window_.residuals / (mean_square * mean_square));
    set(ScalarIndicator::RESIDUAL_CREST, std::sqrt(window_.residual_largest / mean_square));
  }
  const double angle_step = window_.line_travel / window_.line_samples;
  if (window_.line_samples > 0 && tracker_.fit(angle_step))
  {
    tracked_ = tracker_.complete();
    const double slip = slip_ && window_.motor_encoder ? slip_->find(tracker_) : 0.0;
    slip > 0.0 ? fillLines(slip_->refit(slip, angle_step)) : fillLines(tracker_);
  }
  resetLines();
  loop_.reset();
  balance_.restart();
  lag_.restart();
  window_ = {};
}

void SignalMonitor::resetLines() noexcept
{
  tracker_.reset();
  if (slip_)
  {
    slip_->reset();
  }
}

void SignalMonitor::fillLines(const OrderTracker& tracker) noexcept
{
  fillLines(LineSignal::MOTOR_TORQUE, tracker);
  if (window_.motor_encoder)
  {
    fillLines(LineSignal::MOTOR_RIPPLE, tracker);
  }
  if (window_.both_encoders)
  {
    fillLines(LineSignal::KINEMATIC_ERROR, tracker);
  }
}

void SignalMonitor::fillLines(LineSignal signal, const OrderTracker& tracker) noexcept
{
  for (std::size_t line = 0; line < LINE_COUNT && hasLine(signal, line); ++line)
  {
    const LineFit fit = tracker.line(signal, line);
    if (!fit.valid)
    {
      continue;
    }
    const auto put = [&](std::size_t indicator, double value)
    {
      indicators_.values[indicator] = value;
      indicators_.uncertainty[indicator] = fit.error;
    };
    put(amplitudeIndex(signal, line), fit.amplitude());
    if (isPhaseLocked(line))
    {
      put(cosineIndex(signal, line), fit.cosine);
      put(sineIndex(signal, line), fit.sine);
    }
  }
}

void SignalMonitor::set(ScalarIndicator indicator, const Indicator& value) noexcept
{
  if (value.valid)
  {
    set(indicator, value.value);
  }
}
}  // namespace hjt
