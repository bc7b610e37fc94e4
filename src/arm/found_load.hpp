// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "arm/arm_description.hpp"
#include "tracking/reason.hpp"

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
  double least_claim{};                       ///< largest mass that sound arms of this mass show without a payload [kg]

  /// The configured mass is outside the interval, and farther off than arms without a payload show.
  bool differs() const;
  /// It is a mass at all.
  bool isCarried() const { return mass > mass_half_width; }
  /// It differs, and is a mass, or none where one is configured.
  bool isOther() const;
  /// The payload in words, with its centre where it has a mass.
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

  double tilt() const;  ///< between the two [rad]
  /// The configured direction is far outside the interval, farther off than arms mounted as configured show, and what
  /// is found is gravity by its size.
  bool differs() const;
  /// "another mounting than configured: gravity looks tilted by ...", a clause.
  std::string text() const;
};

/// A force on the tip against its motion, as of a cable or of a tool that rubs.
struct FoundDrag
{
  double force{};       ///< [N]
  double half_width{};  ///< of its 95 % interval [N]

  /// Its interval lies beyond what sound arms show.
  bool exists() const;
  /// "the currents look like a force of ... on the tool against its motion: ...", a clause.
  std::string text() const;
};

/// From a time on the arm carries the payload that was found, or what it carries else.
struct PayloadChange
{
  double time{};  ///< [s]
  bool is_found{};
};

/// Load of an arm as its currents show it.
struct FoundLoad
{
  IdentifiedPayload payload;
  IdentifiedMounting mounting;
  IdentifiedPayload otherwise{};         ///< carried before, after and between, where `payload` is not
  std::vector<PayloadChange> changes{};  ///< in their order, the first at the begin of the rows; empty: none
  double since{ -HUGE_VAL };             ///< the rows that it is of [s]
  FoundDrag drag{};
  std::vector<FittedFriction> frictions{};  ///< of each joint

  double gain{};             ///< of all currents beside 1, apart from load and friction [-]
  double gain_half_width{};  ///< of its 95 % interval [-]

  /// Why no joint can be judged: the currents of all are another multiple than those of gains of one type.
  Misfit misfit() const;
  /// The last payload, taken as constant, and since when it is carried.
  FoundLoad last() const;
};
}  // namespace hjt
