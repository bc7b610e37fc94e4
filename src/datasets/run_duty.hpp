// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <memory>

#include "datasets/waveform.hpp"

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"

namespace hjt
{
/// Duty of a run: a motor torque, or a speed that a drive's control holds; load and temperature.
struct RunDuty
{
  std::shared_ptr<const Waveform> torque;       ///< of the motor [N.m]; none: speed is controlled
  std::shared_ptr<const Waveform> speed;        ///< of the joint [rad/s]
  double bandwidth{};                           ///< of the speed control [Hz]
  std::shared_ptr<const Waveform> load;         ///< external torque at the output [N.m]; none: none
  std::shared_ptr<const Waveform> temperature;  ///< of the drive [degC]; none: input.temperature throughout
  double easing{};  ///< over which torque, speed and load come in, as half a cosine: a step would ring for seconds [s]
};

/// Gives the twin its commands of a duty cycle, step by step.
///
/// The speed control works as a drive's does, from the motor encoder's readings:
///        T = J a + 2 w J_m (v_r - v) + w^2 J_m (x_r - x)
/// where  J    inertia of motor and joint, seen by the motor      [kg.m^2]
///        J_m  of the motor alone: above the drive's resonance the joint stands still, and a gain for both would be
///             too high there                                     [kg.m^2]
///        w    2 pi times the bandwidth                           [rad/s]
///        a, v_r, x_r   references of acceleration, speed, angle; v, x as read   [rad/s^2], [rad/s], [rad], motor side
class DutyFeeder
{
public:
  DutyFeeder(const RunDuty& duty, const Twin& twin) : duty_(duty), ratio_(nominalRatio(twin.parameters().gear))
  {
    const Parameters& p = twin.parameters();
    motor_inertia_ = p.motor.rotor_inertia + p.motor.wave_generator_inertia;
    inertia_ = motor_inertia_ + (p.output.circular_spline_inertia + p.output.load_inertia) / (ratio_ * ratio_);
  }

  /// Before the step that ends `time` [s] after the start.
  void feed(Twin& twin, double time)
  {
    const Stamp begin = twin.stamp();
    const double middle = time - 0.5 * toSeconds(twin.stepLength());  // an input has its mean over the step
    twin.commandMotorTorque(begin,
                            duty_.torque ? easedIn(middle) * duty_.torque->value(middle) : controlTorque(twin, time));
    if (duty_.load)
    {
      const double load = easedIn(middle) * duty_.load->value(middle);
      if (load != last_load_)
      {
        twin.commandLoadTorque(begin, load);
        last_load_ = load;
      }
    }
    if (duty_.temperature)
    {
      twin.setTemperature(begin, duty_.temperature->value(time));
    }
  }

  double speedReference() const { return speed_reference_; }  ///< joint side [rad/s]; zero where a torque is given

private:
  double easedIn(double time) const
  {
    return time < duty_.easing ? 0.5 - 0.5 * std::cos(PI * time / duty_.easing) : 1.0;
  }

  double controlTorque(const Twin& twin, double time)
  {
    const double frequency = TWO_PI * duty_.bandwidth;
    const double full_speed = duty_.speed->value(time);
    const double eased = easedIn(time);
    const double easing_slope =
        time < duty_.easing ? 0.5 * PI / duty_.easing * std::sin(PI * time / duty_.easing) : 0.0;
    const double acceleration = eased * duty_.speed->slope(time) + easing_slope * full_speed;
    const double speed = eased * full_speed;
    angle_reference_ += 0.5 * (speed + speed_reference_) * (time - last_time_);
    speed_reference_ = speed;
    last_time_ = time;
    const EncoderReadings read = twin.encoders();
    return inertia_ * ratio_ * acceleration +
           motor_inertia_ * (2.0 * frequency * (ratio_ * speed - read.motor_velocity) +
                             frequency * frequency * (ratio_ * angle_reference_ - read.motor_angle));
  }

  RunDuty duty_;
  double ratio_;
  double motor_inertia_;  // [kg.m^2]
  double inertia_;        // of motor and joint [kg.m^2]
  double last_load_{};
  double last_time_{};
  double angle_reference_{};  // joint side [rad]
  double speed_reference_{};
};
}  // namespace hjt
