// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <functional>
#include <random>

#include <boost/numeric/odeint/integrate/integrate_n_steps.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <gtest/gtest.h>

#include "harmonic_joint_twin/gear/angle.hpp"
#include "harmonic_joint_twin/params/parameter_error.hpp"
#include "harmonic_joint_twin/solver/joint_stepper.hpp"
#include "test_parameters.hpp"

namespace hjt
{
namespace
{
using namespace joint_state;
using RungeKutta4 = boost::numeric::odeint::runge_kutta4<JointState, double, JointState, double,
                                                         boost::numeric::odeint::vector_space_algebra>;

/// Torques as a rough user gives them: every few hundredths of a second another motor torque within the limit, another
/// load, and now and then the brake.
class RandomInputs
{
public:
  RandomInputs(unsigned seed, const Parameters& parameters, bool brake)
    : random_(seed), trace_(__FILE__, __LINE__, "seed " + std::to_string(seed)), parameters_(parameters), brake_(brake)
  {
    inputs_.temperature = parameters.input.temperature;
  }

  JointInputs next(const Motor& motor, double motor_speed)
  {
    if (left_-- == 0)
    {
      left_ = static_cast<int>(parameters_.solver.rate * (0.01 + 0.04 * chance_(random_)));
      command_ = parameters_.motor.torque_limit * (2.0 * chance_(random_) - 1.0);
      inputs_.load_torque = chance_(random_) < 0.5 ? 150.0 * (2.0 * chance_(random_) - 1.0) : inputs_.load_torque;
      inputs_.brake_engaged = brake_ && chance_(random_) < 0.2;
    }
    inputs_.motor_torque = motor.drive(command_, motor_speed).torque;
    return inputs_;
  }

private:
  std::mt19937 random_;
  testing::ScopedTrace trace_;
  Parameters parameters_;
  bool brake_;
  std::uniform_real_distribution<double> chance_{ 0.0, 1.0 };
  int left_{};
  double command_{};
  JointInputs inputs_;
};

struct RandomRun
{
  double residual{};    ///< largest, over the throughput at the end [-]
  double throughput{};  ///< [J]
  double travel{};      ///< of the motor, there and back [rad]
  int reversals{};
};

RandomRun runRandom(const Parameters& parameters, unsigned seed, bool brake)
{
  const JointModel model(parameters);
  JointStepper stepper(parameters, model);
  RandomInputs inputs(seed, parameters, brake);
  RandomRun run;
  for (int i = 0; i < parameters.solver.rate; ++i)
  {
    const double angle = stepper.motorAngle();
    const double speed = stepper.speeds()[0];
    EXPECT_TRUE(stepper.step(inputs.next(model.motor, speed))) << i;
    run.residual = std::max(run.residual, std::abs(stepper.energyResidual()));
    run.travel += std::abs(stepper.motorAngle() - angle);
    run.reversals += speed * stepper.speeds()[0] < 0.0 ? 1 : 0;
  }
  run.throughput = stepper.energyThroughput();
  run.residual /= run.throughput;
  testing::Test::RecordProperty("relative_energy_residual", testing::PrintToString(run.residual));
  testing::Test::RecordProperty("throughput_joule", testing::PrintToString(run.throughput));
  std::printf("residual/throughput %.3e, throughput %.1f J, travel %.1f rad, reversals %d\n", run.residual, run.throughput, run.travel, run.reversals);
  return run;
}

class EnergyLedger : public testing::TestWithParam<const char*>
{
};
INSTANTIATE_TEST_SUITE_P(Joints, EnergyLedger, testing::Values("", "joints/base", "joints/shoulder", "joints/elbow"));

TEST_P(EnergyLedger, ClosesOverARandomSecondWithTheLeapfrog)
{
  const std::vector<std::string> overlays = *GetParam() == 0 ? std::vector<std::string>{} : std::vector<std::string>{ GetParam() };
  const RandomRun run = runRandom(shippedParameters({}, overlays), 71, true);
  EXPECT_LT(run.residual, 1e-6);
  EXPECT_GT(run.travel, 5.0);
  EXPECT_GT(run.reversals, 3);
}

TEST(EnergyLedgerRungeKutta, ClosesOverARandomSecond)
{
  // Friction is explicit here: it must be regularised as widely as the stepper asks for.
  const Parameters parameters = shippedParameters(
      { "solver.stepper=runge_kutta4", "brake.holding_torque=0.0", "solver.stiction_velocity=0.5" });
  const RandomRun run = runRandom(parameters, 72, false);
  EXPECT_LT(run.residual, 1e-6);
  EXPECT_GT(run.travel, 5.0);
}

TEST(FrictionInTheRunningJoint, BalancesMomentumInEveryStep)
{
  // What the leapfrog takes for friction must be the friction law at the speeds it arrives at.
  const Parameters parameters = shippedParameters();
  const JointModel model(parameters);
  JointDynamics dynamics(model, parameters.solver);
  ASSERT_TRUE(dynamics.settle().ok());
  RandomInputs inputs(73, parameters, true);
  Leapfrog leapfrog;
  JointState x = JointState::Zero();
  x[OUTPUT_ANGLE] = dynamics.ring().position().output_angle;
  double worst = 0.0;
  for (int i = 0; i < 10000; ++i)
  {
    dynamics.inputs = inputs.next(model.motor, leapfrog.speeds()[0]);
    leapfrog.do_step(dynamics, x, 0.0, 1e-4);
    ASSERT_TRUE(dynamics.status.ok());
    const Eigen::Vector2d after = x.segment<2>(MOTOR_SPEED);
    const Eigen::Vector2d law = dynamics.dryFriction().torque(dynamics.friction(), dynamics.follow(), after) +
                                dynamics.friction().viscous * (after - leapfrog.speeds());
    double strength = dynamics.friction().viscous.col(0).lpNorm<1>() * std::abs(after[0]);
    for (const FrictionTerm& term : dynamics.friction().terms)
    {
      strength += term.strength * std::abs(term.slip[0] + dynamics.follow() * term.slip[1]);
    }
    const Eigen::Vector2d off = leapfrog.frictionTorque() - law;
    worst = std::max(worst, std::abs(off[0] + dynamics.follow() * off[1]) / strength);
  }
  RecordProperty("worst_relative_error", testing::PrintToString(worst));
  std::printf("friction worst relative error %.3e\n", worst);
  // The speeds are found to 1e-11; where the joint sticks, the slope of friction over 1e-6 rad/s magnifies that.
  EXPECT_LT(worst, 1e-4);
}

/// Dissipation read from the state that the steppers march.
TEST(Dissipation, IsNeverNegative)
{
  const Parameters parameters = shippedParameters({}, { "joints/elbow" });
  const JointModel model(parameters);
  JointDynamics dynamics(model, parameters.solver);
  ASSERT_TRUE(dynamics.settle().ok());
  RandomInputs inputs(74, parameters, true);
  Leapfrog leapfrog;
  JointState x = JointState::Zero();
  x[OUTPUT_ANGLE] = dynamics.ring().position().output_angle;
  double worst = 0.0;
  double highest = 0.0;
  for (int i = 0; i < 10000; ++i)
  {
    dynamics.inputs = inputs.next(model.motor, leapfrog.speeds()[0]);
    const double before = x[DISSIPATED];
    leapfrog.do_step(dynamics, x, 0.0, 1e-4);
    worst = std::min(worst, x[DISSIPATED] - before);
    highest = std::max(highest, x[DISSIPATED]);
    ASSERT_GE(highest - x[DISSIPATED], 0.0);
  }
  EXPECT_GT(x[DISSIPATED], 0.1);
  std::printf("dissipated %.3f J, most negative step %.3e J\n", x[DISSIPATED], worst);
  EXPECT_GE(worst, 0.0);
}

TEST(Stiction, HoldsTheMotorToTheLastBit)
{
  const Parameters parameters = shippedParameters();
  const JointModel model(parameters);
  JointStepper stepper(parameters, model);
  const double breakaway = parameters.motor.coulomb_torque;
  // A second at rest under ninety per cent of what the motor shaft alone holds.
  JointInputs inputs;
  inputs.temperature = parameters.input.temperature;
  inputs.motor_torque = 0.9 * breakaway;
  const double start = stepper.motorAngle();
  for (int i = 0; i < 10000; ++i)
  {
    ASSERT_TRUE(stepper.step(inputs));
  }
  EXPECT_EQ(stepper.motorAngle(), start);
  // With twice the breakaway of all friction it runs.
  inputs.motor_torque = 6.0 * breakaway;
  for (int i = 0; i < 1000; ++i)
  {
    ASSERT_TRUE(stepper.step(inputs));
  }
  EXPECT_GT(stepper.motorAngle(), 1.0);
}
}  // namespace
}  // namespace hjt
