// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tracking/joint_evidence.hpp"

namespace hjt
{
struct JointContext;
struct Finding;
struct OwnReference;

constexpr double LEAST_MOTION = 0.02;  ///< a joint whose angles differ by less does not move [rad]

/// Why the friction of a joint is not judged.
enum class FrictionGap
{
  NONE,  ///< it is
  AT_REST,
  NO_STEADY_MOTION,
  OTHER_SPEEDS,  ///< the reference has none of these speeds
  ONE_DIRECTION,
  ONE_SPEED,
  TOO_SHORT,
  NO_FRICTION,   ///< the effort holds none: a modelled torque
  BELOW_FAULTS,  ///< less than any fault leaves: led by hand, held, another gain
  PUSHES,        ///< it would push the joint along
  SCATTER        ///< the rows scatter too much: the load is another
};

/// Friction of a joint as a multiple of its own when sound, or of the twin's, with what is known of its error
/// (docs/compare.md).
struct FrictionFactor
{
  double value{ std::numeric_limits<double>::quiet_NaN() };  ///< NaN: the rows show none
  double deviation{};                                        ///< standard deviation of its logarithm [-]
  double scatter{};                                          ///< the part of it that the rows' scatter makes [-]
  bool is_to_own{};                                          ///< a multiple of the joint's own, else of the twin's
  bool is_below_faults{};                                    ///< less than any fault leaves of it
  FrictionGap gap{};
  std::string why_not;  ///< the gap in a sentence; empty: none

  bool isJudged() const { return gap == FrictionGap::NONE; }
  /// Ends of the 95 % interval.
  double low() const { return value * std::exp(-halfWidth()); }
  double high() const { return value * std::exp(halfWidth()); }

private:
  double halfWidth() const
  {
    constexpr double NORMAL_95 = 1.96;
    return NORMAL_95 * deviation;
  }
};

/// "1.18 [1.05, 1.32]"
std::string factorText(const FrictionFactor& factor);

/// Of the rows that the evidence holds, apart from what the joints of the arm have in common.
FrictionFactor frictionFactor(const JointEvidence& evidence, const JointContext& context);

/// Friction of a sound joint in one recording.
struct SoundFriction
{
  std::vector<FrictionPoint> points;
  double deviation{};  ///< by the scatter, standard deviation as a share [-]
};

/// Means at the speeds of all, and by how much the recordings differ. None: it is not known.
OwnReference ownReference(const std::vector<SoundFriction>& recordings);

/// WARN where the interval clears the bound.
Finding judgeFriction(const JointEvidence& evidence, const Parameters& parameters, const JointContext& context);

/// What to say of a load that is not the joint's.
const char* wrongLoad(LoadOrigin load);
}  // namespace hjt
