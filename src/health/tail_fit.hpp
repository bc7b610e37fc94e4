// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/health/baseline.hpp"

namespace hjt
{
/// Sets ReferenceBin::tail, once the slopes are fitted: that under which what KeptWindows are off by, each from all
/// others, is likeliest, in the distribution that single windows are scored by (Baseline). Of normal windows it is 0 to
/// 0.01.
void fitTails(ReferenceBin& bin, const LearnedSums& sums) noexcept;
}  // namespace hjt
