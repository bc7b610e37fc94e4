// SPDX-License-Identifier: BSD-3-Clause
#include <limits>
#include <optional>

#include "elements/drive_heat.hpp"
#include "elements/friction_laws.hpp"
#include "test/support/allocation_count.hpp"
#include "test_parameters.hpp"
#include "tracking/drive_temperature.hpp"
#include "tracking/tracker.hpp"
#include "twin_runs.hpp"

namespace hjt
{
namespace
{
constexpr double AMBIENT = 20.0;

ThermalParameters twoNodes()
{
  ThermalParameters parameters = shippedParameters().thermal;
  parameters.model = ThermalModel::TWO_NODES;
  parameters.grease_rise = 3.0;
  parameters.housing_rise = 1.0;
  return parameters;
}

DriveHeat heatAtRest(const ThermalParameters& parameters)
{
  DriveHeat heat(parameters);
  heat.reset(AMBIENT);
  return heat;
}

struct Nodes
{
  double grease;
  double housing;
};

/// The two differential equations by small classical Runge-Kutta steps.
Nodes marched(const ThermalParameters& p, Nodes nodes, double seconds, double friction, double copper)
{
  constexpr int STEPS = 20000;
  const double h = seconds / STEPS;
  const auto rate = [&](const Nodes& at)
  {
    const double inner = p.internal_conductance * (at.grease - at.housing);
    return Nodes{ (friction - inner) / p.grease_capacity,
                  (copper + p.standby_power + inner - p.ambient_conductance * (at.housing - AMBIENT)) /
                      p.housing_capacity };
  };
  const auto moved = [](const Nodes& at, const Nodes& by, double length) {
    return Nodes{ at.grease + length * by.grease, at.housing + length * by.housing };
  };
  for (int i = 0; i < STEPS; ++i)
  {
    const Nodes a = rate(nodes);
    const Nodes b = rate(moved(nodes, a, 0.5 * h));
    const Nodes c = rate(moved(nodes, b, 0.5 * h));
    const Nodes d = rate(moved(nodes, c, h));
    const Nodes mean{ (a.grease + 2.0 * b.grease + 2.0 * c.grease + d.grease) / 6.0,
                      (a.housing + 2.0 * b.housing + 2.0 * c.housing + d.housing) / 6.0 };
    nodes = moved(nodes, mean, h);
  }
  return nodes;
}

TEST(DriveHeat, StepsAreExactWhateverTheirLength)
{
  const ThermalParameters parameters = twoNodes();
  for (const double seconds : { 0.1, 60.0, 3000.0 })
  {
    DriveHeat heat = heatAtRest(parameters);
    heat.advance(seconds, { 12.0 * seconds, 4.0 * seconds }, AMBIENT);
    const Nodes expected = marched(parameters, { AMBIENT + 3.0, AMBIENT + 1.0 }, seconds, 12.0, 4.0);
    EXPECT_NEAR(heat.grease(), expected.grease, 1e-10) << seconds;
    EXPECT_NEAR(heat.housing(), expected.housing, 1e-10) << seconds;

    DriveHeat pieces = heatAtRest(parameters);
    for (int i = 0; i < 100; ++i)
    {
      pieces.advance(0.01 * seconds, { 0.12 * seconds, 0.04 * seconds }, AMBIENT);
    }
    EXPECT_NEAR(pieces.grease(), heat.grease(), 1e-10) << seconds;
    EXPECT_NEAR(pieces.housing(), heat.housing(), 1e-10) << seconds;
  }
}

TEST(DriveHeat, SettlesWhereHeatFlowsOffAsItArises)
{
  const ThermalParameters p = twoNodes();
  DriveHeat heat = heatAtRest(p);
  constexpr double DAY = 86400.0;
  heat.advance(DAY, { 12.0 * DAY, 4.0 * DAY }, AMBIENT);
  EXPECT_NEAR(heat.housing(), AMBIENT + (12.0 + 4.0 + p.standby_power) / p.ambient_conductance, 1e-9);
  EXPECT_NEAR(heat.grease(), heat.housing() + 12.0 / p.internal_conductance, 1e-9);
}

TEST(DriveHeat, InsulatedKeepsAllHeat)
{
  ThermalParameters p = twoNodes();
  p.ambient_conductance = 0.0;
  DriveHeat heat = heatAtRest(p);
  double booked = p.grease_capacity * p.grease_rise + p.housing_capacity * p.housing_rise;
  for (int i = 0; i < 1000; ++i)
  {
    const double friction = 0.7 + 0.6 * std::sin(0.1 * i);
    heat.advance(0.1, { friction, 0.2 }, AMBIENT);
    booked += friction + 0.2 + 0.1 * p.standby_power;
  }
  const double held = p.grease_capacity * (heat.grease() - AMBIENT) + p.housing_capacity * (heat.housing() - AMBIENT);
  EXPECT_NEAR(held, booked, 1e-9 * booked);
}

TEST(DriveHeat, GreaseAboveAMeasuredHousing)
{
  const ThermalParameters p = twoNodes();
  DriveHeat heat = heatAtRest(p);
  const double constant = p.grease_capacity / p.internal_conductance;
  heat.advanceGrease(constant, 12.0 * constant, 40.0);
  const double settled = 40.0 + 12.0 / p.internal_conductance;
  EXPECT_EQ(heat.housing(), 40.0);
  EXPECT_NEAR(heat.grease(), settled + std::exp(-1.0) * (AMBIENT + 3.0 - settled), 1e-12);
}

/// Runs the joint up, with reversals, load and brake.
Twin warmedTwin(const std::vector<std::string>& assignments, Stamp until)
{
  std::vector<std::string> all{ "thermal.model=two_nodes" };
  all.insert(all.end(), assignments.begin(), assignments.end());
  Twin twin(shippedParameters(all));
  for (Stamp at = 0; at < until; at += SECOND / 5)
  {
    const bool forward = at / (SECOND / 5) % 2 == 0;
    twin.commandMotorTorque(at, forward ? 0.6 : -0.5);
    twin.commandMotorTorque(at + SECOND / 10, forward ? 0.6 : -0.5);
    twin.commandLoadTorque(at, forward ? 20.0 : -15.0);
  }
  return twin;
}

TEST(TwinHeat, AllThatTheLedgerBooksWarmsTheNodes)
{
  Twin twin =
      warmedTwin({ "thermal.ambient_conductance=0.0", "input.temperature=20.0", "brake.holding_torque=0.0" }, SECOND);
  const Parameters& p = twin.parameters();
  double copper = 0.0;
  double dissipated = 0.0;
  while (twin.step(SECOND))
  {
    copper += p.motor.copper_loss * std::pow(twin.outputs().motor_torque, 2) / p.solver.rate;
    EXPECT_GE(twin.outputs().dissipated_energy, dissipated - 1e-9);
    dissipated = twin.outputs().dissipated_energy;
  }
  const double booked = dissipated + copper + p.thermal.standby_power;
  const double held = p.thermal.grease_capacity * (twin.outputs().temperature - AMBIENT) +
                      p.thermal.housing_capacity * (twin.outputs().housing_temperature - AMBIENT);
  EXPECT_GT(dissipated, 1.0);
  EXPECT_NEAR(held, booked, 1e-9 * booked);
}

TEST(TwinHeat, GivesTheSameBitsInOneGoAndInChunksAndAllocatesNothing)
{
  Twin one = warmedTwin({}, SECOND);
  Twin other = warmedTwin({}, SECOND);
  const std::size_t before = allocationCount();
  advance(one, SECOND);
  EXPECT_EQ(allocationCount(), before);
  for (Stamp until = 0; until <= SECOND; until += 7 * MILLISECOND)
  {
    advance(other, until);
  }
  advance(other, SECOND);
  EXPECT_EQ(numbers(one.outputs()), numbers(other.outputs()));
  EXPECT_EQ(one.outputs().temperature, other.outputs().temperature);
  EXPECT_GT(one.outputs().temperature, one.parameters().input.temperature);
}

TEST(TwinHeat, CoolsWhileTheJointRests)
{
  Twin twin(shippedParameters({ "thermal.model=two_nodes", "brake.engaged_at_start=true", "thermal.grease_rise=30.0",
                                "thermal.housing_rise=20.0" }));
  DriveHeat heat(twin.parameters().thermal);
  heat.reset(twin.parameters().input.temperature);
  heat.advance(2.0, {}, twin.parameters().input.temperature);
  EXPECT_EQ(twin.outputs().temperature, 55.0);
  advance(twin, 2 * SECOND);
  EXPECT_NEAR(twin.outputs().temperature, heat.grease(), 1e-6);
  EXPECT_NEAR(twin.outputs().housing_temperature, heat.housing(), 1e-6);
  twin.reset(0);
  EXPECT_EQ(twin.outputs().temperature, 55.0);
  EXPECT_EQ(twin.outputs().housing_temperature, 45.0);
  // A temperature that is received is that of the surroundings.
  Twin warmed(
      shippedParameters({ "thermal.model=two_nodes", "brake.engaged_at_start=true", "thermal.standby_power=0.0" }));
  warmed.setTemperature(0, 60.0);
  advance(warmed, SECOND);
  EXPECT_GT(warmed.outputs().housing_temperature, 25.01);
  EXPECT_LT(warmed.outputs().housing_temperature, 25.1);
}

TEST(TwinHeat, FrictionIsThatOfTheGrease)
{
  std::vector<double> friction;
  for (const char* const rise : { "thermal.grease_rise=0.0", "thermal.grease_rise=30.0" })
  {
    Twin twin(shippedParameters({ "thermal.model=two_nodes", rise, "thermal.grease_capacity=1.0e+6",
                                  "output.load_inertia=0.1", "motor.speed_limit=100.0" }));
    twin.commandMotorTorque(0, 0.3);
    for (Stamp at = 0; at <= SECOND / 2; at += SECOND / 20)
    {
      twin.commandMotorTorque(at, 0.3);
    }
    advance(twin, SECOND / 2);
    const JointOutputs& now = twin.outputs();
    EXPECT_NEAR(now.motor_velocity, 99.0, 1.1);
    const BearingFriction bearing(twin.parameters().bearing);
    friction.push_back(now.friction_torque - bearing.torque(now.motor_velocity, 0.0, now.temperature));
  }
  // What the bearing's law leaves hardly depends on the temperature.
  EXPECT_NEAR(friction[0], friction[1], 0.02 * friction[0]);
}

/// A joint that turns at 1 rad/s against 10 N.m of friction.
double settledGrease(GreaseTemperature& grease, double measured, double seconds)
{
  double temperature = 0.0;
  for (double time = 0.0; time < seconds; time += 0.5)
  {
    MotionSample sample;
    sample.time = time;
    sample.velocity = 1.0;
    sample.temperature = measured;
    temperature = grease.at(sample);
    grease.book(sample.velocity, -10.0, 0.2);
  }
  return temperature;
}

TEST(GreaseTemperature, WarmsUpByTheLossesOfTheMotion)
{
  constexpr double NONE = std::numeric_limits<double>::quiet_NaN();
  const Parameters parameters = shippedParameters({ "thermal.model=two_nodes" });
  const ThermalParameters& thermal = parameters.thermal;
  GreaseTemperature grease(parameters);
  const double warm = settledGrease(grease, NONE, 40000.0);
  const double copper = 0.04 * parameters.motor.copper_loss;
  const double housing = 25.0 + (10.0 + copper + thermal.standby_power) / thermal.ambient_conductance;
  EXPECT_NEAR(grease.housing(warm), housing, 1e-4);
  EXPECT_NEAR(warm, housing + 10.0 / thermal.internal_conductance, 1e-4);

  GreaseTemperature measured(parameters);
  EXPECT_NEAR(settledGrease(measured, 38.0, 4000.0), 38.0 + 10.0 / thermal.internal_conductance, 1e-6);

  GreaseTemperature without(shippedParameters());
  EXPECT_EQ(settledGrease(without, NONE, 10.0), 25.0);
  EXPECT_EQ(settledGrease(without, 38.0, 10.0), 38.0);
}

/// Temperature that the twin beside a joint predicts at, after `seconds` of turning at 1 rad/s.
double trackedTemperature(const std::vector<std::string>& assignments, InputMode mode, double seconds)
{
  Tracker tracker(shippedParameters(assignments), mode);
  double temperature = 0.0;
  for (int i = 0; 0.01 * i <= seconds; ++i)
  {
    MotionRow row;
    row.time = 0.01 * i;
    row.received = row.time;
    row.position = 1.0 * row.time;
    row.current = 1.2;
    tracker.push(row);
    while (const std::optional<Comparison> now = tracker.pop())
    {
      EXPECT_FALSE(now->temperature_received);
      temperature = now->temperature;
    }
  }
  return temperature;
}

TEST(GreaseTemperature, WarmsTheTwinBesideARobot)
{
  for (const InputMode mode : { InputMode::MOTION, InputMode::OBSERVER, InputMode::TORQUE })
  {
    EXPECT_EQ(trackedTemperature({}, mode, 2.0), 25.0);
    const double warm = trackedTemperature({ "thermal.model=two_nodes", "thermal.grease_capacity=20.0" }, mode, 4.0);
    EXPECT_GT(warm, 26.0);
    EXPECT_LT(warm, 35.0);
  }
}

TEST(GreaseTemperature, StandsOverAGap)
{
  const Parameters parameters = shippedParameters({ "thermal.model=two_nodes", "thermal.standby_power=0.0" });
  GreaseTemperature grease(parameters);
  const double before = settledGrease(grease, std::numeric_limits<double>::quiet_NaN(), 1000.0);
  MotionSample sample;
  sample.time = 1000.0 + 86400.0;
  sample.after_gap = true;
  const double after = grease.at(sample);
  EXPECT_GT(before, 26.0);
  EXPECT_NEAR(after, 25.0, 1e-6);
}
}  // namespace
}  // namespace hjt
