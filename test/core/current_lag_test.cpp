// SPDX-License-Identifier: BSD-3-Clause
// Currents that are recorded at another time than the motion that draws them.

#include <array>
#include <cmath>
#include <functional>

#include <gmock/gmock.h>

#include "test/core/test_parameters.hpp"
#include "test/support/seeded_random.hpp"
#include "tracking/current_lag.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
namespace
{
using testing::Each;

using Left = std::array<double, CurrentLag::LAGS>;

/// Of a joint that swings under a weight, its current by gain, friction and inertia.
struct Swing
{
  double rate{ 0.9 };   // [rad/s]
  double noise{ 0.1 };  // [A]
  double period{ 0.008 };
  double amplitude{ 0.7 };

  MotionSample at(double time) const
  {
    MotionSample sample;
    sample.time = time;
    sample.position = amplitude * std::sin(rate * time) + 0.3 * amplitude * std::sin(2.6 * rate * time);
    sample.velocity = amplitude * rate * std::cos(rate * time) + 0.78 * amplitude * rate * std::cos(2.6 * rate * time);
    sample.acceleration =
        -amplitude * rate * rate * std::sin(rate * time) - 2.03 * amplitude * rate * rate * std::sin(2.6 * rate * time);
    sample.load = 2.0 * std::sin(sample.position + 0.4);  // [A]
    return sample;
  }

  double current(double time) const
  {
    const MotionSample sample = at(time);
    return 0.9 * sample.load + std::copysign(1.0, sample.velocity) + 0.4 * sample.velocity + 0.2 * sample.acceleration;
  }

  /// The current comes `lag` behind the motion [s].
  CurrentLag recorded(
      double lag, double seconds = 60.0, const std::function<bool(double)>& holds = [](double) { return true; }) const
  {
    SeededRandom engine(7);
    CurrentLag found;
    for (int i = 0; period * i < seconds; ++i)
    {
      const double time = period * i;
      if (holds(time))
      {
        MotionSample sample = at(time);
        sample.current = current(time - lag) + noise * engine.normal();
        found.add(sample, sample.load);
      }
    }
    return found;
  }
};

std::vector<Left> armWith(double lag, double noise = 0.1)
{
  std::vector<Left> joints;
  for (int i = 0; i < 6; ++i)
  {
    joints.push_back(Swing{ 0.7 + 0.1 * i, noise }.recorded(lag).left());
  }
  return joints;
}

TEST(CurrentLag, OfAnArmIsFoundToHalfOfWhatIsTried)
{
  for (const double lag : { -0.32, -0.2, -0.1, 0.1, 0.16, 0.32 })
  {
    EXPECT_NEAR(commonLag(armWith(lag)), lag, 0.5 * CurrentLag::SPACING + 1e-9) << lag;
    EXPECT_NEAR(ownLag(Swing().recorded(lag == 0.1 || lag == -0.1 ? 2.0 * lag : lag).left()),
                lag == 0.1 || lag == -0.1 ? 2.0 * lag : lag, 0.5 * CurrentLag::SPACING + 1e-9)
        << lag;
  }
}

TEST(CurrentLag, OfSoundRecordingsIsNone)
{
  for (const double noise : { 0.0, 0.1, 0.5 })
  {
    EXPECT_EQ(commonLag(armWith(0.0, noise)), 0.0) << noise;
    EXPECT_EQ(ownLag(Swing{ 0.9, noise }.recorded(0.0).left()), 0.0) << noise;
  }
  EXPECT_EQ(commonLag(armWith(0.03)), 0.0) << "a few rows change no verdict";
}

TEST(CurrentLag, LeavesTheNoiseAtTheTrueTime)
{
  const Left left = Swing{ 0.9, 0.3 }.recorded(0.2).left();
  const std::size_t right = 15;
  ASSERT_NEAR(CurrentLag::lagAt(right), 0.2, 1e-12);
  EXPECT_NEAR(std::sqrt(left[right]), 0.3, 0.015) << "4800 rows";
}

TEST(CurrentLag, OneJointAloneIsNotTheArms)
{
  std::vector<Left> joints = armWith(0.0);
  joints[2] = Swing().recorded(0.24).left();
  EXPECT_EQ(commonLag(joints), 0.0);
  EXPECT_NEAR(ownLag(joints[2]), 0.24, 1e-9);
}

TEST(CurrentLag, OfTooLittleMotionIsNotKnown)
{
  const Left still = Swing{ 0.9, 0.1, 0.008, 0.001 }.recorded(0.2).left();
  const Left brief = Swing().recorded(0.2, 4.0).left();
  for (const Left& left : { still, brief })
  {
    EXPECT_TRUE(std::isnan(left.front()));
    EXPECT_EQ(ownLag(left), 0.0);
  }
  EXPECT_EQ(commonLag({ still, still, still }), 0.0);
  EXPECT_EQ(commonLag({}), 0.0);
}

TEST(CurrentLag, DoesNotDependOnTheRateNorOnGaps)
{
  for (const double period : { 0.002, 0.008, 0.016, 0.05 })
  {
    EXPECT_NEAR(ownLag(Swing{ 0.9, 0.1, period }.recorded(0.24).left()), 0.24, 1e-9) << period;
  }
  const auto pieces = [](double time) { return std::fmod(time, 6.0) < 5.0; };
  EXPECT_NEAR(ownLag(Swing().recorded(0.24, 90.0, pieces).left()), 0.24, 1e-9);
  const auto crumbs = [](double time) { return std::fmod(time, 1.2) < 0.7; };
  EXPECT_THAT(Swing().recorded(0.24, 90.0, crumbs).left(), Each(testing::IsNan()))
      << "no piece is long enough for all lags";
}

TEST(CurrentLag, ForgetsWhatItSawAtAReset)
{
  CurrentLag lag = Swing().recorded(0.24);
  lag.reset();
  EXPECT_TRUE(std::isnan(lag.left().front()));
}

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
  SeededRandom engine(11);
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
    sample.current =
        friction_factor * friction + load_factor * (predicted.current - friction) + noise * engine.normal();
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
