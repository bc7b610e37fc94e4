// SPDX-License-Identifier: BSD-3-Clause
// The observer beside the twin as a robot: both encoders with noise, torque known, and what the residual says.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <gmock/gmock.h>

#include "test_parameters.hpp"

#include "harmonic_joint_twin/gear/angle.hpp"
#include "harmonic_joint_twin/gear/ratio.hpp"
#include "harmonic_joint_twin/twin/observer.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"

namespace hjt
{
namespace
{
constexpr double PERIOD = 0.002;  // [s]
const ObserverNoise NOISE{ 4e-4, 4e-6, 0.05, 0.05 };

using Torque = std::function<double(double time, const JointOutputs& now)>;

/// The observer of `believed` beside a robot of `real`.
std::vector<Observation> observe(const Parameters& real, const Parameters& believed, double duration,
                                 const Torque& motor_torque)
{
  std::mt19937 engine(5);
  std::normal_distribution<double> unit;
  Twin robot(real);
  robot.reset(0);
  Observer observer(believed, NOISE, PERIOD);
  observer.reset(robot.outputs().motor_angle, robot.outputs().output_angle);
  std::vector<Observation> seen;
  const int steps = static_cast<int>(std::lround(PERIOD * 1e9 / static_cast<double>(robot.stepLength())));
  while (static_cast<double>(robot.stamp()) < 1e9 * duration)
  {
    double mean = 0.0;
    for (int i = 0; i < steps; ++i)
    {
      robot.commandMotorTorque(robot.stamp(), motor_torque(static_cast<double>(robot.stamp()) / 1e9, robot.outputs()));
      EXPECT_TRUE(robot.step(robot.stamp() + robot.stepLength()));
      mean += robot.outputs().motor_torque / steps;
    }
    seen.push_back(observer.step(mean, 0.0, robot.outputs().motor_angle + NOISE.motor_angle * unit(engine),
                                 robot.outputs().output_angle + NOISE.output_angle * unit(engine)));
  }
  return seen;
}

/// Leads the motor to and fro.
double servo(double time, const JointOutputs& now)
{
  const double target = 40.0 * (1.0 - std::cos(TWO_PI * 0.4 * time));
  const double speed = 40.0 * TWO_PI * 0.4 * std::sin(TWO_PI * 0.4 * time);
  return 0.3 * (target - now.motor_angle) + 0.02 * (speed - now.motor_velocity);
}

double meanSize(const std::vector<Observation>& seen, double from)
{
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = static_cast<std::size_t>(from / PERIOD); i < seen.size(); ++i)
  {
    if (!seen[i].sticking)
    {
      sum += std::abs(seen[i].residual_torque);
      ++count;
    }
  }
  EXPECT_GT(count, 100.0);
  return sum / count;
}

const std::vector<std::string> JOINT{ "motor.viscous_friction=0.0", "output.load_inertia=1.5", "solver.rate=5000" };

TEST(Observer, IsStableForEveryStiffness)
{
  for (const double output_inertia : { 3e-4, 0.02, 0.5, 3.3, 30.0 })
  {
    for (const double period : { 1e-3, 2e-3, 8e-3 })
    {
      for (double stiffness = 31.0; stiffness < 1e7; stiffness *= 1.7)
      {
        const ObserverDesign design = designObserver({ 1.69e-4, output_inertia }, 101.0, stiffness, period, NOISE);
        ASSERT_TRUE(design.gain.allFinite()) << stiffness << " N.m/rad, " << output_inertia << " kg.m^2, " << period;
        ASSERT_LT(design.spectral_radius, 1.0) << stiffness << " N.m/rad, " << output_inertia << " kg.m^2, " << period;
      }
    }
  }
}

TEST(Observer, OfAHealthyJointStaysWithinItsBandAndFollows)
{
  const Parameters joint = shippedParameters(JOINT);
  const std::vector<Observation> seen = observe(joint, joint, 5.0, servo);
  std::size_t inside = 0;
  std::size_t moving = 0;
  for (std::size_t i = 500; i < seen.size(); ++i)
  {
    if (!seen[i].sticking)
    {
      ++moving;
      inside += std::abs(seen[i].residual_torque) < seen[i].residual_band ? 1 : 0;
    }
  }
  ASSERT_GT(moving, 1000u);
  EXPECT_GT(static_cast<double>(inside), 0.95 * static_cast<double>(moving));
}

TEST(Observer, ShowsFrictionThatHasGrownAndDoesNotLearnItAway)
{
  const Parameters healthy = shippedParameters(JOINT);
  std::vector<std::string> worn = JOINT;
  worn.emplace_back("motor.coulomb_torque=0.085");  // 0.08 N.m more
  const std::vector<Observation> seen = observe(shippedParameters(worn), healthy, 5.0, servo);
  const double found = meanSize(seen, 1.0);
  EXPECT_NEAR(found, 0.08, 0.02);
  EXPECT_GT(found, 1.5 * seen.back().residual_band);
  // As large in the last second as in the first.
  EXPECT_NEAR(meanSize(seen, 4.0), found, 0.01);
}

TEST(Observer, DoesNotWindUpWhileFrictionHoldsTheMotor)
{
  const Parameters joint = shippedParameters(JOINT);
  // Half of what starts the joint, first to one side, then to the other.
  const std::vector<Observation> seen =
      observe(joint, joint, 4.0, [](double time, const JointOutputs&) { return time < 2.0 ? 0.03 : -0.03; });
  double before = 0.0;
  double last = 0.0;
  for (std::size_t i = 0; i < seen.size(); ++i)
  {
    // Three deviations are passed now and then; torque that is taken for a disturbance would be far beyond.
    ASSERT_LT(std::abs(seen[i].residual_torque), 2.0 * seen[i].residual_band)
        << PERIOD * static_cast<double>(i) << " s";
    const double time = PERIOD * static_cast<double>(i);
    before += time > 1.0 && time < 2.0 ? PERIOD * seen[i].residual_torque : 0.0;
    last += time > 3.0 ? PERIOD * seen[i].residual_torque : 0.0;
  }
  EXPECT_LT(std::abs(before), 0.02);
  EXPECT_LT(std::abs(last), 0.02);
}
}  // namespace
}  // namespace hjt
