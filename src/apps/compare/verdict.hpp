// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "apps/compare/recording_comparison.hpp"

namespace hjt
{
/// Figures of the same joint in sound condition.
struct OwnReference
{
  std::vector<FrictionPoint> friction;                                  ///< none: not known
  double compliance_ratio{ std::numeric_limits<double>::quiet_NaN() };  ///< NaN: not known
  double temperature{ std::numeric_limits<double>::quiet_NaN() };       ///< judged at; NaN: not known [degC]
};

/// Where the load of the samples comes from.
enum class LoadOrigin
{
  CONFIGURED,  ///< weight and inertia of the joint's parameters
  RECORDED,
  ARM  ///< links and payload, by rigid-body dynamics
};

/// What is known of a joint besides its samples.
struct JointContext
{
  OwnReference own;
  bool is_identified{};  ///< the twin's friction is that of this joint
  LoadOrigin load{};
  double duration{};  ///< of the recording [s]
  /// Multiple of the reference's friction by what the joints of an arm have in common: temperature or gain, no fault.
  double arm_friction{ 1.0 };
  std::string misfit;  ///< why the recording says nothing of this joint; empty: it fits
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

/// Findings of a recording.
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

Verdict judge(const RecordingComparison& comparison, const Parameters& parameters, const JointContext& context);

/// Where the temperature that a joint was judged at is from, for people and documents.
inline const char* temperatureSource(const RecordingComparison& comparison)
{
  return comparison.isTemperatureReceived() ? "received" : "configured";
}

/// Friction as a multiple of the joint's own when sound, else of the twin's; none: the recording does not show it.
std::optional<double> frictionRatio(const RecordingComparison& comparison, const Parameters& parameters,
                                    const JointContext& context);
}  // namespace hjt
