// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Motor with its amplifier: torque at the shaft for a commanded torque.
///
/// The torque limit clamps the command. Over the last two per cent before the speed limit, an accelerating torque, but
/// no braking torque, decreases linearly to zero. The current has a first-order lag.
///
/// Shaft:   T (1 + r sin 6 p theta) - T_c sin n theta; the second term derives from U = -(T_c / n) cos n theta
/// where    theta  motor angle                                                                        [rad]
///          T    torque without ripple, T_25 (1 + a (temperature - 25 degC)), T_25 = torque at 25 degC [N.m]
///          a    motor.torque_temperature_coefficient                                                 [1/K]
///          r    ripple at six times the electrical frequency, p pairs of poles                       [-]
///          T_c  amplitude of the cogging torque, n periods in a turn                                 [N.m]
class Motor
{
public:
  explicit Motor(const MotorParameters& parameters) : parameters_(parameters) {}

  /// Commanded torque after the torque limit [N.m].
  double clamped(double command) const noexcept
  {
    return std::clamp(command, -parameters_.torque_limit, parameters_.torque_limit);
  }

  /// Whether the speed limit reduces `torque` [N.m] at `speed` [rad/s].
  bool fades(double torque, double speed) const noexcept
  {
    return torque * speed > 0.0 && std::abs(speed) > fadeSpeed();
  }
  /// speed above which the speed limit reduces the torque [rad/s]
  double fadeSpeed() const noexcept { return (1.0 - FADE) * parameters_.speed_limit; }
  double speedLimit() const noexcept { return parameters_.speed_limit; }  ///< speed limit of the motor [rad/s]

  /// Reduced accelerating torque at a speed near the speed limit [N.m]: faded(T, 0) - fadeSlope(T) |speed|, at least 0.
  double faded(double torque, double speed) const noexcept
  {
    return torque * std::max(1.0 - std::abs(speed) / parameters_.speed_limit, 0.0) / FADE;
  }
  double limited(double torque, double speed) const noexcept  ///< torque after the speed limit [N.m]
  {
    return fades(torque, speed) ? faded(torque, speed) : torque;
  }
  double fadeSlope(double torque) const noexcept  ///< decrease of `faded` with speed [N.m.s/rad]
  {
    return std::abs(torque) / (FADE * parameters_.speed_limit);
  }

  /// Share of a difference between actual and wanted torque that remains after `time` [s] [-].
  double currentLeft(double time) const noexcept
  {
    return parameters_.current_bandwidth > 0.0 ? std::exp(-currentRate() * time) : 0.0;
  }
  /// inverse time constant of the current's lag; 0: no lag [rad/s]
  double currentRate() const noexcept { return TWO_PI * parameters_.current_bandwidth; }

  /// Torque at a temperature [degC] over the torque of an equal current at 25 degC [-].
  double torqueFactor(double temperature) const noexcept
  {
    constexpr double REFERENCE = 25.0;  // temperature at which the factor is 1 [degC]
    return 1.0 + parameters_.torque_temperature_coefficient * (temperature - REFERENCE);
  }

  /// Torque with its ripple at a motor angle [N.m].
  double rippled(double torque, double angle) const noexcept
  {
    return parameters_.torque_ripple == 0.0 ?
               torque :
               torque * (1.0 + parameters_.torque_ripple * std::sin(6 * parameters_.pole_pairs * angle));
  }

  /// Energy of cogging [J]. coggingTorque [N.m]; coggingStiffness: largest second derivative of the energy [N.m/rad].
  double coggingEnergy(double angle) const noexcept
  {
    return cogs() ? -parameters_.cogging_torque / parameters_.cogging_periods *
                        std::cos(parameters_.cogging_periods * angle) :
                    0.0;
  }
  double coggingTorque(double angle) const noexcept
  {
    return cogs() ? -parameters_.cogging_torque * std::sin(parameters_.cogging_periods * angle) : 0.0;
  }
  double coggingStiffness() const noexcept { return parameters_.cogging_torque * parameters_.cogging_periods; }

  double inertia() const noexcept { return parameters_.rotor_inertia + parameters_.wave_generator_inertia; }
  /// Dry friction of the motor at a speed, by a Gaussian Stribeck curve [N.m].
  double dryTorque(double speed) const noexcept { return parameters_.coulomb_torque + stribeckTorque(speed); }
  double stribeckTorque(double speed) const noexcept
  {
    const double relative = speed / parameters_.stribeck_velocity;
    return parameters_.stribeck_torque > 0.0 ? parameters_.stribeck_torque * std::exp(-relative * relative) : 0.0;
  }
  /// turn over which the friction at rest builds up; 0: friction holds the shaft exactly [rad]
  double preslidingAngle() const noexcept { return parameters_.presliding_angle; }
  double viscousFriction() const noexcept { return parameters_.viscous_friction; }

private:
  static constexpr double FADE = 0.02;  // range in which the torque decreases, over the speed limit [-]

  bool cogs() const noexcept { return parameters_.cogging_torque != 0.0; }

  MotorParameters parameters_;
};

/// Brake on the motor's shaft: a pin that engages between the teeth of a star and slips above the holding torque.
///
/// The engaged brake leaves the shaft free within the play b. At each end of the play it holds the shaft:
///   |theta - theta_p| <= b/2, theta  motor angle, theta_p  middle of the play, which moves when the brake slips  [rad]
/// The brake engages in the middle of the play. Without play it holds at once in both directions.
class Brake
{
public:
  explicit Brake(const BrakeParameters& parameters)
    : holding_torque_(parameters.holding_torque), half_play_(0.5 * parameters.play)
  {
  }

  bool hasPlay() const noexcept { return half_play_ > 0.0; }

  struct Pin
  {
    double middle{};  ///< motor angle at the middle of the play [rad]
    double angle{};   ///< motor angle at the preceding update [rad]
    bool touches{};   ///< whether the shaft touched the pin at the preceding update
  };

  /// Moves the middle of the play if the brake slips. `angle`: motor angle [rad]; `push`: sign of the motor's speed or,
  /// at rest, of the torque on the motor. @returns the holding torque in the step around this instant [N.m].
  double hold(bool engaged, double angle, double push, Pin& pin) const noexcept
  {
    if (!engaged)
    {
      pin = { angle, angle, true };
      return 0.0;
    }
    const auto play_left = [&] { return half_play_ - (push < 0.0 ? pin.middle - angle : angle - pin.middle); };
    const double moved = std::abs(angle - pin.angle);
    const double beyond = std::max(-play_left(), 0.0);
    pin.angle = angle;
    pin.middle = std::clamp(pin.middle, angle - half_play_, angle + half_play_);
    const bool met = !pin.touches;
    pin.touches = play_left() <= CONTACT * half_play_;
    // If the shaft met the pin after the last update, the pin holds it from this contact until half a step after now.
    const double share = met && half_play_ > 0.0 && moved > beyond ? 0.5 + beyond / moved : 1.0;
    return pin.touches ? share * holding_torque_ : 0.0;
  }

private:
  // gap between shaft and pin that counts as rounding, over half the play [-]
  static constexpr double CONTACT = 1e-9;

  double holding_torque_;  // torque above which the brake slips [N.m]
  double half_play_;       // half of the play b [rad]
};
}  // namespace hjt
