// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "life/ageing_laws.hpp"

namespace hjt
{
/// Measures on the tooth model what turning does to the drive. One drive, any number of loads.
class RevolutionLoadAnalysis
{
public:
  /// `positions`: wave generator angles per tooth pitch, >= 1. @throws ParameterError if the parameters have no
  /// equilibrium.
  RevolutionLoadAnalysis(const Parameters& parameters, int positions);
  ~RevolutionLoadAnalysis();

  /// One turn of the wave generator under `load_torque` [N.m].
  /// @throws ParameterError if the ring finds no equilibrium under it.
  RevolutionLoad under(double load_torque);

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace hjt
