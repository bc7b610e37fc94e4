// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "harmonic_joint_twin/statics/static_analysis.hpp"
#include "studies/ratchet_analysis.hpp"
#include "test_parameters.hpp"

namespace hjt
{
namespace
{
constexpr double RIGID = std::numeric_limits<double>::infinity();
constexpr double STEP = 2e-4;  // rad

TEST(Ratchet, RowsAreThoseOfTheStiffnessWhereNothingJumps)
{
  const Parameters parameters = shippedParameters();
  const RatchetResult result = analyseRatchet(parameters, 0.1, RIGID, STEP, 200.0, {});
  ASSERT_TRUE(result.status.ok());
  EXPECT_EQ(result.end, RatchetEnd::LIMIT_REACHED);
  EXPECT_GE(result.peak.torque, 200.0);
  const RatchetRow& row = result.rows[7];
  const StiffnessRow same = analyseStiffness(parameters, 0.1, { row.torque }).front();
  // The same equilibrium, once by the angle and once by the torque; forces to 1e-4 N.
  EXPECT_NEAR(row.output_angle, same.output_angle, 1e-9);
  EXPECT_EQ(row.teeth_loaded, same.teeth_loaded);
  EXPECT_NEAR(row.mesh_force_max, same.mesh_force_max, 1e-3);
  EXPECT_EQ(row.teeth_jumped, 0);
}

TEST(Ratchet, TeethJumpFromASoftWaveGeneratorAndTheTorqueFalls)
{
  const Parameters parameters = goldenParameters({ "contact.stiffness=3.0e+5" });
  const RatchetResult result = analyseRatchet(parameters, 0.0, RIGID, STEP, 2000.0, {});
  ASSERT_TRUE(result.status.ok());
  EXPECT_EQ(result.end, RatchetEnd::TEETH_JUMPED);
  EXPECT_LT(result.peak.torque, 500.0);
  EXPECT_LT(result.rows.back().torque, 0.9 * result.peak.torque);
  // The jump is a property of the gear, not of the step.
  const RatchetResult fine = analyseRatchet(parameters, 0.0, RIGID, 0.25 * STEP, 2000.0, {});
  EXPECT_EQ(fine.end, RatchetEnd::TEETH_JUMPED);
  EXPECT_NEAR(fine.peak.torque, result.peak.torque, 0.05 * result.peak.torque);
}

TEST(Ratchet, TheLobesBalanceTheRing)
{
  const double lobe_stiffness = 5e6;  // N/m
  const Parameters parameters = shippedParameters();
  const RatchetResult result = analyseRatchet(parameters, 0.0, lobe_stiffness, STEP, 300.0, {});
  ASSERT_TRUE(result.status.ok());
  const RatchetResult rigid = analyseRatchet(parameters, 0.0, RIGID, STEP, 300.0, {});
  for (std::size_t i = 0; i < std::min(result.rows.size(), rigid.rows.size()); ++i)
  {
    const RatchetRow& row = result.rows[i];
    EXPECT_NEAR(row.lobe_force, lobe_stiffness * (parameters.gear.wave_amplitude - row.wave_amplitude), 2e-3) << i;
    // What gives way is pressed less, or pulled less where flanks pull the rim on.
    EXPECT_LT(std::abs(row.lobe_force), std::abs(rigid.rows[i].lobe_force)) << i;
  }
}
}  // namespace
}  // namespace hjt
