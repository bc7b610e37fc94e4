// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "arm/recording_fit.hpp"
#include "params/choices.hpp"
#include "recordings/arm_recording.hpp"

namespace hjt
{
/// How well an arm explains the currents of a recording.
struct ArmFit
{
  static constexpr double CLEARLY = 15.0;       ///< by which one is likelier, logarithm
  static constexpr double CONTRADICTED = 50.0;  ///< likewise, than the arm that is given: a joint's fault makes 40 too
  static constexpr double EXPLAINED = 0.35;     ///< of the currents left, at most, where an arm may be the one [-]

  std::string arm;
  EffortUnit unit{};  ///< of the efforts, that fits best
  double left{};      ///< of the currents of the moving joints, with the best payload and mounting, share, rms [-]
  double cost{};      ///< logarithm of a likelihood: less is likelier [-]

  /// `by`: logarithm by which it is likelier at least.
  bool isBetter(const ArmFit& other, double by) const { return left < EXPLAINED && cost < other.cost - by; }
};

/// Of the arms of these names, the best first: how each explains the first two minutes with the payload and the
/// mounting that fit it best, gains and friction within what drives of a type differ by, and the gains that the
/// recording states. @throws InputError, ParameterError.
std::vector<ArmFit> rankArms(const RecordingOptions& options, const std::vector<std::string>& names);

/// A shipped arm with these joints that explains the recording so much better that it contradicts its own, shipped
/// too; empty: none. A user's own file is taken at its word.
std::string betterArm(const ArmRecording& recording);
}  // namespace hjt
