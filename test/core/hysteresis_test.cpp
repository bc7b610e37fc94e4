// SPDX-License-Identifier: BSD-3-Clause
// Friction that remembers: the cup's Maxwell-slip elements and presliding at the shaft; the rim's own loss; friction of
// the output.

#include <array>
#include <limits>

#include <gmock/gmock.h>

#include "elements/friction_laws.hpp"
#include "elements/ring_friction.hpp"
#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/statics/loss_analysis.hpp"
#include "harmonic_joint_twin/statics/torsion_loop.hpp"
#include "statics/static_solver.hpp"
#include "test/core/stepped_joint.hpp"
#include "test/core/test_parameters.hpp"
#include "test/core/twin_runs.hpp"
#include "tracking/friction_map.hpp"
#include "tracking/observer.hpp"

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

/// Sum over elements of what one of a width [rad] adds, times their stiffness.
template <class Part>
double overElements(const Part& part)
{
  double widths = 0.0;
  double sum = 0.0;
  for (int j = 0; j < CupFriction::ELEMENTS; ++j)
  {
    const double width = 0.5 * ANGLE * std::pow(3.0, -j);
    widths += width;
    sum += part(width);
  }
  return FRICTION / widths * sum;
}

/// Torque of the unloaded elements at a rotation.
double firstLoading(double rotation)
{
  return overElements([&](double width) { return std::min(rotation, width); });
}

/// Energy of a closed loop, 4 k w_j (A - w_j) for every element that slips.
double loopEnergy(double amplitude)
{
  return overElements([&](double width) { return 4.0 * width * std::max(amplitude - width, 0.0); });
}

/// The elements after a way through these rotations, in `steps` steps a piece; `slipped`: by then [J].
CupFriction::State after(const std::vector<double>& rotations, int steps = 1)
{
  const CupFriction friction = cupFriction();
  CupFriction::State state = friction.relaxed(0.0);
  double slipped = 0.0;
  for (const double end : rotations)
  {
    const double start = state.rotation;
    for (int i = 1; i <= steps; ++i)
    {
      state = friction.turned(state, i == steps ? end : start + (end - start) * i / steps);
      slipped += state.slipped;
    }
  }
  state.slipped = slipped;
  return state;
}

TEST(CupFriction, LosesTheAreaOfItsLoop)
{
  for (const double amplitude : AMPLITUDES)
  {
    const double first = after({ amplitude }).slipped;
    const double both = after({ amplitude, -amplitude, amplitude }).slipped;
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
      const double torque = after({ amplitude, amplitude - turn }).torque;
      EXPECT_NEAR(torque, firstLoading(amplitude) - 2.0 * firstLoading(0.5 * turn), 1e-12) << amplitude << " " << part;
    }
  }
  EXPECT_NEAR(after({ 0.1 }).torque, FRICTION, 1e-12);
}

TEST(CupFriction, DoesNotDependOnTheRate)
{
  const std::vector<double> way{ 3e-4, -1e-4, 5e-5, -7e-4, 2e-4 };
  const CupFriction::State one = after(way);
  const CupFriction::State many = after(way, 1000);
  EXPECT_NEAR(one.torque, many.torque, 1e-12);
  EXPECT_NEAR(one.slipped, many.slipped, 1e-15);
}

TEST(CupFriction, GivesBackWhatItStores)
{
  SeededRandom random(71);
  const CupFriction friction = cupFriction();
  CupFriction::State state = friction.relaxed(0.0);
  double work = 0.0;
  double slipped = 0.0;
  for (int i = 0; i < 20000; ++i)
  {
    constexpr int PARTS = 64;
    const double end = state.rotation + 3e-5 * random.normal();
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
  const CupFriction friction = cupFriction();
  const CupFriction::State state = after({ 3e-4, 2.5e-4, 2.502e-4 });
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

TEST(Hysteresis, BalancesItsEnergyInTheRunningJoint)
{
  // The motor is held, the output swings under a load that comes and goes.
  SteppedJoint joint(shippedParameters({ "cup.friction_angle=5.0e-4", "output.load_inertia=0.1",
                                         "mesh.friction_static=0.0", "mesh.friction_kinetic=0.0" }));
  joint.inputs.brake_engaged = true;
  double residual = 0.0;
  joint.run(20000,
            [&](int i)
            {
              residual = std::max(residual, std::abs(joint.stepper.energyResidual()));
              joint.inputs.load_torque = 20.0 * std::sin(TWO_PI * 2.0 * i / joint.parameters.solver.rate);
            });
  residual = std::max(residual, std::abs(joint.stepper.energyResidual()));
  EXPECT_LT(residual, 1e-4 * joint.stepper.energyThroughput());
  // Four swings, the first from rest: less than four loops of the cup's rotation at 20 N.m less the friction.
  EXPECT_GT(joint.stepper.dissipatedEnergy(), 3.5 * loopEnergy(5.1e-4));
  EXPECT_LT(joint.stepper.dissipatedEnergy(), 4.1 * loopEnergy(5.1e-4));
}

TEST(Hysteresis, StiffensTheJointWhereTheStepIsJudged)
{
  const auto phase = [](const char* angle, const char* inertia = "output.load_inertia=0.5") {
    return SteppedJoint(shippedParameters({ "cup.friction_torque=1.4", angle, inertia })).stepper.phaseAdvance();
  };
  const double rigid = phase("cup.friction_angle=0.0");
  const double soft = phase("cup.friction_angle=5.0e-4");
  // 22.4e3 beside the 32.5e3 N.m/rad of the cup, rim and teeth in series.
  EXPECT_NEAR(soft / rigid, std::sqrt(1.0 + 22.4e3 / 32.5e3), 0.04);
  EXPECT_NO_THROW(phase("cup.friction_angle=5.0e-4", "output.load_inertia=0.01"));
  EXPECT_THROW(phase("cup.friction_angle=1.0e-6", "output.load_inertia=0.01"), ParameterError);
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
      if (i % 3000 == 0)
      {
        twin.commandBrake(nextInstant(twin), i == 0);
      }
      stepUnder(twin, i < 3000 ? 0.0 : 0.5 * std::sin(0.004 * i), 20.0 * std::sin(0.01 * i));
      torsion[fast ? 1 : 0].push_back(twin.outputs().motor_angle / 101.0 - twin.outputs().output_angle);
    }
    ASSERT_EQ(twin.onSurface(), fast);
    dissipated[fast ? 1 : 0] = twin.outputs().dissipated_energy;
  }
  EXPECT_THAT(torsion[0], testing::Pointwise(testing::DoubleNear(2e-6), torsion[1]));
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
  const double residual = twin.outputs().energy_residual;
  twin.injectFault(twin.stamp() + 1, { FaultKind::FLANGE_CRACK, 0.5 });
  twin.step(twin.stamp() + twin.stepLength());
  EXPECT_GT(std::abs(twin.outputs().released_energy), 1e-6);
  EXPECT_NEAR(twin.outputs().energy_residual, residual, 2e-5);
  twin.reset(0);
  EXPECT_EQ(run(0), first);
}

TEST(Presliding, LetsTheShaftTurnAsDahlsLaw)
{
  // Torque grows slowly to 60 % of the friction and falls to nothing: the motor follows Dahl's curve.
  constexpr double PRESLIDING = 3e-3;  // [rad]
  SteppedJoint joint(shippedParameters({ "motor.presliding_angle=3.0e-3", "mesh.friction_static=0.0",
                                         "mesh.friction_kinetic=0.0", "output.viscous_friction=50.0" }));
  joint.run(1);
  const double friction = joint.stepper.dynamics().friction().presliding;
  EXPECT_GT(friction, 0.05);
  constexpr int STEPS = 20000;
  joint.run(STEPS, [&](int i) { joint.inputs.motor_torque = 0.6 * friction * i / STEPS; });
  const double turned = joint.stepper.motorAngle();
  const double share = mobilised(0.0, turned, PRESLIDING);
  EXPECT_NEAR(share * friction, joint.inputs.motor_torque, 0.02 * friction);
  joint.run(STEPS, [&](int i) { joint.inputs.motor_torque = 0.6 * friction * (STEPS - i) / STEPS; });
  // Back by x: s = -1 + (s0 + 1) exp(-x / x_p) = 0.
  EXPECT_NEAR(turned - joint.stepper.motorAngle(), PRESLIDING * std::log(1.0 + share), 0.05 * PRESLIDING);
  EXPECT_LT(std::abs(joint.stepper.energyResidual()), 1e-4 * joint.stepper.energyThroughput());
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
}

TEST(OutputFriction, HoldsTheOutputAndMustBeOvercome)
{
  const std::vector<std::string> with{ "output.coulomb_torque=2.0", "output.tilting_moment=60.0",
                                       "output.tilting_friction=0.05" };
  const Parameters parameters = shippedParameters(with);
  SteppedJoint joint(parameters);
  EXPECT_NEAR(joint.model.load.dryFriction(), 5.0, 1e-14);
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
  joint.inputs.brake_engaged = true;
  const double start = joint.stepper.outputAngle();
  const auto settle = [&](double load)
  {
    joint.inputs.load_torque = load;
    joint.run(10000);
    return start - joint.stepper.outputAngle();
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
  EXPECT_LT(largest[1], 0.3 * largest[0]);
  EXPECT_LT(residual[1], 1e-3);
}
}  // namespace
}  // namespace hjt
