// SPDX-License-Identifier: BSD-3-Clause

#include <array>
#include <chrono>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include <gmock/gmock.h>

#include "solver/joint_dynamics.hpp"
#include "statics/static_solver.hpp"
#include "test/core/response_surface_support.hpp"
#include "test/support/allocation_count.hpp"
#include "twin/growing_fault.hpp"

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
  SeededRandom random(3);
  double load = 0.0;
  double wanted = 0.0;
  double path = 0.0;
  double torque_squares = 0.0;
  double motor_torque_squares = 0.0;
  double output_squares = 0.0;
  for (int i = 0; i < STEPS; ++i)
  {
    const Stamp next = full.stamp() + full.stepLength();
    load = i % 2000 == 0 ? 80.0 * random.uniform() : load;
    wanted = i % 1500 == 0 ? 150.0 * random.uniform() : wanted;
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
  EXPECT_LT(std::sqrt(torque_squares / STEPS), 1e-3 * RATED_TORQUE);
  EXPECT_LT(std::sqrt(motor_torque_squares / STEPS), 1e-3 * RATED_MOTOR_TORQUE);
  // Stick and slip of cup and flanks carry small differences on: see docs/response_surface.md.
  EXPECT_LT(std::sqrt(output_squares / STEPS), 0.5 * ARC_SECOND);
}

TEST(SceneAuto, EnergyBalances)
{
  Twin twin(surfaceParameters(), cached());
  give(twin, randomInputs(9, SECOND, 1.5, 60.0));
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
  const std::vector<double>& mesh = forces.mesh_force;
  const double load = std::accumulate(forces.wave_generator_force.begin(), forces.wave_generator_force.end(), 0.0);
  const auto teeth = mesh.size() - static_cast<std::size_t>(std::count(mesh.begin(), mesh.end(), 0.0));
  EXPECT_NEAR(load, health.lobes.wave_generator_force, 1e-3 * load);
  EXPECT_NEAR(static_cast<double>(teeth), health.lobes.teeth_loaded, 2);
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
      each->step(nextInstant(*each));
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
    twin.step(nextInstant(twin));
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
  twin.step(nextInstant(twin));
  EXPECT_FALSE(twin.onSurface()) << "the full ring at once";
  ASSERT_TRUE(comesOntoTheSurface(twin));
  const double on_surface = twin.outputs().torsional_stiffness;
  Parameters parameters = surfaceParameters();
  parameters.faults.push_back(soft);
  Twin configured(parameters, cached());
  ASSERT_TRUE(comesOntoTheSurface(configured));
  EXPECT_NEAR(on_surface, configured.outputs().torsional_stiffness, 0.01 * on_surface);
  twin.injectFault(twin.stamp(), { FaultKind::FLANGE_CRACK, 0.0 });
  twin.step(nextInstant(twin));
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

/// What a fault changes in a steady turn under load, root mean squares, and by how much the surface misses that.
struct RunningEffect
{
  double torsion{};       // [rad]
  double torsion_miss{};  // of itself [-]
  double torque{};        // on the motor [N.m]
  double torque_miss{};
};

/// Of a twin as the full ring has it and as the surface. Without the cup's friction, whose sticking and slipping under
/// 10 kHz is as large as the effect of a tooth on either.
RunningEffect runningEffect(const std::string& fault)
{
  constexpr int STEPS = 6000;
  constexpr int SETTLED = STEPS / 2;
  std::array<std::vector<Eigen::Array2d>, 4> readings;  // full ring, surface, both sound and with the fault
  for (std::size_t kind = 0; kind < readings.size(); ++kind)
  {
    const bool fast = kind % 2 == 1;
    const std::string scene = fast ? "solver.scene=auto" : "solver.scene=full_ring";
    Parameters parameters = shippedParameters({ "input.command_timeout=10.0", "cup.friction_torque=0.0", scene });
    if (kind >= 2)
    {
      parameters.faults.push_back(parseFault(fault, parameters));
    }
    Twin twin(parameters, cached());
    double path = 0.0;
    for (int i = 0; i < STEPS; ++i)
    {
      path += 40.0 * std::min(1.0, i / 500.0) * 1e-4;
      const JointOutputs& now = twin.outputs();
      stepUnder(twin, 0.05 * (40.0 - now.motor_velocity) + 2.0 * (path - now.motor_angle),
                60.0 * std::min(1.0, i / 1000.0));
      if (i >= SETTLED)
      {
        readings[kind].emplace_back(now.motor_angle / 101.0 - now.output_angle, now.wave_generator_torque);
      }
    }
    EXPECT_EQ(twin.onSurface(), fast);
  }
  Eigen::Array2d squares = Eigen::Array2d::Zero();
  Eigen::Array2d misses = Eigen::Array2d::Zero();
  for (std::size_t i = 0; i < readings[0].size(); ++i)
  {
    const Eigen::Array2d effect = readings[2][i] - readings[0][i];
    squares += effect.square();
    misses += (readings[3][i] - readings[1][i] - effect).square();
  }
  const Eigen::Array2d size = (squares / static_cast<double>(readings[0].size())).sqrt();
  const Eigen::Array2d miss = (misses / squares).sqrt();
  return { size[0], miss[0], size[1], miss[1] };
}

TEST(SceneAuto, FaultsShowAsOnTheFullRing)
{
  for (const auto& [fault, torsion_bound] :
       { std::pair{ BROKEN_TOOTH, 0.015 }, std::pair{ "bearing_inner_race:1:15", 0.03 },
         std::pair{ "bearing_outer_race:1:17", 0.03 }, std::pair{ "bearing_ball:1:4", 0.03 },
         std::pair{ "bearing_cage:1:3", 0.03 } })
  {
    const RunningEffect effect = runningEffect(fault);
    EXPECT_GT(effect.torsion, 0.02 * ARC_SECOND) << fault;
    EXPECT_LT(effect.torsion_miss, torsion_bound) << fault;
    // Or as little as the table of the sound gear may be off.
    EXPECT_LT(effect.torque * effect.torque_miss, std::max(0.03 * effect.torque, 1e-4 * 2.87)) << fault;
  }
}

/// A twin on the full ring and one by the surface, side by side.
struct BothScenes
{
  BothScenes(const Parameters& parameters, int steps,
             const std::function<Eigen::Vector2d(int step, const JointOutputs& now)>& motor_and_load)
    : full(onFullRing(parameters), cached()), fast(parameters, cached())
  {
    const std::size_t before = allocationCount();
    std::array<double, 2> through{};
    for (int i = 0; i < steps; ++i)
    {
      std::array<Eigen::Array2d, 2> states;
      for (std::size_t k = 0; k < 2; ++k)
      {
        Twin& twin = k == 0 ? full : fast;
        const Eigen::Vector2d torques = motor_and_load(i, twin.outputs());
        stepUnder(twin, torques[0], torques[1]);
        const JointOutputs& now = twin.outputs();
        EXPECT_TRUE(now.converged) << i;
        through[k] += 1e-4 * std::abs(now.motor_torque * now.motor_velocity);
        states[k] = { now.motor_angle / 101.0 - now.output_angle, now.joint_torque };
      }
      on_ring += fast.onSurface() ? 0 : 1;
      squares += (states[1] - states[0]).square() / steps;
    }
    EXPECT_EQ(allocationCount(), before);
    EXPECT_LT(std::abs(full.outputs().energy_residual), 2e-4 * through[0]);
    EXPECT_LT(std::abs(fast.outputs().energy_residual), 2e-4 * through[1]);
  }

  static Parameters onFullRing(Parameters parameters)
  {
    parameters.solver.scene = SceneKind::FULL_RING;
    return parameters;
  }

  Twin full;
  Twin fast;
  int on_ring{};                                    // steps of the fast one that are not on its surface
  Eigen::Array2d squares = Eigen::Array2d::Zero();  // means, of differences of torsion [rad] and joint torque [N.m]
};

/// Faults that set in and grow during a run: the twin comes back onto the surface after each, and goes on as the full
/// ring does.
TEST(SceneAuto, FaultsThatSetInLaterHaveTheirSurfaces)
{
  Parameters parameters =
      shippedParameters({ "input.command_timeout=10.0", "cup.friction_torque=0.0", "solver.scene=auto" });
  for (const char* fault :
       { "flange_crack:0.5:-1:0.1", "bearing_cage:0.5:3:0.15", "bearing_cage:1:3:0.2", "bearing_cage:0:3:0.3" })
  {
    parameters.faults.push_back(parseFault(fault, parameters));
  }
  const BothScenes run(parameters, 4000,
                       [](int, const JointOutputs& now)
                       { return Eigen::Vector2d(0.6 + 0.05 * (40.0 - now.motor_velocity), 40.0); });
  EXPECT_LE(run.on_ring, 8) << "a step or two at the start and at each of four changes";
  const double released = run.full.outputs().released_energy;
  EXPECT_NEAR(run.fast.outputs().released_energy, released, 0.01 * std::abs(released));
  EXPECT_LT(std::sqrt(run.squares[0]), 0.5 * ARC_SECOND);
  EXPECT_LT(std::sqrt(run.squares[1]), 1e-3 * RATED_TORQUE);
}

/// A fault that grows, and how far its run between tables may be from that on the full ring, root mean square.
struct Growth
{
  const char* name;
  std::string fault;
  double torsion;       // [seconds of arc]
  double joint_torque;  // [N.m]
};

using SurfacesOfAGrowth = testing::TestWithParam<Growth>;
// A step of the staircase, of which half is what growth is resolved to: 0.3 to 5 seconds of arc at 60 N.m.
INSTANTIATE_TEST_SUITE_P(All, SurfacesOfAGrowth,
                         testing::Values(Growth{ "tooth", "tooth_root_crack:1:40", 0.1, 0.03 },
                                         Growth{ "interface", "interface_wear:0.6", 0.15, 0.04 },
                                         Growth{ "flanks", "tooth_wear:0.6", 0.5, 0.15 },
                                         Growth{ "cup", "rear_section_crack:0.8", 0.1, 0.03 }),
                         [](const auto& row) { return std::string(row.param.name); });

TEST_P(SurfacesOfAGrowth, FollowTheFullRing)
{
  constexpr int STEPS = 11000;
  // Its tables hold the torques that this motion brings and little more.
  Parameters parameters = shippedParameters({ "input.command_timeout=10.0", "solver.scene=auto",
                                              "output.load_torque_limit=100.0", "motor.torque_limit=1.0" });
  GrowingFault growing{ parseFault(GetParam().fault, parameters), 1.0 };
  growing.fault.onset = 0.05;
  parameters.faults = growing.steps();
  std::vector<double> paths{ 0.0 };  // of the motor [rad]
  for (int i = 1; i < STEPS; ++i)
  {
    paths.push_back(paths.back() + 40.0 * std::min(1.0, i / 300.0) * 1e-4);
  }
  const BothScenes run(parameters, STEPS,
                       [&](int i, const JointOutputs& now)
                       {
                         const double load = 60.0 * std::sin(TWO_PI * 6e-4 * i);
                         const double behind = paths[static_cast<std::size_t>(i)] - now.motor_angle;
                         return Eigen::Vector2d(0.05 * (40.0 - now.motor_velocity) + 2.0 * behind + load / 101.0, load);
                       });
  EXPECT_LT(run.on_ring, 0.02 * STEPS);
  const Eigen::Array2d miss = run.squares.sqrt();
  EXPECT_LT(miss[0], GetParam().torsion * ARC_SECOND);
  EXPECT_LT(miss[1], GetParam().joint_torque);
}

/// A surface between others is one energy, whose weights sum up to 1.
TEST(ResponseSurface, OfSharesIsTheirSum)
{
  const auto whole = std::make_shared<const ResponseSurface>(
      obtainSurface(surfaceParameters(), JointModel(surfaceParameters()), "", cached())->table);
  const auto broken = std::make_shared<const ResponseSurface>(surface().table(), brokenTables().deviations);
  const ResponseSurface between({ { whole, 0.75 }, { broken, 0.25 } });
  SeededRandom random(3);
  for (int i = 0; i < 500; ++i)
  {
    const double motor = 10.0 * random.uniform();
    const double output = motor / 101.0 + 5e-3 * random.uniform();
    const auto values = [&](const ResponseSurface& of)
    {
      const ResponseSurface::Place place = placeOn(of, motor, output);
      const RingResponse response = of.response(place);
      return Eigen::Array3d(response.energy, response.output_torque,
                            ResponseSurface::value(place, SurfaceNode::CONTACT_FORCE));
    };
    const Eigen::Array3d off = (values(between) - 0.75 * values(*whole) - 0.25 * values(*broken)).abs();
    EXPECT_TRUE((off < Eigen::Array3d(1e-12, 1e-9, 1e-2)).all()) << off.transpose();
  }
}

/// Each table but the first costs a build: faults that set in together share one, and of many only the last have one.
TEST(SceneAuto, ManyFaultsThatSetInLaterHaveFewTables)
{
  Parameters parameters = surfaceParameters();
  std::string notice;
  SurfaceSource source = cached();
  source.notice = [&](const std::string& what) { notice = what; };
  for (const char* fault : { "flange_crack:0.1:-1:0.002", "flange_crack:0.2:-1:0.002", "flange_crack:0.3:-1:0.002",
                             "flange_crack:0.5:-1:0.002" })
  {
    parameters.faults.push_back(parseFault(fault, parameters));
  }
  const auto surfaces_after = [&](std::initializer_list<Stamp> instants)
  {
    Twin twin(parameters, source);
    std::vector<bool> on_surface;
    for (const Stamp instant : instants)
    {
      advance(twin, instant);
      on_surface.push_back(twin.onSurface());
    }
    return on_surface;
  };
  EXPECT_THAT(surfaces_after({ 1'900'000, 2'500'000 }), testing::ElementsAre(true, true));
  EXPECT_EQ(notice, "");
  for (std::size_t i = 0; i < parameters.faults.size(); ++i)
  {
    parameters.faults[i].onset += 0.001 * static_cast<double>(i);
  }
  EXPECT_THAT(surfaces_after({ 1'900'000, 2'500'000, 4'900'000, 5'500'000 }),
              testing::ElementsAre(true, false, false, true));
  EXPECT_THAT(notice, testing::HasSubstr(" sets of faults have no response surface"));
}
}  // namespace
}  // namespace hjt
