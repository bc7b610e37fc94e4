// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <string>

#include "arm/arm_description.hpp"

namespace hjt
{
/// The payload that an arm's currents show, beside the configured one.
struct IdentifiedPayload
{
  Payload configured;
  double mass{};                              ///< [kg]
  double mass_half_width{};                   ///< of its 95 % interval [kg]
  std::array<double, 3> moment{};             ///< mass times centre, in the frame of the tip [kg.m]
  std::array<double, 3> moment_half_width{};  ///< of their 95 % intervals [kg.m]
  double least_claim{};                       ///< what sound arms of this mass show without a payload, at most [kg]
  double residual_share{ 1.0 };               ///< of the torques not predicted, that is left with it, rms [-]
  double share_of_gain{ 1.0 };                ///< likewise, if all currents are one multiple of what is predicted [-]

  /// The configured mass is outside the interval, and farther off than arms without a payload show.
  bool differs() const;
  /// It is a mass at all.
  bool isCarried() const { return mass > mass_half_width; }
  /// It differs, and is a mass, or none where one is configured.
  bool isOther() const;
  /// What it is, its centre where it has a mass.
  Payload payload() const;
  /// "the currents look like a payload of ... in place of the configured ...", a clause.
  std::string text() const;
};

/// The direction of gravity that an arm's currents show, beside the configured one: how the arm is mounted.
struct IdentifiedMounting
{
  std::array<double, 3> configured{};  ///< in the frame of the base [m/s^2]
  std::array<double, 3> gravity{};     ///< the direction found, of the configured size [m/s^2]
  double half_width{};                 ///< of its 95 % interval [rad]
  double size{ 1.0 };                  ///< of the gravity that fits best, over the configured [-]
  double residual_share{ 1.0 };        ///< of the torques not predicted, that is left with it, rms [-]
  /// Of the same rows: left with a payload, with another gain of all joints or of one of them, whichever leaves least.
  double share_otherwise{ 1.0 };

  double tilt() const;  ///< between the two [rad]
  /// The configured direction is far outside the interval, farther off than arms mounted as configured show, and what
  /// is found is gravity by its size.
  bool differs() const;
  /// "another mounting than configured: gravity looks tilted by ...", a clause.
  std::string text() const;
};

/// A part of the time in which the payload stays what it is.
struct LoadPart
{
  double begin{ -HUGE_VAL };  ///< [s]
  double end{ HUGE_VAL };     ///< [s]

  bool isAll() const { return std::isinf(begin) && std::isinf(end); }
  bool holds(double time) const { return time >= begin && time < end; }
  /// "from 12 s to 34 s"
  std::string text() const;
};

/// What the currents of an arm show of its load.
struct FoundLoad
{
  static constexpr double CLEARLY = 0.9;  ///< what is clearly better leaves less of the torques not predicted [-]

  IdentifiedPayload payload;
  IdentifiedMounting mounting;
  LoadPart part{};  ///< that they are of: another payload is carried before or after

  /// It explains the currents clearly better than the load as it counts, and another mounting does not as well.
  bool showsPayload() const;
  /// It explains the currents clearly better than the load as it counts, and than what else may be the reason.
  bool showsMounting() const;
};
}  // namespace hjt
