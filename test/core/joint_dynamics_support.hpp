// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <gtest/gtest.h>
#include <boost/numeric/odeint/integrate/integrate_n_steps.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>

#include "energy_ledger.hpp"
#include "gear/angle.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "solver/joint_stepper.hpp"
#include "test_parameters.hpp"

namespace hjt
{
using namespace joint_state;

inline RandomDriveSettings randomDrive(unsigned seed, bool brake = true)
{
  RandomDriveSettings settings;
  settings.seed = seed;
  settings.brake = brake;
  return settings;
}

/// Largest energy residual of a random second, over the energy that went through [-].
inline double energyResidual(const Parameters& parameters, unsigned seed, bool brake)
{
  SCOPED_TRACE("seed " + std::to_string(seed));
  const LedgerResult result = runLedger(parameters, randomDrive(seed, brake), 1.0);
  EXPECT_TRUE(result.status.ok());
  EXPECT_GT(result.travel, 5.0);
  EXPECT_GT(result.reversals, 3);
  const double residual = result.residual / result.throughput;
  testing::Test::RecordProperty("relative_energy_residual", testing::PrintToString(residual));
  return residual;
}
}  // namespace hjt
