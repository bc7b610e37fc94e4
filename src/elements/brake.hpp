// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
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
