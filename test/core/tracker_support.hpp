// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The twin beside measured rows: what a stream does to it, which load it reckons with, how it judges time.
#include <cmath>
#include <vector>

#include <gmock/gmock.h>

#include "test/support/allocation_count.hpp"
#include "test_parameters.hpp"

#include "gear/angle.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "tracking/joint_evidence.hpp"
#include "tracking/tracker.hpp"
#include "tracking/verdict_watch.hpp"

namespace hjt
{
using testing::Gt;
using testing::HasSubstr;
using testing::SizeIs;

constexpr double PERIOD = 0.008;  // [s]

/// A swing and a current that fits it but for an offset.
inline MotionRow rowAt(double time)
{
  MotionRow row;
  row.time = time;
  row.position = 0.5 * std::sin(1.3 * time);
  row.current = 1.0 + 0.8 * std::cos(1.3 * time);
  row.received = time + 0.003;
  return row;
}

inline std::vector<Comparison> takeAll(Tracker& tracker, bool at_end = false)
{
  std::vector<Comparison> taken;
  while (const std::optional<Comparison> now = tracker.pop(at_end))
  {
    taken.push_back(*now);
  }
  return taken;
}

inline Parameters parametersWith(std::vector<std::string> assignments, const std::vector<std::string>& overlays = {})
{
  assignments.insert(assignments.end(), { "motor.viscous_friction=0.0", "solver.rate=2000" });
  return shippedParameters(assignments, overlays);
}
}  // namespace hjt
