// SPDX-License-Identifier: BSD-3-Clause
// The twin driven by a measured motion, and what is identified from one. The robot measured is the twin itself, driven
// by a servo, with parameters that the identification does not know and with the noise of real sensors.

#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "identification/controller_fit.hpp"
#include "identification/identification.hpp"
#include "model/joint_model.hpp"
#include "test/core/complaint.hpp"
#include "test/core/test_parameters.hpp"
#include "test/support/seeded_random.hpp"
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
  SeededRandom engine(7);
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
      row.row.position = twin.outputs().motor_angle / ratio + noise.position * engine.normal();
      row.motor_torque = twin.outputs().motor_torque;
      row.row.current =
          ratio * row.motor_torque / parameters.telemetry.torque_per_current + noise.current * engine.normal();
      rows.push_back(row);
    }
  }
  return rows;
}

std::vector<MotionSample> smoothed(const std::vector<RobotRow>& rows, const MotionDriven& twin)
{
  MotionDifferentiator smoother(0.05);  // the output's swing, which the motor does not share, is less in it
  std::vector<MotionSample> samples;
  const auto take = [&](bool at_end)
  {
    while (auto sample = smoother.pop(at_end))
    {
      sample->load = twin.modelledLoad(*sample);
      samples.push_back(*sample);
    }
  };
  for (const RobotRow& row : rows)
  {
    smoother.push(row.row);
    take(false);
  }
  take(true);
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
  const auto at = std::find_if(found.values.begin(), found.values.end(),
                               [&](const IdentifiedValue& value) { return value.key == key || value.name == key; });
  EXPECT_NE(at, found.values.end()) << key << " was not looked for";
  return at == found.values.end() ? found.values.front() : *at;
}

/// By the first two thirds or so of the samples, judged by the rest.
Identification identifiedBy(const Parameters& known, const std::vector<MotionSample>& samples, std::ptrdiff_t first,
                            bool with_ripple = false)
{
  const auto middle = samples.begin() + first;
  return identify(known, { samples.begin(), middle }, { { middle, samples.end() } }, with_ripple);
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
  const Identification found = identifiedBy(known, samples, static_cast<std::ptrdiff_t>(samples.size() * 2 / 3));
  const IdentifiedValue& rise = valueOf(found, "Stribeck rise at the motor");
  EXPECT_EQ(rise.refusal, "");
  EXPECT_NEAR(rise.value, robot.motor.stribeck_torque, std::max(rise.half_width, 0.25 * robot.motor.stribeck_torque));
  EXPECT_EQ(found.parameters.motor.stribeck_torque, 0.0);
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
  const Identification found =
      identifiedBy(knownParameters(), samples, static_cast<std::ptrdiff_t>(samples.size() * 2 / 3));

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
  SeededRandom engine(3);
  std::vector<MotionSample> samples;
  for (int i = 0; i < 2000; ++i)
  {
    MotionSample sample;
    sample.time = 0.008 * i;
    sample.velocity = i < 1000 ? 0.5 : -0.5;
    sample.position = i < 1000 ? 0.004 * i : 0.004 * (2000 - i);
    sample.current = twin.step(sample).current + 0.01 * engine.normal();
    samples.push_back(sample);
  }
  const Identification found = identify(parameters, samples, { samples }, false);
  EXPECT_NE(valueOf(found, "telemetry.torque_per_current").refusal, "");
  EXPECT_NE(valueOf(found, "motor.rotor_inertia").refusal, "");
  EXPECT_EQ(found.parameters.telemetry.torque_per_current, parameters.telemetry.torque_per_current);
  for (MotionSample& sample : samples)
  {
    sample.velocity = sample.position = 0.0;
  }
  EXPECT_THROW(identify(parameters, samples, { samples }, false), InputError) << "at rest nothing is told";
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
  SeededRandom engine(5);
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
    sample.current = twin.step(sample).current + 0.02 * engine.normal();
    samples.push_back(sample);
  }
  const Identification found = identifiedBy(shippedParameters(), samples, 3000, true);
  const RippleLine& line = found.lines[0];
  ASSERT_EQ(line.refusal, "");
  EXPECT_NEAR(line.amplitude, std::hypot(0.9, 0.7), 2.0 * line.half_width);
  EXPECT_NEAR(found.parameters.telemetry.ripple_resonance, 22.0, 2.0);
  EXPECT_NE(found.lines[1].refusal, "");
  EXPECT_EQ(found.parameters.telemetry.ripple_flexspline_2[0], 0.0);
  EXPECT_LT(found.judged.identified.moving, 0.5 * found.judged.without_ripple.moving);
}

TEST(MotionDifferentiator, KeepsToAParabolaThroughJitterRepeatsAndDropOuts)
{
  MotionDifferentiator smoother;
  SeededRandom engine(11);
  std::vector<MotionSample> samples;
  const auto collect = [&](bool at_end)
  {
    while (const auto sample = smoother.pop(at_end))
    {
      samples.push_back(*sample);
    }
  };
  const auto angle = [](double time) { return 0.3 + 0.7 * time - 0.9 * time * time; };
  for (int i = 0; i < 500; ++i)
  {
    if (engine() % 100 == 0)
    {
      continue;  // dropped
    }
    const double time = 0.008 * i + 0.003 * static_cast<double>(engine() % 1000) / 1000.0 + (i >= 250 ? 1.0 : 0.0);
    EXPECT_TRUE(smoother.push({ time, angle(time), 0.0, 0.0 }));
    EXPECT_FALSE(smoother.push({ time, 1.0, 0.0, 0.0 }));  // its stamp repeated
    collect(false);
  }
  constexpr double NONE = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(smoother.push({ NONE, 0.0, 0.0, 0.0 }));
  EXPECT_FALSE(smoother.push({ 1e3, NONE, 0.0, 0.0 }));
  EXPECT_FALSE(smoother.push({ 1e3, 0.0, NONE, 0.0 }));
  EXPECT_FALSE(smoother.push({ 1e3, 0.0, 0.0, NONE }));
  collect(true);
  EXPECT_EQ(smoother.gaps(), 1u);
  EXPECT_GT(samples.size(), 480u);
  int cuts = 0;
  for (const MotionSample& sample : samples)
  {
    cuts += sample.after_gap ? 1 : 0;
    EXPECT_NEAR(sample.velocity, 0.7 - 1.8 * sample.time, 1e-6);
    EXPECT_NEAR(sample.acceleration, -1.8, 1e-4);
  }
  EXPECT_EQ(cuts, 1);
}

TEST(MotionDifferentiator, TakesTwoRowsToEitherSideHoweverFarApart)
{
  MotionDifferentiator smoother;
  int samples = 0;
  for (int i = 0; i < 50; ++i)
  {
    const double time = 0.09 * i;
    smoother.push({ time, 0.3 + 0.7 * time - 0.9 * time * time, 0.0, 0.0 });
    while (const auto sample = smoother.pop())
    {
      if (samples > 0)  // the first has too few
      {
        EXPECT_NEAR(sample->velocity, 0.7 - 1.8 * sample->time, 1e-6);
        EXPECT_NEAR(sample->acceleration, -1.8, 1e-6);
      }
      ++samples;
    }
  }
  EXPECT_EQ(samples, 48);
}

constexpr double PERIOD = 0.002;           // [s]
constexpr double TORQUE_PER_CURRENT = 10;  // [N.m/A]
constexpr double ANGLE_CURRENT = 2000.0;   // [A/rad]
constexpr double SPEED_CURRENT = 20.0;     // [A.s/rad]
constexpr JointGains USUAL{ 40.0, 100.0, 0.05, 0.0, 0.0 };

/// A joint that swings; its errors are noise, and so is `unexplained`, a share of the current's variance.
std::vector<ControllerRow> recorded(double unexplained)
{
  SeededRandom random(64);
  constexpr double ANGLE_ERROR = 1e-4;  // [rad]
  constexpr double SPEED_ERROR = 0.01;  // [rad/s]
  const double of_errors = std::hypot(ANGLE_CURRENT * ANGLE_ERROR, SPEED_CURRENT * SPEED_ERROR);
  std::vector<ControllerRow> rows(10000);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    ControllerRow& row = rows[i];
    const double time = PERIOD * static_cast<double>(i);
    row.angle_error = ANGLE_ERROR * random.normal();
    row.speed_error = SPEED_ERROR * random.normal();
    row.speed = std::sin(time);
    row.rigid_current = 0.5 * std::cos(time);
    row.target_current = row.rigid_current + 0.3 * std::tanh(row.speed / 0.01) + 0.2 * row.speed;
    row.current = row.rigid_current + of_errors * std::sqrt(unexplained / (1.0 - unexplained)) * random.normal();
    if (i >= 2)
    {
      row.current += ANGLE_CURRENT * rows[i - 2].angle_error + SPEED_CURRENT * rows[i - 2].speed_error;
    }
  }
  return rows;
}

ControllerFit fitted(double unexplained)
{
  return fitController(recorded(unexplained), PERIOD, TORQUE_PER_CURRENT, USUAL, 0.0);
}

TEST(ControllerFit, FindsGainsLagAndFrictionThatIsFedForward)
{
  const ControllerFit found = fitted(0.05);
  EXPECT_EQ(found.refusal, "");
  EXPECT_NEAR(found.lag, 2.0 * PERIOD, 1e-9);
  EXPECT_NEAR(found.angle_current, ANGLE_CURRENT, found.angle_half_width);
  EXPECT_NEAR(found.speed_current, SPEED_CURRENT, found.speed_half_width);
  EXPECT_LT(found.angle_half_width, 0.02 * ANGLE_CURRENT);
  EXPECT_LT(found.speed_half_width, 0.02 * SPEED_CURRENT);
  // a / b = k_p + 1 / T_i, of which the integral's time is the usual one's.
  EXPECT_NEAR(found.gains.position, found.angle_current / found.speed_current - 1.0 / USUAL.integral_time, 1e-9);
  EXPECT_NEAR(found.gains.speed, TORQUE_PER_CURRENT * found.speed_current, 1e-9);
  EXPECT_NEAR(found.gains.integral_time, USUAL.integral_time, 1e-12);
  EXPECT_NEAR(found.gains.coulomb, 3.0, 1e-6);
  EXPECT_NEAR(found.gains.viscous, 2.0, 1e-6);
}

TEST(ControllerFit, RefusesWhereTheErrorsExplainLessThanAThird)
{
  const ControllerFit half = fitted(0.5);
  EXPECT_EQ(half.refusal, "");
  EXPECT_NEAR(half.explained, 0.5, 0.02);
  const ControllerFit quarter = fitted(0.75);
  EXPECT_THAT(quarter.refusal, testing::HasSubstr("explain less than a third"));
  EXPECT_EQ(quarter.gains.speed, USUAL.speed);
}
}  // namespace
}  // namespace hjt
