// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <gtest/gtest.h>

#include "gear/ratio.hpp"
#include "model/faults/joint_faults.hpp"
#include "solver/ring_equilibrium.hpp"
#include "statics/static_solver.hpp"
#include "test/support/allocation_count.hpp"
#include "test_parameters.hpp"
#include "tracking/measured_gear.hpp"
#include "twin/tooth_forces.hpp"

namespace hjt
{
namespace
{
ToothForces noForces(const Parameters& parameters)
{
  const std::vector<double> zeros(static_cast<std::size_t>(parameters.gear.teeth_flexspline));
  return { zeros, zeros, zeros, zeros, zeros, zeros };
}

class MeasuredGearOf : public testing::TestWithParam<const char*>
{
protected:
  const Parameters parameters_ =
      shippedParameters({ std::string("manufacture.circular_spline_pitch_deviation=") + GetParam(),
                          "manufacture.circular_spline_pitch_seed=3" });
};
INSTANTIATE_TEST_SUITE_P(PitchDeviations, MeasuredGearOf, testing::Values("0.0", "2.0e-6"));

/// A ring led step by step over several teeth both ways, the load changing: at each angle the gear solved within one
/// pitch has the same forces at the same teeth.
TEST_P(MeasuredGearOf, IsTheRingThatIsLedThere)
{
  const JointModel model = startingJoint(parameters_);
  RingEquilibrium ring(model.ring, staticSolver(parameters_.solver));
  ASSERT_TRUE(ring.insert({ 0.0, 0.0, parameters_.gear.wave_amplitude }).ok());
  MeasuredGear gear(parameters_);
  ToothForces expected = noForces(parameters_);
  ToothForces found = noForces(parameters_);
  const double ratio = nominalRatio(parameters_.gear);
  for (int i = 1; i <= 40; ++i)
  {
    const double motor_angle = i <= 20 ? 0.02 * i : 0.4 - 0.04 * (i - 20);
    const double load = 60.0 * std::sin(0.3 * i);
    ASSERT_TRUE(balanceOutput(ring, motor_angle, load).ok());
    ASSERT_TRUE(gear.moveTo(ring.position().output_angle, load));
    EXPECT_NEAR(gear.motorAngle(), motor_angle, 1e-5);
    EXPECT_NEAR(gear.torsion(), motor_angle / ratio - ring.position().output_angle, 1e-7);
    fillToothForces(ring, 0, expected);
    gear.fill(found);
    for (std::size_t tooth = 0; tooth < expected.mesh_force.size(); ++tooth)
    {
      EXPECT_NEAR(found.mesh_force[tooth], expected.mesh_force[tooth], 0.01) << i << ' ' << tooth;
      EXPECT_NEAR(found.wave_generator_force[tooth], expected.wave_generator_force[tooth], 0.01) << i << ' ' << tooth;
      EXPECT_NEAR(found.tooth_x[tooth], expected.tooth_x[tooth], 1e-9) << i << ' ' << tooth;
      EXPECT_NEAR(found.tooth_y[tooth], expected.tooth_y[tooth], 1e-9) << i << ' ' << tooth;
    }
  }
}

/// From one end of the joint's range to the other.
TEST_P(MeasuredGearOf, FollowsJumpsOfTheAngle)
{
  MeasuredGear gear(parameters_);
  for (const double position : { 3.0, -6.28, 0.0, 6.28, 1e-3 })
  {
    ASSERT_TRUE(gear.moveTo(position, 40.0)) << position;
    EXPECT_NEAR(gear.motorAngle() / nominalRatio(parameters_.gear) - position, gear.torsion(), 1e-9);
    EXPECT_GT(gear.torsion(), 1e-4) << position;
    EXPECT_LT(gear.torsion(), 5e-3) << position;
  }
}

TEST_P(MeasuredGearOf, KeepsItsStateWithoutAnEquilibriumAndAllocatesNothing)
{
  MeasuredGear gear(parameters_);
  const std::size_t before = allocationCount();
  ASSERT_TRUE(gear.moveTo(0.3, 20.0));
  const double angle = gear.motorAngle();
  EXPECT_FALSE(gear.moveTo(0.3, 1.01 * parameters_.output.load_torque_limit));
  EXPECT_FALSE(gear.moveTo(0.3, std::nan("")));
  EXPECT_EQ(gear.motorAngle(), angle);
  ASSERT_TRUE(gear.moveTo(0.4, -20.0));
  EXPECT_LT(gear.torsion(), 0.0);
  EXPECT_EQ(allocationCount(), before);
}
}  // namespace
}  // namespace hjt
