// SPDX-License-Identifier: BSD-3-Clause
// Friction that remembers: the cup's Maxwell-slip elements and presliding at the shaft; the rim's own loss; friction of
// the output.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "elements/friction_laws.hpp"
#include "elements/ring_friction.hpp"
#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/statics/loss_analysis.hpp"
#include "harmonic_joint_twin/statics/torsion_loop.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "solver/joint_stepper.hpp"
#include "statics/static_solver.hpp"
#include "test_parameters.hpp"
#include "tracking/friction_map.hpp"
#include "tracking/observer.hpp"
#include "twin_runs.hpp"

namespace hjt
{
namespace
{
TEST(Presliding, LetsTheShaftTurnAsDahlsLaw)
{
  // Torque grows slowly to 60 % of the friction and falls to nothing: the motor follows Dahl's curve.
  constexpr double PRESLIDING = 3e-3;  // [rad]
  const Parameters parameters = shippedParameters({ "motor.presliding_angle=3.0e-3", "mesh.friction_static=0.0",
                                                    "mesh.friction_kinetic=0.0", "output.viscous_friction=50.0" });
  const JointModel model(parameters);
  JointStepper stepper(parameters, model);
  JointInputs inputs;
  inputs.temperature = parameters.input.temperature;
  ASSERT_TRUE(stepper.step(inputs));
  const double friction = stepper.dynamics().friction().presliding;
  EXPECT_GT(friction, 0.05);
  constexpr int STEPS = 20000;
  for (int i = 1; i <= STEPS; ++i)
  {
    inputs.motor_torque = 0.6 * friction * i / STEPS;
    ASSERT_TRUE(stepper.step(inputs));
  }
  const double share = mobilised(0.0, stepper.motorAngle(), PRESLIDING);
  EXPECT_NEAR(share * friction, inputs.motor_torque, 0.02 * friction);
  const double turned = stepper.motorAngle();
  for (int i = STEPS - 1; i >= 0; --i)
  {
    inputs.motor_torque = 0.6 * friction * i / STEPS;
    ASSERT_TRUE(stepper.step(inputs));
  }
  // Back by x: s = -1 + (s0 + 1) exp(-x / x_p) = 0.
  EXPECT_NEAR(turned - stepper.motorAngle(), PRESLIDING * std::log(1.0 + share), 0.05 * PRESLIDING);
  EXPECT_LT(std::abs(stepper.energyResidual()), 1e-4 * stepper.energyThroughput());
}

TEST(Stribeck, RaisesFrictionTowardsStandstill)
{
  const auto motor_loss = [](const std::vector<std::string>& assignments, double speed)
  { return analyseLosses(shippedParameters(assignments), { speed }, { 0.0 }, 2, nullptr).front().loss.motor; };
  const std::vector<std::string> rise{ "motor.stribeck_torque=0.048", "motor.stribeck_velocity=5.0" };
  EXPECT_NEAR(motor_loss(rise, 0.0) - motor_loss({}, 0.0), 0.048, 1e-15);
  EXPECT_NEAR(motor_loss(rise, 5.0) - motor_loss({}, 5.0), 0.048 * std::exp(-1.0), 1e-15);
  // The same beside a robot.
  const FrictionMap plain(shippedParameters());
  const FrictionMap raised(shippedParameters(rise));
  for (const double speed : { 0.0, 2.5, 5.0, 50.0 })
  {
    EXPECT_NEAR(raised.at(speed, 10.0, 25.0).sum() - plain.at(speed, 10.0, 25.0).sum(),
                0.048 * std::exp(-speed * speed / 25.0), 1e-14);
  }
}

TEST(FlexingLoss, IsPiTimesTheLossFactorACycle)
{
  constexpr double LOSS_FACTOR = 0.01;
  const Parameters parameters = shippedParameters({ "ring.loss_factor=0.01", "contact.friction_coefficient=0.0" });
  const JointModel model(parameters);
  RingEquilibrium ring(model.ring, staticSolver(parameters.solver));
  const double w = parameters.gear.wave_amplitude;
  ASSERT_TRUE(ring.insert({ 0.0, 0.0, w }).ok());
  const double k = model.ring.of<RimBending>().stiffness()[0] + parameters.bearing.race_bending_stiffness;
  const double ratio = nominalRatio(parameters.gear);
  // Over a turn of the wave generator every tooth goes through two cycles.
  constexpr int STEPS = 800;
  double energy = 0.0;   // by the law, over a turn [J]
  double changes = 0.0;  // by moments before and after each step
  Eigen::VectorXd lowest = ring.forces().of<RimBending>().moment;
  Eigen::VectorXd highest = lowest;
  Eigen::VectorXd before = lowest;
  for (int i = 1; i <= STEPS; ++i)
  {
    const double angle = TWO_PI * i / STEPS;
    ASSERT_TRUE(ring.moveTo({ angle, angle / ratio, w }).ok());
    const Eigen::VectorXd running = ring.byWaveGenerator() + ring.velocityRatio() * ring.byOutput();
    energy += model.ringTorque(ring.shape(), ring.forces(), running) * TWO_PI / STEPS;
    const Eigen::VectorXd& moment = ring.forces().of<RimBending>().moment;
    changes += (0.5 * (moment + before)).cwiseProduct(moment - before).cwiseAbs().sum();
    before = moment;
    lowest = lowest.cwiseMin(moment);
    highest = highest.cwiseMax(moment);
  }
  EXPECT_NEAR(energy, 0.25 * TWO_PI * LOSS_FACTOR * changes / k, 0.02 * energy);
  const double amplitude = 0.5 * (highest - lowest).mean();
  const double cycles = 2.0 * model.ring.rest.teeth();
  EXPECT_NEAR(energy, cycles * PI * LOSS_FACTOR * amplitude * amplitude / k, 0.15 * energy);
  RecordProperty("moment_amplitude", std::to_string(amplitude));
  RecordProperty("torque_mNm", std::to_string(1e3 * energy / TWO_PI));
}

TEST(OutputFriction, HoldsTheOutputAndMustBeOvercome)
{
  const std::vector<std::string> with{ "output.coulomb_torque=2.0", "output.tilting_moment=60.0",
                                       "output.tilting_friction=0.05" };
  const Parameters parameters = shippedParameters(with);
  const JointModel model(parameters);
  EXPECT_NEAR(model.load.dryFriction(), 5.0, 1e-14);
  // Starting and back-driving.
  const Breakaway without = analyseBreakaway(shippedParameters(), 4);
  const Breakaway found = analyseBreakaway(parameters, 4);
  EXPECT_NEAR(found.starting - without.starting, 5.0 / 101.0, 1e-3);
  EXPECT_GT(found.back_driving - without.back_driving, 5.0);
  EXPECT_LT(found.back_driving - without.back_driving, 6.0);
  // The loop of a locked motor becomes wider by twice the friction over the stiffness.
  const double width = analyseTorsionLoop(parameters, 40.0, 2.0, 200).hysteresis -
                       analyseTorsionLoop(shippedParameters(), 40.0, 2.0, 200).hysteresis;
  EXPECT_NEAR(width, 2.0 * 5.0 / parameters.cup.torsion_stiffness[0], 0.15 * width);
  // Beside a robot.
  EXPECT_NEAR(
      FrictionMap(parameters).at(10.0, 0.0, 25.0).sum() - FrictionMap(shippedParameters()).at(10.0, 0.0, 25.0).sum(),
      5.0 / 101.0, 1e-4);
  // In the twin, the motor held: a load below it moves nothing, one above the rest of the way.
  JointStepper stepper(parameters, model);
  JointInputs inputs;
  inputs.temperature = parameters.input.temperature;
  inputs.brake_engaged = true;
  const double start = stepper.outputAngle();
  const auto settle = [&](double load)
  {
    inputs.load_torque = load;
    for (int i = 0; i < 10000; ++i)
    {
      EXPECT_TRUE(stepper.step(inputs));
    }
    return start - stepper.outputAngle();
  };
  EXPECT_LT(std::abs(settle(4.5)), 2e-6);
  const double moved = settle(15.0);
  EXPECT_GT(moved, 0.5 * 10.0 / 50e3);
  EXPECT_LT(moved, 20.0 / 31e3);  // it swings past and stays there
}

TEST(Observer, FollowsAShaftThatGivesWay)
{
  // Torque below the friction turns the motor to and fro by milliradians, which the output hardly shows.
  const Parameters parameters = shippedParameters({ "motor.presliding_angle=3.0e-3", "input.command_timeout=10.0" });
  std::array<double, 2> largest{};
  std::array<double, 2> residual{};
  for (const bool knows : { false, true })
  {
    Parameters observed = parameters;
    observed.motor.presliding_angle = knows ? parameters.motor.presliding_angle : 0.0;
    Twin twin(parameters);
    Observer observer(observed);
    for (int i = 0; i < 20000; ++i)
    {
      const Stamp next = twin.stamp() + twin.stepLength();
      const double torque = 0.06 * std::sin(TWO_PI * 1.0e-4 * i);
      twin.commandMotorTorque(next, torque);
      twin.step(next);
      if (i % 20 == 0)
      {
        Measurement row;
        row.time = 1e-9 * static_cast<double>(twin.stamp());
        row.motor_torque = torque;
        row.output_angle = twin.outputs().output_angle;
        row.motor_angle = std::numeric_limits<double>::quiet_NaN();
        const Observation seen = observer.step(row);
        double& most = largest[knows ? 1 : 0];
        most = std::max(most, std::abs(seen.motor_angle - twin.outputs().motor_angle));
        residual[knows ? 1 : 0] = std::max(residual[knows ? 1 : 0], std::abs(seen.residual_torque));
      }
    }
  }
  RecordProperty("motor_angle_without", std::to_string(largest[0]));
  RecordProperty("motor_angle_with", std::to_string(largest[1]));
  RecordProperty("residual_with", std::to_string(residual[1]));
  EXPECT_LT(largest[1], 0.3 * largest[0]);
  EXPECT_LT(residual[1], 1e-3);
}
}  // namespace
}  // namespace hjt
