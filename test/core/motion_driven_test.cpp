// SPDX-License-Identifier: BSD-3-Clause
// The twin driven by a measured motion, and what is identified from one. The robot measured is the twin itself, driven
// by a servo, with parameters that the identification does not know and with the noise of real sensors.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gmock/gmock.h>

#include "test/core/complaint.hpp"
#include "test_parameters.hpp"

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "identification/identification.hpp"
#include "model/joint_model.hpp"
#include "tracking/friction_map.hpp"
#include "tracking/motion_driven.hpp"

namespace hjt
{
namespace
{
constexpr double TELEMETRY_PERIOD = 0.008;  // [s]

struct SensorNoise
{
  double position{};  // at the joint, rms [rad]
  double current{};   // rms [A]
};

struct RobotRow
{
  MotionRow row;
  double motor_torque{};  // true [N.m]
};

/// The twin as a robot: a servo leads the motor through two sines, telemetry at 125 Hz.
std::vector<RobotRow> runRobot(const Parameters& parameters, double duration, const SensorNoise& noise)
{
  std::mt19937 engine(7);
  std::normal_distribution<double> unit;
  const double ratio = nominalRatio(parameters.gear);
  Twin twin(parameters);
  twin.reset(0);
  std::vector<RobotRow> rows;
  double next = 0.0;
  for (double time = 0.0; time < duration; time = static_cast<double>(twin.stamp()) / 1e9)
  {
    const JointOutputs& now = twin.outputs();
    // Begins at rest.
    const double target =
        ratio * (0.8 * (1.0 - std::cos(TWO_PI * 0.17 * time)) + 0.1 * (1.0 - std::cos(TWO_PI * 0.6 * time)));
    const double target_speed =
        ratio * TWO_PI * (0.136 * std::sin(TWO_PI * 0.17 * time) + 0.06 * std::sin(TWO_PI * 0.6 * time));
    const double torque = 0.5 * (target - now.motor_angle) + 0.02 * (target_speed - now.motor_velocity);
    twin.commandMotorTorque(twin.stamp(), torque);
    if (!twin.step(twin.stamp() + twin.stepLength()))
    {
      ADD_FAILURE() << "the twin does not step";
      break;
    }
    if (time >= next)
    {
      next += TELEMETRY_PERIOD;
      RobotRow row;
      row.row.time = static_cast<double>(twin.stamp()) / 1e9;
      row.row.position = twin.outputs().motor_angle / ratio + noise.position * unit(engine);
      row.motor_torque = twin.outputs().motor_torque;
      row.row.current =
          ratio * row.motor_torque / parameters.telemetry.torque_per_current + noise.current * unit(engine);
      rows.push_back(row);
    }
  }
  return rows;
}

std::vector<MotionSample> smoothed(const std::vector<RobotRow>& rows, const MotionDriven& twin)
{
  MotionDifferentiator smoother(0.05);  // the output's swing, which the motor does not share, is less in it
  std::vector<MotionSample> samples;
  for (const RobotRow& row : rows)
  {
    smoother.push(row.row);
    while (auto sample = smoother.pop())
    {
      sample->load = twin.modelledLoad(*sample);
      samples.push_back(*sample);
    }
  }
  while (auto sample = smoother.pop(true))
  {
    sample->load = twin.modelledLoad(*sample);
    samples.push_back(*sample);
  }
  return samples;
}

std::vector<std::string> hiddenParameters()
{
  return { "bearing.race_preload=750.0",        "bearing.viscosity=220.0e-6", "motor.rotor_inertia=1.2e-4",
           "telemetry.torque_per_current=9.84", "motor.viscous_friction=0.0", "output.gravity_torque=40.0",
           "output.load_inertia=1.5",           "solver.rate=5000",           "indicators.sample_rate=1000" };
}

Parameters knownParameters()
{
  return shippedParameters({ "motor.viscous_friction=0.0", "output.gravity_torque=40.0", "output.load_inertia=1.5" });
}

const IdentifiedValue& valueOf(const Identification& found, const std::string& key)
{
  for (const IdentifiedValue& value : found.values)
  {
    if (value.key == key)
    {
      return value;
    }
  }
  ADD_FAILURE() << key << " was not looked for";
  return found.values.front();
}

TEST(FrictionMap, OfAJointWithoutMotorReachesToTheLoadsOnIt)
{
  const FrictionMap without(shippedParameters({ "motor.torque_limit=0.0" }));
  const FrictionMap with(shippedParameters());
  for (const double speed : { 0.5, 80.0 })
  {
    for (const double load : { 0.0, 3.0, 60.0, -200.0 })
    {
      const double expected = with.at(speed, load, 25.0).sum();
      EXPECT_NEAR(without.at(speed, load, 25.0).sum(), expected, 0.01 * expected) << speed << " " << load;
    }
  }
  const auto neither = [] {
    FrictionMap(shippedParameters({ "motor.torque_limit=0.0", "output.load_torque_limit=0.0" }));
  };
  EXPECT_THAT(complaintOf(neither), testing::HasSubstr("motor.torque_limit and output.load_torque_limit are both 0"));
}

TEST(MotionDriven, TakesTheTorqueThatMadeTheMotion)
{
  std::vector<std::string> assignments = hiddenParameters();
  assignments.emplace_back("telemetry.presliding_angle=1.0e-4");  // the twin's own stiction has no presliding
  const Parameters parameters = shippedParameters(assignments);
  const std::vector<RobotRow> rows = runRobot(parameters, 6.0, {});
  MotionDriven twin(parameters);
  const std::vector<MotionSample> samples = smoothed(rows, twin);
  ASSERT_EQ(samples.size(), rows.size());
  double error = 0.0;
  double signal = 0.0;
  int counted = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    const double predicted = twin.step(samples[i]).motor_torque;
    if (samples[i].time > 0.5)  // the servo's first jolt is faster than telemetry shows
    {
      error += std::pow(predicted - rows[i].motor_torque, 2);
      signal += std::pow(rows[i].motor_torque, 2);
      ++counted;
    }
  }
  ASSERT_GT(counted, 500);
  // Left: what torsion and swing of the output add, which the motion of the motor alone does not tell.
  EXPECT_LT(std::sqrt(error / signal), 0.04);
}

/// What the current gives and friction leaves is the momentum.
TEST(TorqueDriven, TakesTheTorqueOfTheCurrentLessItsOffset)
{
  const Parameters parameters = shippedParameters({ "telemetry.torque_per_current=10.0", "telemetry.current_offset=0.4",
                                                    "output.gravity_torque=0.0", "output.load_inertia=0.0" });
  const double ratio = nominalRatio(parameters.gear);
  const Eigen::Vector2d inertia = JointModel(parameters).inertia();
  constexpr double STEP = 1e-3;
  for (const double torque : { 60.0, -60.0 })
  {
    TorqueDriven twin(parameters);
    MotionSample sample;
    sample.current = 0.4 + torque / 10.0;
    double momentum = 0.0;
    TorqueDriven::Motion motion = twin.step(sample, 0.0);
    for (int i = 1; i <= 100; ++i)
    {
      sample.time = STEP * i;
      motion = twin.step(sample, 0.0);
      momentum += (torque - motion.friction_torque) * STEP;
    }
    EXPECT_NEAR(motion.velocity * (ratio * ratio * inertia[0] + inertia[1]), momentum, 0.02 * std::abs(momentum));
  }
}

TEST(Identification, ReportsTheStribeckRiseAndDoesNotTakeIt)
{
  std::vector<std::string> hidden = hiddenParameters();
  hidden.emplace_back("motor.stribeck_torque=0.04");
  hidden.emplace_back("motor.stribeck_velocity=20.0");
  const Parameters robot = shippedParameters(hidden);
  Parameters known = knownParameters();
  known.motor.stribeck_velocity = robot.motor.stribeck_velocity;
  const std::vector<MotionSample> samples = smoothed(runRobot(robot, 18.0, { 3e-6, 0.02 }), MotionDriven(known));
  const auto middle = samples.begin() + static_cast<std::ptrdiff_t>(samples.size() * 2 / 3);
  const Identification found = identify(known, { samples.begin(), middle }, { { middle, samples.end() } }, false);
  const auto at = std::find_if(found.values.begin(), found.values.end(),
                               [](const IdentifiedValue& value) { return value.name == "Stribeck rise at the motor"; });
  ASSERT_NE(at, found.values.end());
  const IdentifiedValue& rise = *at;
  EXPECT_EQ(rise.refusal, "");
  EXPECT_NEAR(rise.value, robot.motor.stribeck_torque, std::max(rise.half_width, 0.25 * robot.motor.stribeck_torque));
  EXPECT_EQ(found.parameters.motor.stribeck_torque, 0.0);
  RecordProperty("rise", std::to_string(rise.value));
  // Where it is configured the prediction has it.
  Parameters with = found.parameters;
  with.motor.stribeck_torque = 0.04;
  EXPECT_GT(MotionDriven(with).frictionAt(0.02, 0.0, 25.0),
            MotionDriven(found.parameters).frictionAt(0.02, 0.0, 25.0) + 2.0);
}

TEST(Identification, FindsHiddenParametersWithinTheirIntervals)
{
  const Parameters robot = shippedParameters(hiddenParameters());
  const std::vector<RobotRow> rows = runRobot(robot, 18.0, { 3e-6, 0.02 });
  const std::vector<MotionSample> samples = smoothed(rows, MotionDriven(knownParameters()));
  const auto middle = samples.begin() + static_cast<std::ptrdiff_t>(samples.size() * 2 / 3);
  const Identification found =
      identify(knownParameters(), { samples.begin(), middle }, { { middle, samples.end() } }, false);

  const auto expect_within = [&](const char* key, double truth)
  {
    const IdentifiedValue& value = valueOf(found, key);
    ASSERT_EQ(value.refusal, "") << key;
    EXPECT_NEAR(value.value, truth, value.half_width) << key;
    EXPECT_LT(value.half_width, 0.5 * truth) << key;
  };
  expect_within("telemetry.torque_per_current", robot.telemetry.torque_per_current);
  expect_within("bearing.race_preload", robot.bearing.race_preload);
  expect_within("bearing.viscosity", robot.bearing.viscosity);
  expect_within("motor.rotor_inertia", robot.motor.rotor_inertia);
  EXPECT_NE(valueOf(found, "bearing.viscosity_slope").refusal, "");
  EXPECT_NE(valueOf(found, "cup.torsion_stiffness").refusal, "");
  EXPECT_LT(found.judged.identified.moving, 0.3 * found.judged.configured.moving);
  EXPECT_LT(found.judged.identified.moving, found.judged.gain_coulomb_viscous.moving);
}

TEST(Identification, RefusesTheGainWhereNoLoadTellsIt)
{
  // A joint at constant speed, turning on without load: current and friction scale alike.
  const Parameters parameters = shippedParameters();
  MotionDriven twin(parameters);
  std::mt19937 engine(3);
  std::normal_distribution<double> unit;
  std::vector<MotionSample> samples;
  for (int i = 0; i < 2000; ++i)
  {
    MotionSample sample;
    sample.time = 0.008 * i;
    sample.velocity = i < 1000 ? 0.5 : -0.5;
    sample.position = i < 1000 ? 0.004 * i : 0.004 * (2000 - i);
    sample.current = twin.step(sample).current + 0.01 * unit(engine);
    samples.push_back(sample);
  }
  const Identification found = identify(parameters, samples, { samples }, false);
  EXPECT_NE(valueOf(found, "telemetry.torque_per_current").refusal, "");
  EXPECT_NE(valueOf(found, "motor.rotor_inertia").refusal, "");
  EXPECT_EQ(found.parameters.telemetry.torque_per_current, parameters.telemetry.torque_per_current);
}

TEST(Identification, SaysThatAJointAtRestTellsNothing)
{
  std::vector<MotionSample> samples(500);
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    samples[i].time = 0.008 * static_cast<double>(i);
  }
  EXPECT_THROW(identify(shippedParameters(), samples, { samples }, false), InputError);
}

TEST(Presliding, BuildsUpAfterAReversalAndFadesAtRest)
{
  TelemetryParameters parameters;
  parameters.presliding_angle = 1e-3;
  Presliding presliding(parameters);
  EXPECT_EQ(presliding.share(), 0.0);
  for (int i = 0; i < 100; ++i)
  {
    presliding.move(1e-4, 0.0);
  }
  EXPECT_NEAR(presliding.share(), 1.0, 1e-4);
  const double built_up = presliding.share();
  presliding.move(0.0, 0.0);
  EXPECT_EQ(presliding.share(), built_up);
  presliding.move(-1e-3, 0.0);
  const double share = 2.0 * std::exp(-1.0) - 1.0;
  EXPECT_NEAR(presliding.share(), share, 1e-4);
  presliding.move(0.0, Presliding::RELAXATION);
  EXPECT_NEAR(presliding.share(), share * std::exp(-1.0), 1e-4);
}

TEST(Presliding, ItsLastingShareStaysAtRestAndThroughSmallMotion)
{
  TelemetryParameters parameters;
  parameters.presliding_angle = 1e-3;
  parameters.lasting_share = 0.4;
  Presliding presliding(parameters);
  presliding.move(10.0 * Presliding::LASTING_ANGLE, 0.0);
  EXPECT_NEAR(presliding.share(), 1.0, 1e-4);
  presliding.move(-5e-3, 0.0);
  presliding.move(0.0, 20.0 * Presliding::RELAXATION);
  EXPECT_NEAR(presliding.share(), 0.4, 0.02);
}

TEST(TorqueRipple, IsTheErrorTimesStiffnessFarAboveTheResonanceAndNothingAtRest)
{
  TelemetryParameters parameters;
  parameters.ripple_circular_spline_2 = { 1.2, -0.5 };
  parameters.ripple_resonance = 1.0;
  parameters.ripple_damping = 0.1;
  parameters.ripple_fastest = 200.0;
  constexpr double RATIO = 101.0;
  const TorqueRipple ripple(parameters, RATIO);
  EXPECT_EQ(ripple.at(0.3, 0.0), 0.0);
  for (const double angle : { 0.0, 0.004, 0.3 })
  {
    const double wave = 2.0 * (RATIO - 1.0) * angle;
    EXPECT_NEAR(ripple.at(angle, 100.0), 1.2 * std::cos(wave) - 0.5 * std::sin(wave), 1e-3);
  }
  // At the resonance the quality of the resonator times that, a quarter of a wave later.
  parameters.ripple_circular_spline_2 = { 1.0, 0.0 };
  parameters.ripple_resonance = 2.0 * (RATIO - 1.0) * 0.5 / TWO_PI;
  EXPECT_NEAR(TorqueRipple(parameters, RATIO).at(0.0, 0.5), 0.0, 1e-9);
  EXPECT_NEAR(TorqueRipple(parameters, RATIO).at(0.25 * TWO_PI / 200.0, 0.5), -5.0, 1e-9);
  // Beyond the speed up to which it is known there is none.
  parameters.ripple_fastest = 0.4;
  EXPECT_EQ(TorqueRipple(parameters, RATIO).at(0.25 * TWO_PI / 200.0, 0.5), 0.0);
}

TEST(Identification, FindsTheRippleOfACircularSplineAndNoneOfTheFlexspline)
{
  Parameters robot = shippedParameters();
  robot.telemetry.ripple_circular_spline_2 = { 0.9, -0.7 };
  robot.telemetry.ripple_resonance = 22.0;
  robot.telemetry.ripple_damping = 0.2;
  robot.telemetry.ripple_lag = 0.004;
  MotionDriven twin(robot);
  std::mt19937 engine(5);
  std::normal_distribution<double> unit;
  std::vector<MotionSample> samples;
  for (int i = 0; i < 5000; ++i)
  {
    MotionSample sample;
    const double phase = 0.6 * 0.008 * i;
    sample.time = 0.008 * i;
    sample.position = 1.2 * std::sin(phase);
    sample.velocity = 1.2 * 0.6 * std::cos(phase);
    sample.acceleration = -1.2 * 0.36 * std::sin(phase);
    sample.load = 30.0 * std::sin(sample.position) + 2.0 * sample.acceleration;
    sample.current = twin.step(sample).current + 0.02 * unit(engine);
    samples.push_back(sample);
  }
  const auto middle = samples.begin() + 3000;
  const Identification found =
      identify(shippedParameters(), { samples.begin(), middle }, { { middle, samples.end() } }, true);
  const RippleLine& line = found.lines[0];
  ASSERT_EQ(line.refusal, "");
  EXPECT_NEAR(line.amplitude, std::hypot(0.9, 0.7), 2.0 * line.half_width);
  EXPECT_NEAR(found.parameters.telemetry.ripple_resonance, 22.0, 2.0);
  EXPECT_NE(found.lines[1].refusal, "");
  EXPECT_EQ(found.parameters.telemetry.ripple_flexspline_2[0], 0.0);
  EXPECT_LT(found.judged.identified.moving, 0.5 * found.judged.without_ripple.moving);
}
}  // namespace
}  // namespace hjt
