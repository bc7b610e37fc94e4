// SPDX-License-Identifier: BSD-3-Clause
// Friction that remembers: the cup's Maxwell-slip elements and presliding at the shaft; the rim's own loss; friction of
// the output.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
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
constexpr double FRICTION = 1.4;                                         // [N.m]
constexpr double ANGLE = 0.5e-3;                                         // [rad]
constexpr std::array<double, 4> AMPLITUDES{ 2e-5, 6e-5, 1.5e-4, 6e-4 };  // of the rim's mean rotation [rad]

CupFriction cupFriction()
{
  CupParameters parameters;
  parameters.friction_torque = FRICTION;
  parameters.friction_angle = ANGLE;
  return CupFriction(parameters);
}

/// Torque of the unloaded elements at a rotation, as a sum over elements.
double firstLoading(double rotation)
{
  double widths = 0.0;
  double sum = 0.0;
  for (int j = 0; j < CupFriction::ELEMENTS; ++j)
  {
    const double width = 0.5 * ANGLE * std::pow(3.0, -j);
    widths += width;
    sum += std::min(rotation, width);
  }
  return FRICTION / widths * sum;
}

/// Energy of a closed loop, 4 k w_j (A - w_j) for every element that slips.
double loopEnergy(double amplitude)
{
  double widths = 0.0;
  double sum = 0.0;
  for (int j = 0; j < CupFriction::ELEMENTS; ++j)
  {
    const double width = 0.5 * ANGLE * std::pow(3.0, -j);
    widths += width;
    sum += 4.0 * width * std::max(amplitude - width, 0.0);
  }
  return FRICTION / widths * sum;
}

/// The elements after a way through these rotations, in `steps` steps a piece.
CupFriction::State after(const std::vector<double>& rotations, int steps, double& slipped)
{
  const CupFriction friction = cupFriction();
  CupFriction::State state = friction.relaxed(0.0);
  slipped = 0.0;
  for (const double end : rotations)
  {
    const double start = state.rotation;
    for (int i = 1; i <= steps; ++i)
    {
      state = friction.turned(state, i == steps ? end : start + (end - start) * i / steps);
      slipped += state.slipped;
    }
  }
  return state;
}

TEST(CupFriction, LosesTheAreaOfItsLoop)
{
  for (const double amplitude : AMPLITUDES)
  {
    double first = 0.0;
    double both = 0.0;
    after({ amplitude }, 1, first);
    after({ amplitude, -amplitude, amplitude }, 1, both);
    EXPECT_NEAR(both - first, loopEnergy(amplitude), 1e-15 + 1e-12 * both) << amplitude;
  }
}

TEST(CupFriction, BranchesAreTheFirstLoadingTwiceAsLarge)
{
  // Masing's rule, at small and large loops.
  for (const double amplitude : AMPLITUDES)
  {
    for (const double part : { 0.1, 0.3, 0.7, 1.0 })
    {
      const double turn = 2.0 * amplitude * part;
      double unused = 0.0;
      const double torque = after({ amplitude, amplitude - turn }, 1, unused).torque;
      EXPECT_NEAR(torque, firstLoading(amplitude) - 2.0 * firstLoading(0.5 * turn), 1e-12) << amplitude << " " << part;
    }
  }
  double unused = 0.0;
  EXPECT_NEAR(after({ 0.1 }, 1, unused).torque, FRICTION, 1e-12);
}

TEST(CupFriction, DoesNotDependOnTheRate)
{
  const std::vector<double> way{ 3e-4, -1e-4, 5e-5, -7e-4, 2e-4 };
  double coarse = 0.0;
  double fine = 0.0;
  const CupFriction::State one = after(way, 1, coarse);
  const CupFriction::State many = after(way, 1000, fine);
  EXPECT_NEAR(one.torque, many.torque, 1e-12);
  EXPECT_NEAR(coarse, fine, 1e-15);
}

TEST(CupFriction, GivesBackWhatItStores)
{
  constexpr unsigned SEED = 71;
  std::mt19937 random(SEED);
  std::normal_distribution<double> turn(0.0, 3e-5);
  const CupFriction friction = cupFriction();
  CupFriction::State state = friction.relaxed(0.0);
  double work = 0.0;
  double slipped = 0.0;
  for (int i = 0; i < 20000; ++i)
  {
    constexpr int PARTS = 64;
    const double end = state.rotation + turn(random);
    const double start = state.rotation;
    for (int k = 1; k <= PARTS; ++k)
    {
      const CupFriction::State next = friction.turned(state, start + (end - start) * k / PARTS);
      work += 0.5 * (state.torque + next.torque) * (next.rotation - state.rotation);
      slipped += next.slipped;
      ASSERT_GE(next.slipped, 0.0);
      // Never falls as the rim turns on.
      ASSERT_GE((next.torque - state.torque) * (next.rotation - state.rotation), -1e-18);
      state = next;
    }
  }
  EXPECT_GT(slipped, 1e-2);
  EXPECT_NEAR(work, state.energy + slipped, 1e-4 * slipped);
}

TEST(CupFriction, TorqueIsTheStoredEnergysDerivativeWhileNothingSlips)
{
  constexpr double STEP = 1e-8;
  double unused = 0.0;
  const CupFriction friction = cupFriction();
  const CupFriction::State state = after({ 3e-4, 2.5e-4, 2.502e-4 }, 1, unused);
  // Backwards from a forward turn and forwards: sticking elements only, as far as they stick.
  const CupFriction::State here = friction.turned(state, state.rotation - 1e-7);
  const auto energy = [&](double by) { return friction.turned(here, here.rotation + by).energy; };
  const auto torque = [&](double by) { return friction.turned(here, here.rotation + by).torque; };
  ASSERT_EQ(friction.turned(here, here.rotation + STEP).slipped, 0.0);
  ASSERT_EQ(friction.turned(here, here.rotation - STEP).slipped, 0.0);
  EXPECT_NEAR(here.torque, (energy(STEP) - energy(-STEP)) / (2.0 * STEP), 1e-7);
  EXPECT_NEAR(here.stiffness, (torque(STEP) - torque(-STEP)) / (2.0 * STEP), 1e-5 * here.stiffness);
  EXPECT_EQ(here.stiffness, friction.stiffness());
}

TEST(TorsionLoop, GrowsWithItsAmplitude)
{
  const Parameters parameters = shippedParameters({ "cup.friction_torque=1.4", "cup.friction_angle=5.0e-4",
                                                    "mesh.friction_static=0.0", "mesh.friction_kinetic=0.0" });
  const JointModel model(parameters);
  const auto& cup = model.ring.of<CupTorsion>();
  double last = 0.0;
  for (const double torque : { 2.0, 5.0, 14.0, 67.0 })
  {
    const TorsionLoop loop = analyseTorsionLoop(parameters, torque, 0.5 * torque, 400);
    ASSERT_TRUE(loop.status.ok());
    double area = 0.0;
    for (std::size_t i = 1; i < loop.points.size(); ++i)
    {
      const TorsionPoint& a = loop.points[i - 1];
      const TorsionPoint& b = loop.points[i];
      area += 0.5 * (a.torque + b.torque) * (b.output_angle - a.output_angle);
    }
    // The housing holds the load less what the wave generator does.
    EXPECT_NEAR(area, loopEnergy(cup.rotationAtTorque(torque * 100.0 / 101.0)), 0.002 * area) << torque;
    EXPECT_GE(loop.hysteresis, last);
    last = loop.hysteresis;
  }
  EXPECT_NEAR(last, 2.0 * FRICTION / parameters.cup.torsion_stiffness[0], 0.02 * last);
}

/// The motor is held, the output swings under a load that comes and goes.
struct Swing
{
  double residual;    // of the energy, largest [J]
  double throughput;  // [J]
  double dissipated;  // [J]
};

Swing swing(const std::vector<std::string>& assignments, double amplitude)
{
  std::vector<std::string> all{ "mesh.friction_static=0.0", "mesh.friction_kinetic=0.0" };
  all.insert(all.end(), assignments.begin(), assignments.end());
  const Parameters parameters = shippedParameters(all);
  const JointModel model(parameters);
  JointStepper stepper(parameters, model);
  JointInputs inputs;
  inputs.temperature = parameters.input.temperature;
  inputs.brake_engaged = true;
  Swing result{};
  for (int i = 1; i <= 20000; ++i)
  {
    inputs.load_torque = amplitude * std::sin(TWO_PI * 2.0 * i / parameters.solver.rate);
    EXPECT_TRUE(stepper.step(inputs));
    result.residual = std::max(result.residual, std::abs(stepper.energyResidual()));
  }
  result.throughput = stepper.energyThroughput();
  result.dissipated = stepper.dissipatedEnergy();
  return result;
}

TEST(Hysteresis, BalancesItsEnergyInTheRunningJoint)
{
  const Swing seen = swing({ "cup.friction_angle=5.0e-4", "output.load_inertia=0.1" }, 20.0);
  EXPECT_LT(seen.residual, 1e-4 * seen.throughput);
  // Four swings, the first from rest: less than four loops of the cup's rotation at 20 N.m less the friction.
  EXPECT_GT(seen.dissipated, 3.5 * loopEnergy(5.1e-4));
  EXPECT_LT(seen.dissipated, 4.1 * loopEnergy(5.1e-4));
}

TEST(Hysteresis, StiffensTheJointWhereTheStepIsJudged)
{
  const auto phase = [](const char* angle)
  {
    const Parameters parameters = shippedParameters({ "cup.friction_torque=1.4", angle });
    const JointModel model(parameters);
    const JointStepper stepper(parameters, model);
    return stepper.phaseAdvance();
  };
  const double rigid = phase("cup.friction_angle=0.0");
  const double soft = phase("cup.friction_angle=5.0e-4");
  // 22.4e3 beside the 32.5e3 N.m/rad of the cup, rim and teeth in series.
  EXPECT_NEAR(soft / rigid, std::sqrt(1.0 + 22.4e3 / 32.5e3), 0.04);
  const auto make = [](const char* angle)
  {
    const Parameters parameters = shippedParameters({ "cup.friction_torque=1.4", "output.load_inertia=0.01", angle });
    const JointModel model(parameters);
    JointStepper(parameters, model);
  };
  EXPECT_NO_THROW(make("cup.friction_angle=5.0e-4"));
  EXPECT_THROW(make("cup.friction_angle=1.0e-6"), ParameterError);
}

TEST(Hysteresis, IsTheSameOnTheSurface)
{
  // A swing against the brake, then a turn to and fro: torsion and energy as on the full ring.
  std::array<std::vector<double>, 2> torsion;
  std::array<double, 2> dissipated{};
  for (const bool fast : { false, true })
  {
    const Parameters parameters =
        shippedParameters({ "cup.friction_angle=5.0e-4", "motor.presliding_angle=3.0e-3", "output.coulomb_torque=0.5",
                            "ring.loss_factor=0.005", "motor.stribeck_torque=0.02", "input.command_timeout=10.0",
                            fast ? "solver.scene=auto" : "solver.scene=full_ring" });
    Twin twin(parameters, {});
    for (int i = 0; i < 6000; ++i)
    {
      const Stamp next = twin.stamp() + twin.stepLength();
      if (i % 3000 == 0)
      {
        twin.push({ next, InputKind::BRAKE, i == 0 ? 1.0 : 0.0 });
      }
      twin.commandLoadTorque(next, 20.0 * std::sin(0.01 * i));
      twin.commandMotorTorque(next, i < 3000 ? 0.0 : 0.5 * std::sin(0.004 * i));
      twin.step(next);
      torsion[fast ? 1 : 0].push_back(twin.outputs().motor_angle / 101.0 - twin.outputs().output_angle);
    }
    ASSERT_EQ(twin.onSurface(), fast);
    dissipated[fast ? 1 : 0] = twin.outputs().dissipated_energy;
  }
  for (std::size_t i = 0; i < torsion[0].size(); ++i)
  {
    ASSERT_NEAR(torsion[0][i], torsion[1][i], 2e-6) << i;
  }
  EXPECT_NEAR(dissipated[0], dissipated[1], 2e-3 * dissipated[0]);
}

TEST(Hysteresis, SurvivesAFaultAndEndsWithAReset)
{
  const Parameters parameters = shippedParameters({ "cup.friction_angle=5.0e-4", "motor.presliding_angle=3.0e-3" });
  Twin twin(parameters);
  const auto run = [&](Stamp from)
  {
    for (int i = 1; i <= 2000; ++i)
    {
      const Stamp next = from + i * twin.stepLength();
      twin.commandLoadTorque(next, 20.0 * std::sin(0.02 * i));
      twin.step(next);
    }
    return numbers(twin.outputs());
  };
  twin.reset(0);
  const std::vector<double> first = run(0);
  Fault fault;
  fault.kind = FaultKind::FLANGE_CRACK;
  fault.severity = 0.5;
  const double residual = twin.outputs().energy_residual;
  twin.injectFault(twin.stamp() + 1, fault);
  twin.step(twin.stamp() + twin.stepLength());
  EXPECT_GT(std::abs(twin.outputs().released_energy), 1e-6);
  EXPECT_NEAR(twin.outputs().energy_residual, residual, 2e-5);
  twin.reset(0);
  EXPECT_EQ(run(0), first);
}
}  // namespace
}  // namespace hjt
