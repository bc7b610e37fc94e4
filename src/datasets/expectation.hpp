// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "datasets/plan.hpp"

#include "harmonic_joint_twin/surface/surface_source.hpp"

namespace hjt
{
/// Prints number, time and size of the plan's runs, tried on one of each class and duty cycle. Their response surfaces
/// are built for it, and kept where the source keeps them. @throws InputError, ParameterError if one has no
/// equilibrium.
void printExpectation(const Plan& plan, unsigned jobs, const SurfaceSource& source);
}  // namespace hjt
