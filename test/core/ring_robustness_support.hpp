// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <gtest/gtest.h>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"
#include "ring_fixture.hpp"
#include "solver/ring_equilibrium.hpp"
#include "statics/static_solver.hpp"
#include "test_parameters.hpp"

namespace hjt
{
inline void expectFinite(const RingEquilibrium& ring)
{
  EXPECT_TRUE(ring.shape().points.allFinite());
  EXPECT_TRUE(allFinite(ring.forces()));
  EXPECT_TRUE(ring.byWaveGenerator().allFinite() && ring.byOutput().allFinite() && ring.stiffness().allFinite());
  EXPECT_TRUE(std::isfinite(ring.position().wave_generator_angle) && std::isfinite(ring.position().output_angle));
}

/// The ring is in equilibrium at the position it names, with the forces it names.
inline void expectEquilibrium(const RingEquilibrium& ring, double tolerance)
{
  RingForces forces(ring.shape().teeth());
  ring.model().forces(ring.shape(), ring.position(), forces);
  EXPECT_LE(forces.teeth.lpNorm<Eigen::Infinity>(), tolerance);
  EXPECT_TRUE(forces.teeth == ring.forces().teeth);
  EXPECT_EQ(forces.energy, ring.forces().energy);
}
}  // namespace hjt
