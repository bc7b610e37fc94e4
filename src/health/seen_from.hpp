// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "harmonic_joint_twin/health/assessment.hpp"

namespace hjt
{
using SeenFrom = std::array<double, CAUSE_COUNT>;  ///< severities by cause [-]

/// Least severity at which half of the drives with each fault would be out of the ordinary in the windows that were
/// compared last, among those of the signatures; infinite: with none; NaN: the fault has no signature. For reports:
/// allocates.
SeenFrom seenFrom(const Assessor& assessor, const OperatingPoint& point);
}  // namespace hjt
