// SPDX-License-Identifier: BSD-3-Clause
#include <functional>
#include <vector>

#include <gmock/gmock.h>

#include "element_under_test.hpp"
#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "model/faults/joint_faults.hpp"
#include "random_ring.hpp"
#include "solver/ring_equilibrium.hpp"
#include "test/core/faults_support.hpp"
#include "test_parameters.hpp"
#include "twin_runs.hpp"

namespace hjt
{
namespace
{
/// How often the sag over one tooth, or anywhere, has a maximum in `turns` of the wave generator.
TEST(RaceDeflection, OrdersComeOutOfTheKinematics)
{
  Parameters parameters = shippedParameters();
  const int teeth = parameters.gear.teeth_flexspline;
  const auto events_per_turn = [&](const std::function<void(RaceDeflection&)>& damage)
  {
    RaceDeflection bearing(parameters.bearing);
    damage(bearing);
    Eigen::VectorXd sag(teeth);
    Eigen::VectorXd rate(teeth);
    Eigen::VectorXd second(teeth);
    constexpr int TURNS = 200;
    constexpr int STEPS = 1000;  // a turn
    int events = 0;
    bool sagged = true;
    for (int k = 0; k < TURNS * STEPS; ++k)
    {
      bearing.at(TWO_PI * k / STEPS, sag, rate, second);
      const bool sags = sag.maxCoeff() > 0.0;
      events += sags && !sagged ? 1 : 0;
      sagged = sags;
    }
    return static_cast<double>(events) / TURNS;
  };
  const double length = 1e-3;
  EXPECT_NEAR(events_per_turn([&](RaceDeflection& b) { b.addInnerSpall(0.3, 1e-5, length); }), 12.6793, 0.006);
  EXPECT_NEAR(events_per_turn([&](RaceDeflection& b) { b.addOuterSpall(0.3, 1e-5, length); }), 10.3207, 0.006);
  EXPECT_NEAR(events_per_turn([&](RaceDeflection& b) { b.addBallSpall(4, 1e-5, length); }), 2.0 * 4.8244, 0.006);
  EXPECT_NEAR(RaceDeflection(parameters.bearing).cageRate(), 0.4487, 5e-5);
  // Balls and cage that lag pass the outer race less often and the inner one, which runs ahead, more often.
  parameters.bearing.cage_slip = 0.02;
  EXPECT_NEAR(events_per_turn([&](RaceDeflection& b) { b.addInnerSpall(0.3, 1e-5, length); }), 12.8857, 0.006);
  EXPECT_NEAR(events_per_turn([&](RaceDeflection& b) { b.addOuterSpall(0.3, 1e-5, length); }), 10.1143, 0.006);
  EXPECT_NEAR(events_per_turn([&](RaceDeflection& b) { b.addBallSpall(4, 1e-5, length); }), 2.0 * 4.7279, 0.006);
}

TEST(RaceDeflection, NoBallDropsButTheOneThatMay)
{
  const Parameters parameters = shippedParameters();
  std::vector<RaceDeflection> bearings(5, RaceDeflection(parameters.bearing));
  bearings[0].addInnerSpall(2.3, 1e-5, 2e-3);
  bearings[1].addInnerSpall(-1.1, 1e-5, 4e-3);  // nearly from ball to ball
  bearings[2].addOuterSpall(6.2, 1e-5, 2e-3);
  bearings[3].addBallSpall(4, 1e-5, 2e-3);
  bearings[4].addIdleBall(22, 1e-5);
  for (const RaceDeflection& bearing : bearings)
  {
    ASSERT_TRUE(bearing.dropsOneBall());
    int drops = 0;
    for (double angle = -700.0; angle < 700.0; angle += 0.0713)
    {
      const int dropping = bearing.ballThatMayDrop(angle);
      ASSERT_TRUE(dropping >= 0 && dropping < bearing.balls());
      drops += bearing.drop(dropping, angle).value > 0.0 ? 1 : 0;
      for (int ball = 0; ball < bearing.balls(); ++ball)
      {
        ASSERT_TRUE(ball == dropping || bearing.drop(ball, angle).value == 0.0) << ball << " at " << angle;
      }
    }
    EXPECT_GT(drops, 100);
  }
}

TEST(RaceDeflection, OfAllBallsIsTheSameAllRound)
{
  const Parameters parameters = shippedParameters();
  RaceDeflection bearing(parameters.bearing);
  for (int ball = 0; ball < parameters.bearing.balls; ++ball)
  {
    bearing.addIdleBall(ball, 3e-6);
  }
  Eigen::VectorXd sag(200);
  Eigen::VectorXd rate(200);
  Eigen::VectorXd second(200);
  bearing.at(12.34, sag, rate, second);
  EXPECT_NEAR(sag.minCoeff(), 3e-6, 1e-15);
  EXPECT_NEAR(sag.maxCoeff(), 3e-6, 1e-15);
}
}  // namespace
}  // namespace hjt
