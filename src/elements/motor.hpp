// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Motor with its drive: what of a commanded torque reaches the shaft.
///
/// The command is clamped at the torque limit. Towards the speed limit the torque that would speed the motor up further
/// fades out linearly over the last two per cent; braking torque is never held back. The current follows what is left
/// with a lag of first order.
///
/// Shaft:   T (1 + r sin 6 p theta) - T_c sin n theta, the second from U = -(T_c / n) cos n theta
/// where    T    torque of the drive, T_25 (1 + a (temperature - 25 degC)), T_25 that of its current  [N.m]
///          r    ripple six times per electrical period, p pairs of poles                             [-]
///          T_c  cogging, n times a turn                                                              [N.m]
class Motor
{
public:
  explicit Motor(const MotorParameters& parameters) : parameters_(parameters) {}

  /// A command within the torque limit [N.m].
  double clamped(double command) const noexcept
  {
    return std::clamp(command, -parameters_.torque_limit, parameters_.torque_limit);
  }

  /// The speed limit holds back a torque at a speed.
  bool fades(double torque, double speed) const noexcept
  {
    return torque * speed > 0.0 && std::abs(speed) > fadeSpeed();
  }
  double fadeSpeed() const noexcept { return (1.0 - FADE) * parameters_.speed_limit; }  ///< where that begins [rad/s]
  double speedLimit() const noexcept { return parameters_.speed_limit; }                ///< [rad/s]

  /// Torque that fades with the speed [N.m]: faded(T, 0) - fadeSlope(T) |speed|, and not below zero.
  double faded(double torque, double speed) const noexcept
  {
    return torque * std::max(1.0 - std::abs(speed) / parameters_.speed_limit, 0.0) / FADE;
  }
  double limited(double torque, double speed) const noexcept  ///< a torque, held back or not [N.m]
  {
    return fades(torque, speed) ? faded(torque, speed) : torque;
  }
  double fadeSlope(double torque) const noexcept  ///< [N.m.s/rad]
  {
    return std::abs(torque) / (FADE * parameters_.speed_limit);
  }

  /// Share of a difference between the torque and the one wanted that is left after a time [s].
  double currentLeft(double time) const noexcept
  {
    return parameters_.current_bandwidth > 0.0 ? std::exp(-currentRate() * time) : 0.0;
  }
  double currentRate() const noexcept { return TWO_PI * parameters_.current_bandwidth; }  ///< 0: at once [rad/s]

  /// Torque over the one of the same current at 25 degC [-].
  double torqueFactor(double temperature) const noexcept
  {
    constexpr double REFERENCE = 25.0;  // [degC]
    return 1.0 + parameters_.torque_temperature_coefficient * (temperature - REFERENCE);
  }

  /// The drive's torque with its ripple at an angle of the motor [N.m].
  double rippled(double torque, double angle) const noexcept
  {
    return parameters_.torque_ripple == 0.0 ?
               torque :
               torque * (1.0 + parameters_.torque_ripple * std::sin(6 * parameters_.pole_pairs * angle));
  }

  /// Stored between magnets and slots; its torque and second derivative [J], [N.m], [N.m/rad].
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
  /// Dry friction at the shaft beyond the gear's, by speed (Stribeck, Gaussian as of the flanks) [N.m].
  double dryTorque(double speed) const noexcept { return parameters_.coulomb_torque + stribeckTorque(speed); }
  double stribeckTorque(double speed) const noexcept
  {
    const double relative = speed / parameters_.stribeck_velocity;
    return parameters_.stribeck_torque > 0.0 ? parameters_.stribeck_torque * std::exp(-relative * relative) : 0.0;
  }
  double preslidingAngle() const noexcept { return parameters_.presliding_angle; }  ///< 0: stiction is exact [rad]
  double viscousFriction() const noexcept { return parameters_.viscous_friction; }

private:
  static constexpr double FADE = 0.02;  // share of the speed limit over which torque fades out

  bool cogs() const noexcept { return parameters_.cogging_torque != 0.0; }

  MotorParameters parameters_;
};

/// Brake on the motor's shaft: a pin between the teeth of a star that slips above a torque.
///
/// While engaged the shaft is free within the play b, and held with the holding torque where it leans on the pin:
///   |theta - theta_p| <= b/2, theta_p the middle of the play, which moves with a shaft that slips    [rad]
/// It engages in the middle of the play. Without play it holds at once, in both directions.
class Brake
{
public:
  explicit Brake(const BrakeParameters& parameters)
    : holding_torque_(parameters.holding_torque), half_play_(0.5 * parameters.play)
  {
  }

  bool hasPlay() const noexcept { return half_play_ > 0.0; }

  /// Position of the brake's pin.
  struct Pin
  {
    double middle{};  ///< of the play, as an angle of the motor [rad]
    double angle{};   ///< of the motor when it was looked at last [rad]
    bool touches{};   ///< the shaft leaned on it then
  };

  /// Moves the pin with the shaft. @returns the torque that the shaft is held with against its motion over the step
  /// around this instant [N.m]. `push`: sign of the shaft's motion, or of the torque on a shaft at rest.
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
    // A shaft that has met the pin since the last step is held from then on, and half a step from now.
    const double share = met && half_play_ > 0.0 && moved > beyond ? 0.5 + beyond / moved : 1.0;
    return pin.touches ? share * holding_torque_ : 0.0;
  }

private:
  static constexpr double CONTACT = 1e-9;  // rounding error of the play where the shaft leans on the pin [-]

  double holding_torque_;  // [N.m]
  double half_play_;       // [rad]
};
}  // namespace hjt
