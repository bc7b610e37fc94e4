// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "elements/presliding.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Share of the friction that is mobilised, between -1 and 1: after a reversal it builds up over a presliding angle
/// (`mobilised`, by the motor's angle). Two of them add up. The contacts' builds up over telemetry.presliding_angle.
/// While the joint stands the motion does not tell it, and it forgets the last one within RELAXATION, as the current of
/// standing joints does (UR5 CB series, K. Kufieta, NTNU 2014: 5 to 10 s). The lasting part, telemetry.lasting_share of
/// the whole, builds up over LASTING_ANGLE, so that the encoder's noise at standstill hardly changes it, and remains.
class Presliding
{
public:
  static constexpr double RELAXATION = 5.0;     ///< [s]
  static constexpr double LASTING_ANGLE = 0.4;  ///< of the motor [rad]

  explicit Presliding(const TelemetryParameters& parameters)
    : angle_(parameters.presliding_angle), lasting_share_(parameters.lasting_share)
  {
  }

  /// The motor turned by this much [rad] within [s]
  void move(double motor_step, double duration) noexcept
  {
    contacts_ = mobilised(contacts_ * std::exp(-duration / RELAXATION), motor_step, angle_);
    lasting_ = mobilised(lasting_, motor_step, LASTING_ANGLE);
  }

  void reset() noexcept { contacts_ = lasting_ = 0.0; }

  double share() const noexcept { return (1.0 - lasting_share_) * contacts_ + lasting_share_ * lasting_; }
  double contacts() const noexcept { return contacts_; }  ///< of the contacts alone
  double lasting() const noexcept { return lasting_; }    ///< of the lasting part alone

private:
  double angle_;
  double lasting_share_;
  double contacts_{};
  double lasting_{};
};
}  // namespace hjt
