// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "arm/found_load.hpp"
#include "arm/payload_course.hpp"
#include "arm/recording_fit.hpp"
#include "tracking/common_friction.hpp"

namespace hjt
{
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
