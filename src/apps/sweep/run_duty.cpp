// SPDX-License-Identifier: BSD-3-Clause
#include "apps/sweep/run_duty.hpp"

#include "gear/angle.hpp"
#include "gear/ratio.hpp"

namespace hjt
{
DutyFeeder::DutyFeeder(const RunDuty& duty, const Twin& twin)
  : duty_(duty), ratio_(nominalRatio(twin.parameters().gear))
{
  const Parameters& p = twin.parameters();
  motor_inertia_ = p.motor.rotor_inertia + p.motor.wave_generator_inertia;
  inertia_ = motor_inertia_ + (p.output.circular_spline_inertia + p.output.load_inertia) / (ratio_ * ratio_);
}

void DutyFeeder::feed(Twin& twin, double time)
{
  const Stamp instant = twin.stamp() + twin.stepLength();
  twin.commandMotorTorque(instant, duty_.torque ? duty_.torque->value(time) : controlTorque(twin, time));
  if (duty_.load)
  {
    const double load = duty_.load->value(time);
    if (load != last_load_)
    {
      twin.commandLoadTorque(instant, load);
      last_load_ = load;
    }
  }
  if (duty_.temperature)
  {
    twin.setTemperature(instant, duty_.temperature->value(time));
  }
}

double DutyFeeder::controlTorque(const Twin& twin, double time)
{
  const double frequency = TWO_PI * duty_.bandwidth;
  const double speed = duty_.speed->value(time);
  angle_reference_ += 0.5 * (speed + speed_reference_) * (time - last_time_);
  speed_reference_ = speed;
  last_time_ = time;
  const EncoderReadings read = twin.encoders();
  return inertia_ * ratio_ * duty_.speed->slope(time) +
         motor_inertia_ * (2.0 * frequency * (ratio_ * speed - read.motor_velocity) +
                           frequency * frequency * (ratio_ * angle_reference_ - read.motor_angle));
}
}  // namespace hjt
