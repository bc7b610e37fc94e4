// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tracking/common_friction.hpp"
#include "tracking/friction_verdict.hpp"
#include "tracking/joint_evidence.hpp"

namespace hjt
{
/// Figures of the same joint in sound condition.
struct OwnReference
{
  std::vector<FrictionPoint> friction;                                  ///< none: not known
  double compliance_ratio{ std::numeric_limits<double>::quiet_NaN() };  ///< NaN: not known
  double temperature{ std::numeric_limits<double>::quiet_NaN() };       ///< judged at; NaN: not known [degC]
  double friction_deviation{};    ///< of the friction, by its scatter, standard deviation as a share [-]
  std::size_t recordings{ 1 };    ///< that it is of
  double recordings_deviation{};  ///< standard deviation of one of them, as a share [-]
  bool is_unjudged{};             ///< there is a recording, but it did not show the joint's friction
};

/// What is known of a joint besides its samples.
struct JointContext
{
  OwnReference own;
  bool is_identified{};  ///< the twin's friction is that of this joint
  double duration{};     ///< of the recording [s]
  /// Multiple of the reference's friction by what the joints of an arm have in common: temperature or gain, no fault.
  double arm_friction{ 1.0 };
  std::string misfit;                   ///< why the rows say nothing of this joint; empty: it fits
  double arm_deviation{ UNWITNESSED };  ///< of `arm_friction`, standard deviation of its logarithm
};

/// One thing that was judged, in words.
struct Finding
{
  HealthLevel level{};
  bool judged{};  ///< false: the text says why not
  std::string title;
  std::string text;
  std::vector<Cause> causes;  ///< that would show like this; none at level OK
};

/// A clause as a sentence.
std::string sentence(std::string clause);

constexpr const char* NOT_JUDGED = "NOT JUDGED";

/// Findings of a measured joint.
struct Verdict
{
  HealthLevel level{};
  bool judged{};       ///< false: no finding is
  std::string reason;  ///< in a sentence or two
  std::vector<Finding> findings;
  double highest_order{};  ///< of the motor's turn that the rows resolve at the highest speed; 0: it does not move [-]
  std::vector<std::string> cannot_show;  ///< by this recording, each with the reason
};

/// For people and documents.
inline const char* verdictName(const Verdict& verdict)
{
  return verdict.judged ? levelName(verdict.level) : NOT_JUDGED;
}

/// `deviation` as a share, beyond `tolerance`: WARN, and beyond `error_factor` times it: ERROR.
HealthLevel levelOf(double deviation, double tolerance, double error_factor);

/// Live and offline alike.
Verdict judge(const JointEvidence& evidence, const Parameters& parameters, const JointContext& context);

/// Where the temperature that a joint was judged at is from, for people and documents.
inline const char* temperatureSource(const JointEvidence& evidence)
{
  return evidence.isTemperatureReceived() ? "received" : "configured";
}

/// What the rows show of the friction, as a multiple of the joint's own when sound, else of the twin's. The evidence
/// must outlive it.
MeasuredFriction measuredFriction(const JointEvidence& evidence, const Parameters& parameters,
                                  const JointContext& context);
}  // namespace hjt
