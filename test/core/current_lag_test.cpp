// SPDX-License-Identifier: BSD-3-Clause
// Currents that are recorded at another time than the motion that draws them.
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <gmock/gmock.h>

#include "tracking/current_lag.hpp"

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
    std::mt19937 engine(7);
    std::normal_distribution<double> of_current(0.0, noise);
    CurrentLag found;
    for (int i = 0; period * i < seconds; ++i)
    {
      const double time = period * i;
      if (holds(time))
      {
        MotionSample sample = at(time);
        sample.current = current(time - lag) + of_current(engine);
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
}  // namespace
}  // namespace hjt
