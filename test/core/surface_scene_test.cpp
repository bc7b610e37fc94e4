// SPDX-License-Identifier: BSD-3-Clause
#include "solver/response_surface.hpp"

#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "harmonic_joint_twin/twin/twin.hpp"
#include "model/joint_model.hpp"
#include "solver/joint_dynamics.hpp"
#include "statics/static_solver.hpp"
#include "surface/faulty_surface.hpp"
#include "test/core/response_surface_support.hpp"
#include "test_parameters.hpp"
#include "twin_runs.hpp"

namespace hjt
{
namespace
{
/// Twins side by side, all teeth and the surface, position-controlled as a robot's drive is, over moves, reversals,
/// jumps of the load and the brake.
TEST(SceneAuto, FollowsTheFullRingOverRandomMotions)
{
  constexpr int STEPS = 10000;
  Twin full(shippedParameters({ "input.command_timeout=10.0" }));
  Twin fast(surfaceParameters(), cached());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  double load = 0.0;
  double wanted = 0.0;
  double path = 0.0;
  double torque_squares = 0.0;
  double motor_torque_squares = 0.0;
  double output_squares = 0.0;
  for (int i = 0; i < STEPS; ++i)
  {
    const Stamp next = full.stamp() + full.stepLength();
    load = i % 2000 == 0 ? 80.0 * part(random) : load;
    wanted = i % 1500 == 0 ? 150.0 * part(random) : wanted;
    path += wanted * 1e-4;
    for (Twin* twin : { &full, &fast })
    {
      const JointOutputs& now = twin->outputs();
      twin->commandLoadTorque(next, load);
      twin->commandMotorTorque(next, 0.05 * (wanted - now.motor_velocity) + (path - now.motor_angle));
      twin->commandBrake(next, i % 5000 > 4000 && i % 5000 < 4500);
      twin->step(next);
    }
    ASSERT_TRUE(fast.outputs().converged);
    ASSERT_TRUE(i == 0 || fast.onSurface());
    torque_squares += std::pow(full.outputs().joint_torque - fast.outputs().joint_torque, 2);
    motor_torque_squares += std::pow(full.outputs().wave_generator_torque - fast.outputs().wave_generator_torque, 2);
    output_squares += std::pow(full.outputs().output_angle - fast.outputs().output_angle, 2);
  }
  RecordProperty("torque_rms_share", std::to_string(std::sqrt(torque_squares / STEPS) / RATED_TORQUE));
  RecordProperty("output_rms_arcsec", std::to_string(std::sqrt(output_squares / STEPS) / ARC_SECOND));
  EXPECT_LT(std::sqrt(torque_squares / STEPS), 1e-3 * RATED_TORQUE);
  EXPECT_LT(std::sqrt(motor_torque_squares / STEPS), 1e-3 * RATED_MOTOR_TORQUE);
  // Stick and slip of cup and flanks carry small differences on: see docs/response_surface.md.
  EXPECT_LT(std::sqrt(output_squares / STEPS), 0.5 * ARC_SECOND);
}

TEST(SceneAuto, EnergyBalances)
{
  Twin twin(surfaceParameters(), cached());
  for (const Input& input : randomInputs(9, SECOND, 1.5, 60.0))
  {
    give(twin, input);
  }
  double through = 0.0;
  double last = 0.0;
  while (twin.step(SECOND))
  {
    const double power = std::abs(twin.outputs().motor_torque * twin.outputs().motor_velocity);
    through += 0.5e-4 * (power + last);
    last = power;
  }
  EXPECT_LT(std::abs(twin.outputs().energy_residual), 2e-4 * through);
}

/// Overload drives the joint off the surface and the relief brings it back: angles and speeds go on, and no output
/// jumps by more than it does from step to step anyhow.
TEST(SceneAuto, ChangesToTheFullRingAndBackWithoutAStep)
{
  Parameters parameters = surfaceParameters();
  parameters.output.load_torque_limit = 3000.0;  // so that the load leads beyond the surface of the shipped limit
  const ResponseSurface& narrow = surface();
  const JointModel model(parameters);
  JointDynamics dynamics(model, parameters.solver);
  ASSERT_TRUE(dynamics.solveAtRest().ok());
  ASSERT_TRUE(dynamics.useSurface(&narrow));
  int changes = 0;
  double before = 0.0;
  constexpr double STEP = 2e-6;  // rad; 0.13 N.m a step
  for (int i = 0; i <= 11000; ++i)
  {
    const double v = i <= 5500 ? i * STEP : (11000 - i) * STEP;
    const bool was_on_surface = dynamics.onSurface();
    ASSERT_TRUE(dynamics.place(0.01 * v, v).ok());
    const double torque = dynamics.response().output_torque;
    const double moved = std::abs(torque - before);
    if (i > 0)
    {
      EXPECT_LT(moved, 70e3 * STEP) << "step " << i;
      changes += dynamics.onSurface() != was_on_surface ? 1 : 0;
    }
    before = torque;
  }
  EXPECT_EQ(changes, 2);  // off it at its end, onto it again
  EXPECT_TRUE(dynamics.onSurface());
}

/// The full ring is where it was left, turns away: it may find no equilibrium where the surface is given up.
TEST(SceneAuto, SaysThatTheRingDoesNotFollow)
{
  constexpr double MOTOR = 20.0;
  constexpr double OUTPUT = MOTOR / 101.0 + 1e-3;
  const Parameters parameters = surfaceParameters();
  JointModel model(parameters);
  JointDynamics dynamics(model, parameters.solver);
  ASSERT_TRUE(dynamics.solveAtRest().ok());
  ASSERT_TRUE(dynamics.useSurface(&surface()));
  ASSERT_TRUE(dynamics.place(MOTOR, OUTPUT).ok());
  ASSERT_TRUE(dynamics.onSurface());
  const double torque = dynamics.response().output_torque;
  const auto stays = [&]
  {
    return dynamics.position() == DrivePosition{ MOTOR, OUTPUT, parameters.gear.wave_amplitude } &&
           dynamics.response().output_torque == torque;
  };
  double& stiffness = model.ring.edit<WaveGeneratorContact>().stiffness()[0];
  const double sound = std::exchange(stiffness, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(dynamics.place(MOTOR, OUTPUT + 1.0).ok()) << "beyond the surface";
  EXPECT_TRUE(dynamics.onSurface());
  EXPECT_TRUE(stays());
  dynamics.status = {};
  EXPECT_FALSE(dynamics.useSurface(nullptr));
  EXPECT_FALSE(dynamics.status.ok());
  EXPECT_FALSE(dynamics.onSurface());
  EXPECT_TRUE(stays());
  model.ring.edit<WaveGeneratorContact>().stiffness()[0] = sound;
  EXPECT_TRUE(dynamics.updateModel().ok());
  EXPECT_EQ(dynamics.outputAngle(), OUTPUT);
  EXPECT_NEAR(dynamics.response().output_torque, torque, 1e-3 * std::abs(torque));
}

/// By 5 N.m, a jump where the joint comes onto it.
TEST(SceneAuto, TakesNoSurfaceBetweenOthersThatIsOff)
{
  constexpr double OUTPUT = 2e-3;
  const Parameters parameters = surfaceParameters();
  const JointModel model(parameters);
  const auto table = std::make_shared<const ResponseSurface>(surface().table(), DeviationTable{});
  for (const auto& [weight, taken] : { std::pair(1.0, true), std::pair(0.95, false) })
  {
    const ResponseSurface weighted({ { table, 0.5 }, { table, weight - 0.5 } });
    JointDynamics dynamics(model, parameters.solver);
    ASSERT_TRUE(dynamics.solveAtRest().ok());
    ASSERT_TRUE(dynamics.place(0.0, OUTPUT).ok());
    ASSERT_TRUE(dynamics.useSurface(&weighted));
    EXPECT_EQ(dynamics.placeOnSurface(0.0, OUTPUT), taken) << weight;
  }
}

TEST(SceneAuto, ToothForcesAreOfThePresentInstant)
{
  Twin twin(surfaceParameters(), cached());
  twin.commandLoadTorque(0, 40.0);
  twin.commandMotorTorque(0, 1.0);
  advance(twin, SECOND / 2);
  ASSERT_TRUE(twin.onSurface());
  ToothForces forces = twin.makeToothForces();
  twin.toothForces(forces);
  const HealthReport health = twin.health();
  double load = 0.0;
  int teeth = 0;
  for (std::size_t i = 0; i < forces.mesh_force.size(); ++i)
  {
    load += forces.wave_generator_force[i];
    teeth += forces.mesh_force[i] != 0.0 ? 1 : 0;
  }
  EXPECT_NEAR(load, health.lobes.wave_generator_force, 1e-3 * load);
  EXPECT_NEAR(teeth, health.lobes.teeth_loaded, 2);
  EXPECT_TRUE(twin.onSurface());
}

TEST(SceneAuto, SameBitsFromTheCacheAndAnew)
{
  std::vector<std::vector<double>> runs;
  for (const SurfaceSource& source : { SurfaceSource{}, cached() })
  {
    Twin twin(surfaceParameters(), source);
    twin.commandMotorTorque(0, 0.7);
    advance(twin, SECOND / 10);
    runs.push_back(numbers(twin.outputs()));
  }
  EXPECT_TRUE(runs[0] == runs[1]);
}

/// The full ring from the first instant, and the surface as soon as it is there, without a step in the torque.
TEST(SceneAuto, RunsOnTheFullRingWhileTheSurfaceIsBuiltBeside)
{
  surface();  // so that it only has to be read
  Twin reference(shippedParameters({ "input.command_timeout=10.0" }));
  SurfaceSource beside = cached();
  beside.background = true;
  Twin twin(surfaceParameters(), beside);
  EXPECT_FALSE(twin.onSurface());
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  double step_at_change = HUGE_VAL;
  for (int after = 0; after < 200 && std::chrono::steady_clock::now() < deadline; after += twin.onSurface() ? 1 : 0)
  {
    const bool was_on_surface = twin.onSurface();
    for (Twin* each : { &reference, &twin })
    {
      each->commandMotorTorque(each->stamp(), 0.3 - 0.01 * each->outputs().motor_velocity);
      each->step(each->stamp() + each->stepLength());
    }
    if (twin.onSurface() != was_on_surface)
    {
      step_at_change = std::abs(twin.outputs().joint_torque - reference.outputs().joint_torque);
    }
    else if (!twin.onSurface())
    {
      ASSERT_EQ(numbers(twin.outputs()), numbers(reference.outputs()));
    }
  }
  EXPECT_TRUE(twin.onSurface());
  EXPECT_LT(step_at_change, 1e-3);
}

/// By the wall clock, with patience. False: it did not come onto the surface.
bool comesOntoTheSurface(Twin& twin)
{
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(120);
  while (!twin.onSurface() && std::chrono::steady_clock::now() < deadline)
  {
    twin.commandMotorTorque(twin.stamp(), 0.3 - 0.01 * twin.outputs().motor_velocity);
    twin.step(twin.stamp() + twin.stepLength());
  }
  return twin.onSurface();
}

TEST(SceneAuto, FaultsOfARunningTwinGetASurfaceBuiltBeside)
{
  SurfaceSource beside = cached();
  beside.background = true;
  Twin twin(surfaceParameters(), beside);
  ASSERT_TRUE(comesOntoTheSurface(twin));
  const Fault soft{ FaultKind::FLANGE_CRACK, 1.0 };
  twin.injectFault(twin.stamp(), soft);
  twin.step(twin.stamp() + twin.stepLength());
  EXPECT_FALSE(twin.onSurface()) << "the full ring at once";
  ASSERT_TRUE(comesOntoTheSurface(twin));
  const double on_surface = twin.outputs().torsional_stiffness;
  Parameters parameters = surfaceParameters();
  parameters.faults.push_back(soft);
  Twin configured(parameters, cached());
  ASSERT_TRUE(comesOntoTheSurface(configured));
  EXPECT_NEAR(on_surface, configured.outputs().torsional_stiffness, 0.01 * on_surface);
  twin.injectFault(twin.stamp(), { FaultKind::FLANGE_CRACK, 0.0 });
  twin.step(twin.stamp() + twin.stepLength());
  EXPECT_FALSE(twin.onSurface());
  ASSERT_TRUE(comesOntoTheSurface(twin));
  EXPECT_GT(twin.outputs().torsional_stiffness, 1.02 * on_surface);
}

/// A twin that goes before its surface is built does not wait for it.
TEST(SceneAuto, GivesUpASurfaceThatIsNotWaitedFor)
{
  const auto begin = std::chrono::steady_clock::now();
  {
    SurfaceSource beside;
    beside.background = true;
    Twin twin(surfaceParameters(), beside);
    twin.step(twin.stepLength());
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}
}  // namespace
}  // namespace hjt
