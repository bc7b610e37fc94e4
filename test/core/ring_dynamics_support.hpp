// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <memory>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "element_under_test.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"
#include "random_ring.hpp"
#include "solver/ring_equilibrium.hpp"
#include "studies/dynamic_runs.hpp"
#include "studies/ring_stepper.hpp"
#include "test/support/allocation_count.hpp"
#include "test_parameters.hpp"

namespace hjt
{
/// A dynamic ring with what it needs.
struct Bench
{
  explicit Bench(const Parameters& parameters, const RingDrive& drive = {}, bool meshed = true)
    : parameters(parameters), model(parameters), drive(drive)
  {
    model.ring.setMeshed(meshed);
    ring = std::make_unique<DynamicRing>(model, parameters.ring, drive);
  }

  Parameters parameters;
  JointModel model;
  RingDrive drive;
  std::unique_ptr<DynamicRing> ring;
};
}  // namespace hjt
