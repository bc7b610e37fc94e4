// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "identification/identification.hpp"

namespace hjt
{
/// A stretch of a recording [s].
struct Span
{
  double from{};
  double to{};

  bool contains(double time) const { return time >= from && time < to; }
};

/// Samples within `span` and not within `hole`; the first one after the hole follows a gap.
std::vector<MotionSample> samplesWithin(const std::vector<MotionSample>& all, const Span& span, const Span& hole = {});

/// `train`, which has samples, is cut into `folds` pieces in which the joint goes equal ways. Each is judged by what
/// the others give; the errors are pooled. 0 folds: no rows. `fitted` is called after each, `look` as in identify.
/// @throws InputError as identify.
JudgedErrors leaveOneOut(const Parameters& parameters, const std::vector<MotionSample>& all, const Span& train,
                         int folds, bool load_recorded, const std::function<void()>& fitted,
                         const std::function<void()>& look);
}  // namespace hjt
