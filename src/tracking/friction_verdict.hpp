// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/statistics.hpp"
#include "tracking/joint_evidence.hpp"
#include "tracking/reason.hpp"

namespace hjt
{
struct JointContext;
struct Finding;
struct Verdict;
struct JudgedFriction;
struct OwnReference;

constexpr double LEAST_MOTION = 0.02;  ///< a joint whose angles differ by less does not move [rad]

/// Bound of a joint's own friction: a smaller change is of no interest however certain. Less friction counts half as
/// much, since no fault takes a fifth of it.
constexpr double MORE_THAN_OWN = 0.05;
constexpr double LESS_THAN_OWN = 0.10;

/// What the friction of a joint is a multiple of.
enum class FrictionReference : std::uint8_t
{
  TWIN,
  CONTROLLER,  ///< what the arm's controller expects
  OWN          ///< its own when it was sound
};

const char* referenceName(FrictionReference reference) noexcept;  ///< "controller"

/// Friction of a joint as a multiple of its reference, with what is known of its error
/// (docs/compare.md).
struct FrictionFactor
{
  double value{ std::numeric_limits<double>::quiet_NaN() };  ///< NaN: the rows show none
  double deviation{};                                        ///< standard deviation of its logarithm [-]
  double scatter{};                                          ///< the part of it that the rows' scatter makes [-]
  FrictionReference reference{ FrictionReference::TWIN };
  bool is_below_faults{};          ///< less than any fault leaves of it
  Reason reason{ Reason::SOUND };  ///< why it is not judged; SOUND: it is
  std::string why_not;             ///< the same in a sentence; empty: it is judged

  bool isJudged() const { return reason == Reason::SOUND; }
  /// Ends of the 95 % interval.
  double low() const { return value * std::exp(-halfWidth()); }
  double high() const { return value * std::exp(halfWidth()); }

private:
  double halfWidth() const { return NORMAL_95 * deviation; }
};

/// "1.18 [1.05, 1.32]"
std::string factorText(const FrictionFactor& factor);
std::string factorText(const JudgedFriction& friction);

/// Whether the friction of the joints of an arm can be held against what its controller expects: most of them agree
/// with it, and so it is that of sound joints.
bool controllerIsReference(const std::vector<const JointEvidence*>& joints);

/// By which the friction of a sound joint repeats from its own earlier one, apart from what the joints of its group
/// have in common: standard deviation as a share [-]. `friction` [N.m]
double repeatOfOwn(double friction);

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

/// WARN where the interval clears the bound. Factor, text and figures go into the verdict.
Finding judgeFriction(const JointEvidence& evidence, const JointContext& context, Verdict& verdict);

/// Faults that move the indicator that way, +1 or -1.
void nameCauses(const JointEvidence& evidence, ScalarIndicator indicator, double way, Finding& finding);

/// What to say of a load that is not the joint's.
const char* wrongLoad(LoadOrigin load);
}  // namespace hjt
