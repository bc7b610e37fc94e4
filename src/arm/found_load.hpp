// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "arm/arm_description.hpp"
#include "arm/recording_fit.hpp"
#include "tracking/common_friction.hpp"
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

/// The load that counts in place of the configured one, since the currents show it.
struct AssumedLoad
{
  std::optional<IdentifiedPayload> payload;
  std::optional<IdentifiedMounting> mounting;
  std::optional<FoundDrag> drag;
  std::optional<IdentifiedPayload> otherwise;  ///< where `payload` is not carried; none: the configured one
  std::vector<PayloadChange> changes{};        ///< as of FoundLoad
  double since{ -HUGE_VAL };                   ///< that the payload is carried [s]

  bool isConfigured() const { return !payload && !mounting && !drag; }
  std::string text() const;                   ///< in sentences; empty: as configured, all the time
  void configure(ArmDescription& arm) const;  ///< of an arm with the configured load
  /// Payloads over time of an arm with the configured payload; empty: one all the time.
  PayloadCourse course(const Payload& configured) const;
};

/// The joints of an arm beside their twins, with the load that counts.
struct JudgedJoints
{
  JudgedJoints() = default;
  /// `fit`: of the rows. `frictions`: measured with the misfits of `misfits`. @param tolerance as of commonFriction
  JudgedJoints(const RecordingFit& fit, std::vector<Misfit> misfits, std::vector<MeasuredFriction> frictions,
               double tolerance);

  std::vector<Misfit> misfits;  ///< of each, or what all have in common
  std::vector<MeasuredFriction> frictions;
  std::vector<bool> measured;  ///< false: the joint gives no effort, so it says nothing of the load
  ArmFriction common;
};

/// Of the joints that have none.
void addMisfit(const Misfit& misfit, std::vector<Misfit>& misfits);

/// The law by which the load is another than configured, of a recording and live alike. What the currents show is
/// tried: a mounting, a drag, and, where nothing but what a load makes too stands against a joint, a payload, since it
/// explains no telemetry that does not fit. It stands where every joint fits with it, else it is taken back.
class LoadLaw
{
public:
  /// `found`: beside the load that counts, and so are `joints`; while a load is tried it is not looked at. True:
  /// another counts from now on.
  bool take(const FoundLoad& found, const JudgedJoints& joints);

  const AssumedLoad& counts() const { return counts_; }
  /// Whether a load that was found is still on trial.
  bool isTrying() const { return is_trying_; }

private:
  std::optional<AssumedLoad> other(const FoundLoad& found, const JudgedJoints& joints) const;

  AssumedLoad counts_;
  AssumedLoad stands_;
  bool is_trying_{};
};
}  // namespace hjt
