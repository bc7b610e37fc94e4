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
  double mass{};                              ///< mass at the flange that fits the currents best [kg]
  double mass_half_width{};                   ///< half width of the mass's 95 % interval [kg]
  std::array<double, 3> moment{};             ///< mass x centre of mass, in the frame of the tip [kg.m]
  std::array<double, 3> moment_half_width{};  ///< half widths of the moments' 95 % intervals [kg.m]
  double least_claim{};                       ///< mass that an arm with these links can show without a payload [kg]

  /// Whether `mass` differs from the configured mass by more than its half width and by more than `least_claim`.
  bool differs() const;
  bool isCarried() const { return mass > mass_half_width; }  ///< whether the 95 % interval of the mass lies above zero
  /// Whether differs() is true, and the currents show a mass above zero, or no mass although a payload is configured.
  bool isOther() const;
  Payload payload() const;  ///< the payload with its centre of mass; a payload without mass if isCarried() is false
  /// The clause "the currents show a payload of ... at the flange, but ... kg is configured. ...".
  std::string text() const;
};

/// The mounting of an arm: the direction of gravity that the arm's currents show, and the configured direction.
struct IdentifiedMounting
{
  std::array<double, 3> configured{};  ///< configured gravity in the frame of the base [m/s^2]
  std::array<double, 3> gravity{};     ///< gravity in the found direction, of the configured size [m/s^2]
  double half_width{};                 ///< half width of the direction's 95 % interval [rad]
  double size{ 1.0 };                  ///< size of the gravity that fits best, over the configured size [-]

  double tilt() const;  ///< angle between configured and found gravity [rad]
  /// Whether the tilt is significant and larger than in arms whose mounting is configured right, while the found size
  /// is within the errors of the configured size.
  bool differs() const;
  std::string text() const;  ///< the clause "the mounting differs from the configured one: gravity is tilted by ..."
};

/// A force on the tip against the motion of the tip, for example of a cable or of a tool that rubs.
struct FoundDrag
{
  double force{};       ///< size of the force [N]
  double half_width{};  ///< half width of the force's 95 % interval [N]

  bool exists() const;  ///< whether the whole interval of the force lies above 3 N
  /// The clause "the currents show a force of ... on the tool against its motion: ...".
  std::string text() const;
};

/// A change from the found payload to another payload, or from another payload to the found one.
struct PayloadChange
{
  double time{};    ///< time of the change [s]
  bool is_found{};  ///< whether the arm carries the found payload from `time` on
};

/// The load of an arm, as its currents show it.
struct FoundLoad
{
  IdentifiedPayload payload;
  IdentifiedMounting mounting;
  IdentifiedPayload otherwise{};         ///< payload in the legs in which the arm does not carry `payload`
  std::vector<PayloadChange> changes{};  ///< changes in the order of time, the first one at the first row; empty: none
  double since{ -HUGE_VAL };             ///< time from which on the arm carries the payload; -infinity: in all rows [s]
  FoundDrag drag{};
  std::vector<FittedFriction> frictions{};  ///< friction of each joint

  double gain{};             ///< factor of all currents that load and friction do not explain - 1 [-]
  double gain_half_width{};  ///< half width of the gain's 95 % interval [-]

  /// Says why no joint can be judged: the currents of all joints differ from the expected currents by a factor that
  /// gains of one type do not have. Returns an empty misfit if there is no such factor.
  Misfit misfit() const;
  /// This load with only the payload after the last change. `since` is the time of that change.
  FoundLoad last() const;
};

/// The load that replaces the configured load, because the currents show it.
struct AssumedLoad
{
  std::optional<IdentifiedPayload> payload;
  std::optional<IdentifiedMounting> mounting;
  std::optional<FoundDrag> drag;
  std::optional<IdentifiedPayload> otherwise;  ///< payload at the times without `payload`; none: the configured payload
  std::vector<PayloadChange> changes{};        ///< changes between `payload` and `otherwise`, as in FoundLoad
  double since{ -HUGE_VAL };                   ///< time from which on the arm carries the payload [s]

  bool isConfigured() const { return !payload && !mounting && !drag; }
  std::string text() const;                   ///< sentences on the load; empty: the load is the configured one
  void configure(ArmDescription& arm) const;  ///< replaces the load of `arm` by this load
  /// Payloads of the arm over time; empty if the payload does not change.
  PayloadCourse course(const Payload& configured) const;
};

/// Results of an arm's joints with the present load.
struct JudgedJoints
{
  JudgedJoints() = default;
  /// `fit`: fit of the rows. `misfits`, `frictions`: one for each joint. `tolerance`: as in commonFriction().
  JudgedJoints(const RecordingFit& fit, std::vector<Misfit> misfits, std::vector<MeasuredFriction> frictions,
               double tolerance);

  std::vector<Misfit> misfits;  ///< misfit of each joint: that of the joint, or that of all joints
  std::vector<MeasuredFriction> frictions;
  std::vector<bool> measured;  ///< whether a joint has a measured current, so that it can check the load
  ArmFriction common;
};

/// Gives `misfit` to each joint that has no misfit in `misfits`.
void addMisfit(const Misfit& misfit, std::vector<Misfit>& misfits);

/// Rules by which another load replaces the configured one, for recordings and live telemetry alike. The class tries a
/// load that the currents show: a mounting, a drag, or a payload. A payload is tried only if a wrong load can cause all
/// misfits of the joints. The new load stays if no joint with a measured current has a misfit with this load. Otherwise
/// the previous load returns.
class LoadLaw
{
public:
  /// `found` and `joints`: results with the present load. If a load is on trial, the function uses only `joints`.
  /// Returns true if counts() is another load than before.
  bool take(const FoundLoad& found, const JudgedJoints& joints);

  const AssumedLoad& counts() const { return counts_; }
  bool isTrying() const { return is_trying_; }  ///< whether a load is on trial

private:
  std::optional<AssumedLoad> other(const FoundLoad& found, const JudgedJoints& joints) const;

  AssumedLoad counts_;
  AssumedLoad stands_;
  bool is_trying_{};
};
}  // namespace hjt
