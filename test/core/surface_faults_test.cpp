// SPDX-License-Identifier: BSD-3-Clause
#include "solver/response_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "model/faults/joint_faults.hpp"
#include "model/joint_model.hpp"
#include "surface/faulty_surface.hpp"
#include "surface/surface_cache.hpp"
#include "test/core/response_surface_support.hpp"
#include "test/support/allocation_count.hpp"
#include "test_parameters.hpp"
#include "twin/growing_fault.hpp"
#include "twin_runs.hpp"

namespace hjt
{
namespace
{
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
      const Stamp next = twin.stamp() + twin.stepLength();
      path += 40.0 * std::min(1.0, i / 500.0) * 1e-4;
      const JointOutputs& now = twin.outputs();
      twin.commandLoadTorque(next, 60.0 * std::min(1.0, i / 1000.0));
      twin.commandMotorTorque(next, 0.05 * (40.0 - now.motor_velocity) + 2.0 * (path - now.motor_angle));
      twin.step(next);
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
    RecordProperty(fault, std::to_string(effect.torsion / ARC_SECOND) + " arcsec, " +
                              std::to_string(effect.torsion_miss) + "; " + std::to_string(effect.torque) + " N.m, " +
                              std::to_string(effect.torque_miss));
    EXPECT_GT(effect.torsion, 0.02 * ARC_SECOND) << fault;
    EXPECT_LT(effect.torsion_miss, torsion_bound) << fault;
    // Or as little as the table of the sound gear may be off.
    EXPECT_LT(effect.torque * effect.torque_miss, std::max(0.03 * effect.torque, 1e-4 * 2.87)) << fault;
  }
}

/// Faults that set in and grow during a run: the twin comes back onto the surface after each, and goes on as the full
/// ring does.
TEST(SceneAuto, FaultsThatSetInLaterHaveTheirSurfaces)
{
  constexpr int STEPS = 4000;
  std::vector<Eigen::Array3d> ring;
  for (const char* scene : { "solver.scene=full_ring", "solver.scene=auto" })
  {
    Parameters parameters = shippedParameters({ "input.command_timeout=10.0", "cup.friction_torque=0.0", scene });
    for (const char* fault :
         { "flange_crack:0.5:-1:0.1", "bearing_cage:0.5:3:0.15", "bearing_cage:1:3:0.2", "bearing_cage:0:3:0.3" })
    {
      parameters.faults.push_back(parseFault(fault, parameters));
    }
    Twin twin(parameters, cached());
    double through = 0.0;
    int on_ring = 0;
    Eigen::Array2d misses = Eigen::Array2d::Zero();
    double released = 0.0;
    ring.reserve(STEPS);
    const std::size_t before = allocationCount();
    for (int i = 0; i < STEPS; ++i)
    {
      const Stamp next = twin.stamp() + twin.stepLength();
      twin.commandLoadTorque(next, 40.0);
      twin.commandMotorTorque(next, 0.6 + 0.05 * (40.0 - twin.outputs().motor_velocity));
      twin.step(next);
      const JointOutputs& now = twin.outputs();
      ASSERT_TRUE(now.converged);
      through += 1e-4 * std::abs(now.motor_torque * now.motor_velocity);
      on_ring += twin.onSurface() ? 0 : 1;
      if (parameters.solver.scene == SceneKind::FULL_RING)
      {
        ring.emplace_back(now.joint_torque, now.motor_angle / 101.0 - now.output_angle, now.released_energy);
      }
      else
      {
        misses += (Eigen::Array2d(now.joint_torque, now.motor_angle / 101.0 - now.output_angle) -
                   ring[static_cast<std::size_t>(i)].head<2>())
                      .square();
        released = now.released_energy;
      }
    }
    EXPECT_EQ(allocationCount(), before) << scene;
    EXPECT_LT(std::abs(twin.outputs().energy_residual), 2e-4 * through) << scene;
    if (parameters.solver.scene == SceneKind::AUTO)
    {
      EXPECT_LE(on_ring, 8) << "a step or two at the start and at each of four changes";
      EXPECT_NEAR(released, ring.back()[2], 0.01 * std::abs(ring.back()[2]));
      EXPECT_LT(std::sqrt(misses[0] / STEPS), 1e-3 * RATED_TORQUE);
      EXPECT_LT(std::sqrt(misses[1] / STEPS), 0.5 * ARC_SECOND);
    }
  }
}

/// A fault that grows, and how far its run between tables may be from that on the full ring, root mean square.
struct Growth
{
  const char* name;
  std::string fault;
  double torsion;       // [seconds of arc]
  double joint_torque;  // [N.m]
};

class SurfacesOfAGrowth : public testing::TestWithParam<Growth>
{
};
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
  const Growth& growth = GetParam();
  std::vector<Eigen::Array2d> ring;
  for (const char* scene : { "solver.scene=full_ring", "solver.scene=auto" })
  {
    // Its tables hold the torques that this motion brings and little more.
    Parameters parameters = shippedParameters(
        { "input.command_timeout=10.0", scene, "output.load_torque_limit=100.0", "motor.torque_limit=1.0" });
    GrowingFault growing{ parseFault(growth.fault, parameters), 1.0 };
    growing.fault.onset = 0.05;
    parameters.faults = growing.steps();
    Twin twin(parameters, cached());
    Eigen::Array2d squares = Eigen::Array2d::Zero();
    double through = 0.0;
    double path = 0.0;
    int on_ring = 0;
    for (int i = 0; i < STEPS; ++i)
    {
      const Stamp next = twin.stamp() + twin.stepLength();
      const double load = 60.0 * std::sin(TWO_PI * 6e-4 * i);
      path += 40.0 * std::min(1.0, i / 300.0) * 1e-4;
      const JointOutputs before = twin.outputs();
      twin.commandLoadTorque(next, load);
      twin.commandMotorTorque(next,
                              0.05 * (40.0 - before.motor_velocity) + 2.0 * (path - before.motor_angle) + load / 101.0);
      twin.step(next);
      const JointOutputs now = twin.outputs();
      ASSERT_TRUE(now.converged);
      through += 1e-4 * std::abs(now.motor_torque * now.motor_velocity);
      on_ring += twin.onSurface() ? 0 : 1;
      const Eigen::Array2d state(now.motor_angle / 101.0 - now.output_angle, now.joint_torque);
      if (parameters.solver.scene == SceneKind::FULL_RING)
      {
        ring.push_back(state);
        continue;
      }
      squares += (state - ring[static_cast<std::size_t>(i)]).square();
    }
    EXPECT_LT(std::abs(twin.outputs().energy_residual), 2e-4 * through) << scene;
    if (parameters.solver.scene == SceneKind::AUTO)
    {
      EXPECT_LT(on_ring, 0.02 * STEPS);
      const Eigen::Array2d miss = (squares / STEPS).sqrt();
      RecordProperty("torsion", std::to_string(miss[0] / ARC_SECOND) + " arcsec");
      RecordProperty("joint_torque", std::to_string(miss[1]) + " N.m");
      EXPECT_LT(miss[0], growth.torsion * ARC_SECOND);
      EXPECT_LT(miss[1], growth.joint_torque);
    }
  }
}

/// A surface between others is one energy, whose weights sum up to 1.
TEST(ResponseSurface, OfSharesIsTheirSum)
{
  const auto whole = std::make_shared<const ResponseSurface>(
      obtainSurface(surfaceParameters(), JointModel(surfaceParameters()), "", cached())->table);
  const auto broken = std::make_shared<const ResponseSurface>(
      surface().table(), obtainSurface(surfaceParameters(), brokenModel(), "broken tooth 40 ", cached())->deviations);
  const ResponseSurface between({ { whole, 0.75 }, { broken, 0.25 } });
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  for (int i = 0; i < 500; ++i)
  {
    const double motor = 10.0 * part(random);
    const double output = motor / 101.0 + 5e-3 * part(random);
    std::array<ResponseSurface::Place, 3> places;
    ASSERT_TRUE(between.locate(motor, output, places[0]) && whole->locate(motor, output, places[1]) &&
                broken->locate(motor, output, places[2]));
    const RingResponse sum = between.response(places[0]);
    const RingResponse first = whole->response(places[1]);
    const RingResponse second = broken->response(places[2]);
    EXPECT_NEAR(sum.energy, 0.75 * first.energy + 0.25 * second.energy, 1e-12);
    EXPECT_NEAR(sum.output_torque, 0.75 * first.output_torque + 0.25 * second.output_torque, 1e-9);
    EXPECT_NEAR(ResponseSurface::value(places[0], SurfaceNode::CONTACT_FORCE),
                0.75 * ResponseSurface::value(places[1], SurfaceNode::CONTACT_FORCE) +
                    0.25 * ResponseSurface::value(places[2], SurfaceNode::CONTACT_FORCE),
                1e-2);
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
      while (twin.stamp() < instant)
      {
        twin.step(instant);
      }
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
