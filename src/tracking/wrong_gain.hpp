// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "base/number_text.hpp"
#include "tracking/joint_evidence.hpp"
#include "tracking/reason.hpp"

namespace hjt
{
/// How what the motion takes beside friction departs: as the friction does, then the current as a whole is another.
struct GainEvidence
{
  explicit GainEvidence(const JointEvidence& evidence)
    : load(evidence.loadFactor()), friction(evidence.friction().ratio().value)
  {
  }

  /// Friction departs alone.
  bool isExcluded() const
  {
    return load.value > 0.0 && !isAlike() && std::abs(load.value - friction) > DEVIATIONS * load.uncertainty;
  }

  /// The friction is nearer to what the load says than to the twin's; else another load is as likely.
  bool isOfFriction() const { return std::abs(std::log(load.value / friction)) < std::abs(std::log(friction)); }

  /// Both depart alike; none: they do not, or it cannot be told.
  Misfit misfit() const
  {
    constexpr double NOTEWORTHY = 0.2;  // gains of one type differ by less
    if (!(load.value > 0.0 && isAlike()) ||
        std::abs(load.value - 1.0) < std::max(NOTEWORTHY, DEVIATIONS * load.uncertainty))
    {
      return {};
    }
    return { Reason::EFFORT_UNIT, "the current is " + roundedText(load.value, 2) +
                                      " times what load and inertia take, and " + roundedText(friction, 2) +
                                      " times what friction takes: another gain (telemetry.torque_per_current) or unit "
                                      "than configured, not friction" };
  }

  FittedFactor load;
  double friction;

private:
  static constexpr double DEVIATIONS = 3.0;

  bool isAlike() const
  {
    constexpr double ALIKE = 1.25;
    return std::abs(std::log(load.value / friction)) < std::log(ALIKE);
  }
};
}  // namespace hjt
