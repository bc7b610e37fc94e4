// SPDX-License-Identifier: BSD-3-Clause
// The observer beside the twin as a robot: noisy encoders, torque known, and what the residual says.
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include <gmock/gmock.h>
#include <Eigen/Eigenvalues>

#include "test_parameters.hpp"

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "statics/torsion_curve.hpp"
#include "test/support/seeded_random.hpp"
#include "tracking/observer.hpp"

namespace hjt
{
namespace
{
enum class Encoders
{
  OUTPUT,
  BOTH
};

struct Rows
{
  double period{ 0.002 };  // [s]
  Encoders encoders{ Encoders::BOTH };
  double dropped{};  // share of rows that do not come [-]
  double jitter{};   // of the stamps, evenly to either side [s]
};

using Torque = std::function<double(double time, const JointOutputs& now)>;

struct Seen : Observation
{
  double time{};
};

/// The observer of `believed` beside a robot of `real`.
std::vector<Seen> observe(const Parameters& real, const Parameters& believed, double duration,
                          const Torque& motor_torque, const Rows& rows = {})
{
  SeededRandom engine(5);
  Twin robot(real);
  robot.reset(0);
  Observer observer(believed);
  std::vector<Seen> seen;
  double due = 0.0;
  for (double time = 0.0; time < duration; time = static_cast<double>(robot.stamp()) / 1e9)
  {
    robot.commandMotorTorque(robot.stamp(), motor_torque(time, robot.outputs()));
    EXPECT_TRUE(robot.step(robot.stamp() + robot.stepLength()));
    const JointOutputs& now = robot.outputs();
    const double stamp = static_cast<double>(now.stamp) / 1e9;
    if (stamp < due)
    {
      continue;
    }
    due = rows.period * (std::floor(stamp / rows.period + 0.5) + 1.0) + rows.jitter * engine.uniform();
    if (0.5 * (1.0 + engine.uniform()) < rows.dropped)
    {
      continue;
    }
    const double none = std::numeric_limits<double>::quiet_NaN();
    Seen at;
    static_cast<Observation&>(at) = observer.step(
        { stamp, now.motor_torque, 0.0, now.output_angle + believed.observer.output_angle_noise * engine.normal(),
          rows.encoders == Encoders::BOTH ? now.motor_angle + believed.observer.motor_angle_noise * engine.normal() :
                                            none,
          false });
    at.time = stamp;
    seen.push_back(at);
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

/// Of the residual against the motion, where the motor is faster than `speed` [N.m].
double meanResistance(const std::vector<Seen>& seen, double from, double until, double speed = 30.0)
{
  double sum = 0.0;
  double count = 0.0;
  for (const Seen& at : seen)
  {
    if (at.time > from && at.time < until && std::abs(at.motor_velocity) > speed)
    {
      sum -= at.motor_velocity > 0.0 ? at.residual_torque : -at.residual_torque;
      ++count;
    }
  }
  EXPECT_GT(count, 50.0);
  return sum / count;
}

/// Share of the rows in motion whose residual lies within its band.
double shareInside(const std::vector<Seen>& seen)
{
  double inside = 0.0;
  double moving = 0.0;
  for (const Seen& at : seen)
  {
    if (at.time > 1.0 && !at.sticking)
    {
      ++moving;
      inside += std::abs(at.residual_torque) < at.residual_band ? 1.0 : 0.0;
    }
  }
  EXPECT_GT(moving, 100.0);
  return inside / moving;
}

const std::vector<std::string> JOINT{ "motor.viscous_friction=0.0", "output.load_inertia=1.5", "solver.rate=5000",
                                      "indicators.sample_rate=1000" };

Parameters jointWith(const std::string& assignment)
{
  std::vector<std::string> assignments = JOINT;
  assignments.push_back(assignment);
  return shippedParameters(assignments);
}

// Every size of the catalogue, inertias from none to a stretched arm, periods from 2 kHz to 100 Hz, one encoder or
// both: the error of the steady filter dies out.
TEST(Observer, IsStableForEveryStiffness)
{
  const ObserverParameters noise = shippedParameters().observer;
  using Piece = ObserverPiece;
  for (const double output_inertia : { 3e-4, 0.02, 0.5, 3.3, 30.0 })
  {
    for (const int steps : { 1, 2, 8, 10 })
    {
      for (double stiffness = 31.0; stiffness < 1e7; stiffness *= 2.5)
      {
        for (const bool both : { false, true })
        {
          const Piece piece = makeObserverPiece({ 1.69e-4, output_inertia }, 101.0, stiffness, Observer::STEP, noise);
          Piece::Matrix covariance = 1e-6 * Piece::Matrix::Identity();
          Piece::Matrix error;
          for (int row = 0; row < 4000; ++row)
          {
            error.setIdentity();
            for (int i = 0; i < steps; ++i)
            {
              covariance = (piece.transition * covariance * piece.transition.transpose() + piece.process).eval();
              error = (piece.transition * error).eval();
            }
            const auto take = [&](Piece::State angle, double deviation)
            {
              const Piece::Vector gain = takeAngle(covariance, angle, deviation);
              error = (error - gain * error.row(angle)).eval();
            };
            if (both)
            {
              take(Piece::MOTOR_ANGLE, noise.motor_angle_noise);
            }
            take(Piece::OUTPUT_ANGLE, noise.output_angle_noise);
          }
          const std::string where = std::to_string(stiffness) + " N.m/rad, " + std::to_string(output_inertia) +
                                    " kg.m^2, " + std::to_string(steps) + " ms, both " + std::to_string(both);
          ASSERT_TRUE(covariance.allFinite()) << where;
          ASSERT_GT(covariance.diagonal().minCoeff(), 0.0) << where;
          // In units of the deviations, so that states of unlike size weigh alike.
          const Piece::Vector unit = covariance.diagonal().cwiseSqrt();
          const Piece::Matrix scaled = unit.cwiseInverse().asDiagonal() * error * unit.asDiagonal();
          ASSERT_LT(scaled.eigenvalues().cwiseAbs().maxCoeff(), 1.0 - 1e-6) << where;
        }
      }
    }
  }
}

TEST(Observer, OfAHealthyJointStaysWithinItsBand)
{
  const Parameters joint = shippedParameters(JOINT);
  for (const Rows& rows :
       { Rows{}, Rows{ 0.008, Encoders::BOTH }, Rows{ 0.008, Encoders::OUTPUT },
         Rows{ 0.008, Encoders::OUTPUT, 0.05, 0.002 }, Rows{ 0.002, Encoders::OUTPUT, 0.01, 0.0005 } })
  {
    EXPECT_GT(shareInside(observe(joint, joint, 5.0, servo, rows)), 0.95)
        << rows.period << " s, dropped " << rows.dropped;
  }
}

/// Where friction builds up over an angle, it is as large once the motor turns.
TEST(Observer, KnowsTheFrictionThatBuildsUpOverAnAngle)
{
  const Parameters joint = jointWith("motor.presliding_angle=3e-3");
  const std::vector<Seen> seen = observe(joint, joint, 3.0, servo, { 0.008, Encoders::OUTPUT });
  EXPECT_GT(shareInside(seen), 0.95);
  EXPECT_NEAR(meanResistance(seen, 1.0, 3.0), 0.0, 0.005);
}

TEST(Observer, ShowsFrictionThatHasGrownAndDoesNotLearnItAway)
{
  const Parameters healthy = shippedParameters(JOINT);
  const Parameters worn = jointWith("motor.coulomb_torque=0.085");  // 0.08 N.m more
  for (const Rows& rows : { Rows{}, Rows{ 0.008, Encoders::OUTPUT, 0.01, 0.001 } })
  {
    const std::vector<Seen> seen = observe(worn, healthy, 8.0, servo, rows);
    const double found = meanResistance(seen, 1.0, 8.0);
    EXPECT_NEAR(found, 0.08, 0.02);
    // As large at the end as at the start, and beyond what is expected of a healthy joint.
    EXPECT_NEAR(meanResistance(seen, 5.5, 8.0), meanResistance(seen, 0.5, 3.0), 0.01);
    EXPECT_LT(shareInside(seen), 0.3);
  }
}

/// Stands for a while under torque that friction holds, then turns.
double standAndTurn(double time, const JointOutputs& now)
{
  if (time < 6.0)
  {
    return time < 3.0 ? 0.05 : -0.05;
  }
  return servo(time - 6.0, now);
}

TEST(Observer, DoesNotWindUpWhileFrictionHoldsTheMotor)
{
  const Parameters joint = shippedParameters(JOINT);
  for (const Rows& rows : { Rows{}, Rows{ 0.008, Encoders::OUTPUT } })
  {
    double largest = 0.0;
    double first_band = 0.0;
    double last_band = 0.0;
    double after_start = 0.0;
    for (const Seen& at : observe(joint, joint, 7.0, standAndTurn, rows))
    {
      // 0.05 N.m is most of what holds the motor: taken for a disturbance, it would show whole.
      largest = at.time > 0.5 && at.time < 6.0 ? std::max(largest, std::abs(at.residual_torque)) : largest;
      first_band = at.time < 0.5 ? at.residual_band : first_band;
      last_band = at.time < 3.0 ? at.residual_band : last_band;
      after_start = at.time > 6.3 ? std::max(after_start, std::abs(at.residual_torque)) : after_start;
    }
    EXPECT_LT(largest, 0.04);
    if (rows.encoders == Encoders::OUTPUT)
    {
      EXPECT_GT(last_band, 1.5 * first_band);  // standing tells nothing, and the band says so
    }
    EXPECT_LT(after_start, 0.05);
  }
}

/// While friction holds the motor it stands still, to rounding, and its noise goes into nothing else.
TEST(Observer, KnowsThatAMotorThatSticksStandsStill)
{
  const Parameters joint = shippedParameters(JOINT);
  // The innovation's band is that of the encoders and of a joint that stands: bounds 5 % above it [rad].
  for (const auto& [rows, bound] :
       std::vector<std::pair<Rows, double>>{ { Rows{}, 1.07e-4 }, { Rows{ 0.008, Encoders::OUTPUT }, 1.34e-4 } })
  {
    int stuck = 0;
    double widest = 0.0;
    for (const Seen& at : observe(joint, joint, 3.0, standAndTurn, rows))
    {
      if (at.time > 1.0 && at.sticking)
      {
        ++stuck;
        widest = std::max(widest, at.innovation_band);
        ASSERT_LT(std::abs(at.motor_velocity), 1e-12) << at.time << " s";
      }
    }
    EXPECT_GT(stuck, 200);
    EXPECT_LT(widest, bound);
  }
}

TEST(Observer, IsNotHeldByFrictionThatTheRobotDoesNotHave)
{
  // The robot has lost most of its friction; in the observer it would hold the motor against the torque that comes
  // later.
  const Parameters believed = shippedParameters(JOINT);
  const Parameters loose = jointWith("bearing.race_preload=0.0");
  for (const Rows& rows : { Rows{}, Rows{ 0.008, Encoders::OUTPUT } })
  {
    const std::vector<Seen> seen = observe(
        loose, believed, 5.0, [](double time, const JointOutputs&) { return time < 2.0 ? 0.0 : 0.045; }, rows);
    EXPECT_LT(meanResistance(seen, 3.0, 5.0, 2.0), -0.02);
  }
}

TEST(Observer, BeginsAnewAfterAGap)
{
  const Parameters joint = shippedParameters(JOINT);
  Observer observer(joint);
  const double none = std::numeric_limits<double>::quiet_NaN();
  observer.step({ 0.0, 0.0, 0.0, 0.3, none, false });
  const Observation restarted = observer.step({ 50.0, 0.0, 0.0, -1.2, none, true });
  EXPECT_NEAR(restarted.output_angle, -1.2, 1e-9);
  EXPECT_NEAR(restarted.motor_angle, -1.2 * nominalRatio(joint.gear), 0.1);
  EXPECT_EQ(restarted.residual_torque, 0.0);
}

TEST(TorsionCurve, HasTheStiffnessOfTheCatalogueInEverySize)
{
  struct Size
  {
    std::vector<std::string> overlays;
    double first_slope;  // of the catalogue, up to the first breakpoint [N.m/rad]
  };
  for (const Size& size : { Size{ {}, 31.0e3 }, Size{ { "size_14" }, 4.7e3 } })
  {
    const Parameters parameters = shippedParameters({}, size.overlays);
    const TorsionCurve curve(parameters);
    const double torque = parameters.cup.torsion_breakpoints[0];
    EXPECT_NEAR(torque / curve.torsion(torque), size.first_slope, 0.03 * size.first_slope);
    for (const double share : { -1.3, -0.4, 0.01, 0.4, 1.0, 2.0, 30.0 })
    {
      EXPECT_NEAR(curve.torque(curve.torsion(share * torque)), share * torque, 1e-9 * torque);
    }
  }
}
}  // namespace
}  // namespace hjt
