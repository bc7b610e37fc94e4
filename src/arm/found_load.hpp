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
/// The payload that an arm's currents show.
struct IdentifiedPayload
{
  Payload configured;
  double mass{};                              ///< mass at the flange that fits best [kg]
  double mass_half_width{};                   ///< half width of the mass's 95 % interval [kg]
  std::array<double, 3> moment{};             ///< mass times centre, in the frame of the tip [kg.m]
  std::array<double, 3> moment_half_width{};  ///< half widths of the moments' 95 % intervals [kg.m]
  double least_claim{};                       ///< largest mass that sound arms of this mass show without a payload [kg]

  /// Whether the configured mass is outside the interval of the mass, and differs from the mass by more than
  /// `least_claim`.
  bool differs() const;
  /// Whether the 95 % interval of the mass lies above zero.
  bool isCarried() const { return mass > mass_half_width; }
  /// Whether the payload differs from the configured one, and is either a mass, or no mass although one is configured.
  bool isOther() const;
  /// The payload with its centre; without mass if it is not carried.
  Payload payload() const;
  /// "the currents show a payload of ... at the flange, not the configured ... kg. ...".
  std::string text() const;
};

/// The direction of gravity that an arm's currents show, beside the configured one: how the arm is mounted.
struct IdentifiedMounting
{
  std::array<double, 3> configured{};  ///< configured gravity in the frame of the base [m/s^2]
  std::array<double, 3> gravity{};     ///< gravity in the direction that was found, of the configured size [m/s^2]
  double half_width{};                 ///< half width of the direction's 95 % interval [rad]
  double size{ 1.0 };                  ///< size of the gravity that fits best over the configured size [-]

  double tilt() const;  ///< angle between configured and found gravity [rad]
  /// Whether the configured direction is far outside the interval, farther off than arms mounted as configured show,
  /// and the size that was found is that of gravity.
  bool differs() const;
  /// "the mounting differs from the configured one: gravity is tilted by ...", a clause.
  std::string text() const;
};

/// A force on the tip against the motion of the tip, for example of a cable or of a tool that rubs.
struct FoundDrag
{
  double force{};       ///< size of the force [N]
  double half_width{};  ///< half width of the force's 95 % interval [N]

  /// Whether the interval of the force lies beyond what sound arms show.
  bool exists() const;
  /// "the currents show a force of ... on the tool against its motion: ...", a clause.
  std::string text() const;
};

/// A time from which on the arm carries the payload that was found, or from which on it does not.
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
  IdentifiedPayload otherwise{};         ///< payload of the times at which `payload` is not carried
  std::vector<PayloadChange> changes{};  ///< in order of time, the first at the begin of the rows; empty: none
  double since{ -HUGE_VAL };             ///< begin of the rows that the load was found in [s]
  FoundDrag drag{};
  std::vector<FittedFriction> frictions{};  ///< friction of each joint

  double gain{};             ///< factor of all currents less 1, apart from load and friction [-]
  double gain_half_width{};  ///< half width of the gain's 95 % interval [-]

  /// Says why no joint can be judged: the currents of all joints differ from the expected ones by a factor that gains
  /// of one type do not have. Without such a factor there is no misfit.
  Misfit misfit() const;
  /// The same load with the last payload alone, and the time since which it is carried.
  FoundLoad last() const;
};

/// The load that counts in place of the configured one, because the currents show it.
struct AssumedLoad
{
  std::optional<IdentifiedPayload> payload;
  std::optional<IdentifiedMounting> mounting;
  std::optional<FoundDrag> drag;
  std::optional<IdentifiedPayload> otherwise;  ///< payload where `payload` is not carried; none: the configured one
  std::vector<PayloadChange> changes{};        ///< as FoundLoad::changes
  double since{ -HUGE_VAL };                   ///< time since which the payload is carried [s]

  bool isConfigured() const { return !payload && !mounting && !drag; }
  std::string text() const;                   ///< the load in sentences; empty if it is the configured one
  void configure(ArmDescription& arm) const;  ///< gives the load to an arm that has the configured one
  /// Payloads of the arm over time; empty if the payload does not change.
  PayloadCourse course(const Payload& configured) const;
};

/// The joints of an arm beside their twins, with the load that counts.
struct JudgedJoints
{
  JudgedJoints() = default;
  /// `fit` is that of the rows, and `frictions` were measured with `misfits`. `tolerance` is that of commonFriction.
  JudgedJoints(const RecordingFit& fit, std::vector<Misfit> misfits, std::vector<MeasuredFriction> frictions,
               double tolerance);

  std::vector<Misfit> misfits;  ///< misfit of each joint, or that of all joints
  std::vector<MeasuredFriction> frictions;
  std::vector<bool> measured;  ///< false for a joint without an effort; the load cannot be checked by such a joint
  ArmFriction common;
};

/// Gives the misfit to all joints that have no misfit yet.
void addMisfit(const Misfit& misfit, std::vector<Misfit>& misfits);

/// The law by which another load than the configured one counts, for recordings and live telemetry alike. A load that
/// the currents show is tried: a mounting, a drag, or a payload. A payload is tried only if all misfits of the joints
/// can be those of a wrong load. The load stands if every joint fits with it, else it is taken back.
class LoadLaw
{
public:
  /// `found` and `joints` are results with the load that counts; while a load is tried `found` is not used. Returns
  /// true if another load counts from now on.
  bool take(const FoundLoad& found, const JudgedJoints& joints);

  const AssumedLoad& counts() const { return counts_; }
  /// Whether the trial of a found load has not ended yet.
  bool isTrying() const { return is_trying_; }

private:
  std::optional<AssumedLoad> other(const FoundLoad& found, const JudgedJoints& joints) const;

  AssumedLoad counts_;
  AssumedLoad stands_;
  bool is_trying_{};
};
}  // namespace hjt
