// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "comparison.hpp"

namespace hjt
{
/// One thing that was judged, in words.
struct Finding
{
  HealthLevel level{};
  bool judged{};  ///< false: the text says why not
  std::string title;
  std::string text;
};

/// What the recording says of the joint.
struct Verdict
{
  HealthLevel level{};
  bool judged{};  ///< false: no finding is
  std::vector<Finding> findings;
  double highest_order{};  ///< of the motor's turn that the rows resolve at the highest speed; 0: it does not move [-]
  std::vector<std::string> cannot_show;  ///< by this recording, each with the reason
};

/// `duration` of the recording [s].
Verdict judge(const Comparison& comparison, const Parameters& parameters, bool has_load, double duration);
}  // namespace hjt
