// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <boost/numeric/odeint/integrate/integrate_n_steps.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>

#include "energy_ledger.hpp"
#include "gear/angle.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "solver/joint_stepper.hpp"
#include "test/core/joint_dynamics_support.hpp"
#include "test_parameters.hpp"

namespace hjt
{
namespace
{
TEST(BrakePin, MovesOnlyWithAStepThatIsAccepted)
{
  const Parameters parameters = shippedParameters({ "brake.play=0.02" });
  const JointModel model(parameters);
  JointDynamics dynamics(model, parameters.solver);
  ASSERT_TRUE(dynamics.solveAtRest().ok());
  dynamics.inputs.brake_engaged = true;
  const auto held = [&](double angle, double speed)
  {
    EXPECT_TRUE(dynamics.place(angle, angle / 101.0).ok());
    dynamics.updateFriction({ speed, 0.0 });
    return dynamics.friction().terms[0].strength > 0.5 * parameters.brake.holding_torque;
  };
  // A stage of Runge-Kutta's beyond the pin; the step itself ends before it.
  EXPECT_TRUE(held(0.03, 1.0));
  EXPECT_FALSE(held(0.005, -1.0));
  dynamics.accept();
  EXPECT_TRUE(held(0.015, 1.0));
  dynamics.accept();
  EXPECT_TRUE(held(-0.006, -1.0));  // it was dragged to 0.005 rad
}

/// Driven at random, once in divided steps and once in steps as long as the substeps.
TEST(DividedStep, GoesAsThatManyStepsDo)
{
  for (const auto& [inertia, overlays] :
       { std::pair<std::string, std::vector<std::string>>{ "output.load_inertia=0.0", {} },
         { "output.load_inertia=0.02", { "joints/elbow" } } })
  {
    SCOPED_TRACE(inertia);
    // Both within rounding, which reversals magnify: at the data sheet's speed limit, where this course was tried.
    const Parameters parameters = shippedParameters({ inertia, "motor.speed_limit=317.3" }, overlays);
    const JointModel model(parameters);
    JointStepper divided(parameters, model);
    const int substeps = divided.substeps();
    EXPECT_GT(substeps, 1);
    EXPECT_EQ(substeps % 2, 1);
    Parameters fine = parameters;
    fine.solver.rate *= substeps;
    JointStepper whole(fine, model);
    ASSERT_EQ(whole.substeps(), 1);

    RandomDrive drive(randomDrive(73), parameters);
    double fastest = 0.0;
    for (int i = 0; i < 1000; ++i)
    {
      const JointInputs inputs = drive.next();
      ASSERT_TRUE(divided.step(inputs));
      for (int j = 0; j < substeps; ++j)
      {
        ASSERT_TRUE(whole.step(inputs));
      }
      ASSERT_NEAR(divided.motorAngle(), whole.motorAngle(), 1e-9) << i;
      ASSERT_NEAR(divided.outputAngle(), whole.outputAngle(), 1e-11) << i;
      fastest = std::max(fastest, divided.phaseAdvance());
    }
    EXPECT_GT(std::abs(divided.motorAngle()), 0.1);
    EXPECT_LT(fastest, JointStepper::MAX_PHASE_ADVANCE);
    EXPECT_GT(fastest, 0.5 * JointStepper::MAX_PHASE_ADVANCE);
  }
}

TEST(DividedStep, KeepsTheLedger)
{
  // Light output, three substeps. Measured 1.8e-5; with 0.5 kg.m^2 and so undivided 1.4e-5 at this rate.
  const Parameters parameters = shippedParameters({ "output.load_inertia=0.02", "motor.speed_limit=60.0" });
  EXPECT_LT(energyResidual(parameters, 75, true), 5e-5);
}

TEST(StepLength, ThatTheJointCannotBeMarchedWithIsRefused)
{
  const auto make = [](const std::vector<std::string>& assignments)
  {
    const Parameters parameters = shippedParameters(assignments);
    const JointModel model(parameters);
    JointStepper(parameters, model);
  };
  EXPECT_NO_THROW(make({}));
  EXPECT_NO_THROW(make({ "output.load_inertia=0.0" }));
  EXPECT_THROW(make({ "output.load_inertia=0.0", "solver.rate=5000", "indicators.sample_rate=1000" }), ParameterError);
}
}  // namespace
}  // namespace hjt
