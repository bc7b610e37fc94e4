// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "apps/compare/recording_comparison.hpp"

namespace hjt
{
/// Figures of the same joint in sound condition; NaN: none.
struct OwnReference
{
  double friction_ratio{ std::numeric_limits<double>::quiet_NaN() };
  double compliance_ratio{ std::numeric_limits<double>::quiet_NaN() };
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

/// Findings of a recording.
struct Verdict
{
  HealthLevel level{};
  bool judged{};  ///< false: no finding is
  std::vector<Finding> findings;
  double highest_order{};  ///< of the motor's turn that the rows resolve at the highest speed; 0: it does not move [-]
  std::vector<std::string> cannot_show;  ///< by this recording, each with the reason
};

/// `duration` of the recording [s].
Verdict judge(const RecordingComparison& comparison, const Parameters& parameters, const OwnReference& own,
              bool has_load, double duration);
}  // namespace hjt
