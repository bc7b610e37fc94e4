// SPDX-License-Identifier: BSD-3-Clause
// A current that departs as a whole is another gain; friction departs alone.
#include <cmath>
#include <random>

#include <gmock/gmock.h>

#include "test_parameters.hpp"

#include "tracking/verdict.hpp"

namespace hjt
{
namespace
{
using testing::HasSubstr;

/// A joint under a load of this amplitude [N.m], whose friction and load are multiples of its twin's.
/// `pause`: after half a minute of it the recorder stood for so long [s].
GainEvidence shown(double load_factor, double friction_factor, double amplitude = 20.0, double noise = 0.05,
                   double pause = 0.0)
{
  constexpr double PERIOD = 0.008;  // [s]
  const Parameters parameters = shippedParameters({ "motor.viscous_friction=0.0", "solver.rate=2000" });
  const double gain = parameters.telemetry.torque_per_current;
  MotionDriven twin(parameters);
  JointEvidence evidence(parameters, LoadOrigin::ARM);
  std::mt19937 engine(11);
  std::normal_distribution<double> of_current(0.0, noise);
  for (int i = 0; i * PERIOD < 60.0; ++i)
  {
    MotionSample sample;
    sample.time = i * PERIOD;
    sample.after_gap = i == 0;
    sample.position = 0.7 * std::sin(0.9 * sample.time) + 0.2 * std::sin(2.3 * sample.time);
    sample.velocity = 0.63 * std::cos(0.9 * sample.time) + 0.46 * std::cos(2.3 * sample.time);
    sample.load = amplitude * std::sin(sample.position + 0.4);
    const MotionPrediction predicted = twin.step(sample);
    const double friction = predicted.friction_torque / gain;
    const bool is_second = sample.time > 30.0;
    sample.after_gap = sample.after_gap || (pause > 0.0 && is_second && sample.time < 30.0 + 1.5 * PERIOD);
    sample.time += is_second ? pause : 0.0;
    sample.current = friction_factor * friction + load_factor * (predicted.current - friction) + of_current(engine);
    evidence.update(sample);
  }
  return GainEvidence(evidence);
}

TEST(GainEvidence, KnowsBothMultiples)
{
  for (const double load : { 0.5, 1.0, 2.0 })
  {
    for (const double friction : { 0.7, 1.0, 1.5 })
    {
      const GainEvidence evidence = shown(load, friction);
      EXPECT_NEAR(evidence.load.value, load, 0.02) << load << ' ' << friction;
      if (load == 1.0)  // else it holds what of the load both ways do not share
      {
        EXPECT_NEAR(evidence.friction, friction, 0.02) << friction;
      }
    }
  }
}

TEST(GainEvidence, FrictionAloneIsNoGain)
{
  for (const double friction : { 0.7, 1.4, 2.0, 3.0 })
  {
    const GainEvidence evidence = shown(1.0, friction);
    EXPECT_TRUE(evidence.isExcluded()) << friction;
    EXPECT_FALSE(evidence.misfit().exists()) << friction;
  }
}

TEST(GainEvidence, ACurrentThatDepartsAsAWholeIsAGain)
{
  for (const double multiple : { 0.6, 1.4, 2.0, 10.7 })
  {
    const GainEvidence evidence = shown(multiple, multiple);
    EXPECT_FALSE(evidence.isExcluded()) << multiple;
    ASSERT_TRUE(evidence.misfit().exists()) << multiple;
    EXPECT_EQ(evidence.misfit().reason, Reason::EFFORT_UNIT);
    EXPECT_THAT(evidence.misfit().clause, HasSubstr("telemetry.torque_per_current"));
  }
  EXPECT_FALSE(shown(1.1, 1.1).misfit().exists()) << "gains of one type differ by as much";
}

TEST(GainEvidence, AnotherLoadIsNotOfTheFriction)
{
  EXPECT_TRUE(shown(1.4, 1.4).isOfFriction());
  EXPECT_TRUE(shown(0.6, 0.6).isOfFriction());
  GainEvidence evidence = shown(1.0, 1.0);
  evidence.load.value = 1.21;
  evidence.friction = 1.0;
  EXPECT_FALSE(evidence.isOfFriction());
  evidence.friction = 1.15;
  EXPECT_TRUE(evidence.isOfFriction());
}

TEST(GainEvidence, WithoutALoadNothingIsTold)
{
  const GainEvidence evidence = shown(2.0, 2.0, 0.1);
  EXPECT_TRUE(std::isnan(evidence.load.value));
  EXPECT_FALSE(evidence.isExcluded());
  EXPECT_FALSE(evidence.misfit().exists());
}

TEST(GainEvidence, UnderNoiseItIsLessSure)
{
  const GainEvidence clear = shown(1.4, 1.4);
  const GainEvidence blurred = shown(1.4, 1.4, 4.0, 2.0);
  EXPECT_GT(blurred.load.uncertainty, 3.0 * clear.load.uncertainty);
  EXPECT_FALSE(blurred.isExcluded());
}

/// But for the rows after it until the friction is mobilised again: some of 7500.
TEST(GainEvidence, APauseTellsNothing)
{
  const GainEvidence all = shown(1.4, 1.4, 4.0, 1.0);
  const GainEvidence paused = shown(1.4, 1.4, 4.0, 1.0, 1200.0);
  EXPECT_NEAR(paused.load.value, all.load.value, 0.1 * all.load.uncertainty);
  EXPECT_NEAR(paused.load.uncertainty, all.load.uncertainty, 0.01 * all.load.uncertainty);
}
}  // namespace
}  // namespace hjt
