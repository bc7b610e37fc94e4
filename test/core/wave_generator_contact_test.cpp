// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "element_under_test.hpp"
#include "elements/contact_laws.hpp"
#include "gear/angle.hpp"
#include "random_ring.hpp"
#include "test/core/elements_support.hpp"
#include "test_parameters.hpp"

namespace hjt
{
namespace
{
/// Smoothing of the contacts: the exact law and a ramp as wide as the penetrations, so that all its branches are met.
class WaveGeneratorContactNormal : public testing::TestWithParam<std::string>
{
};
INSTANTIATE_TEST_SUITE_P(Smoothing, WaveGeneratorContactNormal, testing::Values("0.0", "20.0e-6"));

TEST_P(WaveGeneratorContactNormal, IsTheGradientOfItsEnergy)
{
  const Parameters parameters = goldenParameters({ "contact.smoothing=" + GetParam() });
  const RingModel model(parameters);
  const ElementUnderTest contact = elementOf<WaveGeneratorContact>(model);
  RandomRing ring(6);
  RingShape shape(model.rest.teeth());
  DrivePosition position;
  int open = 0;
  int ramp = 0;
  int full = 0;
  for (int k = 0; k < 12;)
  {
    ring.draw(model, shape, position);
    const Eigen::ArrayXd depth = contact.forces(shape, position).of<WaveGeneratorContact>().depth.array();
    // No tooth so near a kink of the law that a difference would straddle it.
    const double width = parameters.contact.smoothing;
    if (std::min(depth.abs().minCoeff(), (depth - width).abs().minCoeff()) < 1e-8)
    {
      continue;
    }
    SCOPED_TRACE("shape " + std::to_string(k++));
    open += static_cast<int>((depth < 0.0).count());
    ramp += static_cast<int>((depth > 0.0 && depth < width).count());
    full += static_cast<int>((depth > std::max(width, 0.0)).count());
    expectGradientAndTangent(contact, shape, position);
  }
  EXPECT_GT(open, 100);
  EXPECT_GT(full, 100);
  EXPECT_EQ(ramp > 100, parameters.contact.smoothing > 0.0);
}

/// Rim and race stand back from each other where they are worn, and where a faulty bearing lets the race down.
TEST_P(WaveGeneratorContactNormal, IsTheGradientOfItsEnergyBehindAGap)
{
  for (const bool sound : { true, false })
  {
    RingModel model(goldenParameters({ "contact.smoothing=" + GetParam() }));
    auto& worn = model.edit<WaveGeneratorContact>();
    for (int i = 0; i < model.rest.teeth(); ++i)
    {
      worn.gap()[i] = 1e-6 * (7 * i % 50);
    }
    if (!sound)
    {
      worn.bearing().addIdleBall(3, 40e-6);
      worn.bearing().addOuterSpall(0.3, 30e-6, 5e-3);
    }
    const ElementUnderTest contact = elementOf<WaveGeneratorContact>(model);
    RandomRing ring(13);
    RingShape shape(model.rest.teeth());
    DrivePosition position;
    for (int k = 0; k < 4;)
    {
      ring.draw(model, shape, position);
      const Eigen::ArrayXd depth = contact.forces(shape, position).of<WaveGeneratorContact>().depth.array();
      if (GetParam() == "0.0" && depth.abs().minCoeff() < 1e-8)
      {
        continue;  // a tooth so near the kink of the law that a difference would straddle it
      }
      SCOPED_TRACE((sound ? "sound bearing, shape " : "faulty bearing, shape ") + std::to_string(k++));
      expectGradientAndTangent(contact, shape, position);
    }
  }
}

TEST_P(WaveGeneratorContactNormal, SurfaceAdvancesByTheAmplitudeAsTheEnergyTells)
{
  const RingModel model(goldenParameters({ "contact.smoothing=" + GetParam() }));
  const ElementUnderTest contact = elementOf<WaveGeneratorContact>(model);
  RandomRing ring(26);
  RingShape shape(model.rest.teeth());
  DrivePosition position;
  for (int k = 0; k < 12; ++k)
  {
    ring.draw(model, shape, position);
    const RingForces forces = contact.forces(shape, position);
    Eigen::VectorXd surface(shape.teeth());
    model.of<WaveGeneratorContact>().surfaceByAmplitude(position, forces.of<WaveGeneratorContact>(), surface);
    const double force = forces.of<WaveGeneratorContact>().force.dot(surface);
    constexpr double STEP = 1e-9;  // m
    DrivePosition before = position;
    DrivePosition after = position;
    before.wave_amplitude -= STEP;
    after.wave_amplitude += STEP;
    const double difference = (contact.forces(shape, after).energy - contact.forces(shape, before).energy) /
                              (after.wave_amplitude - before.wave_amplitude);
    // Contacts that open within the step count by half its square: some 1e8 N/m * 1e-9 m for a few of 200 teeth.
    EXPECT_NEAR(force, difference, 1e-6 * std::abs(force) + 0.1) << k;
  }
}

TEST(WaveGeneratorContact, PolarLawIsThatOfTheThesis)
{
  const Parameters parameters = thesisParameters();
  const RingModel model(parameters);
  RandomRing ring(7);
  RingShape shape(model.rest.teeth());
  DrivePosition position;
  ring.draw(model, shape, position);
  const RingForces forces = elementOf<WaveGeneratorContact>(model).forces(shape, position);
  const double a = parameters.gear.flexspline_inner_radius + position.wave_amplitude;
  const double b = parameters.gear.flexspline_inner_radius - position.wave_amplitude;
  const Eigen::VectorXd own = turned(shape.points, -position.wave_generator_angle);
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const Eigen::Vector2d point = own.segment<2>(2 * i);
    const double psi = std::atan2(point.y(), point.x());
    const double alpha = std::atan2(a * a * point.y(), b * b * point.x());
    const Eigen::Vector2d normal(std::cos(alpha), std::sin(alpha));
    const double depth = (Eigen::Vector2d(a * std::cos(psi), b * std::sin(psi)) - point).dot(normal);
    // Depths are rounded to some 1e-17 m, times the stiffness.
    EXPECT_NEAR(forces.of<WaveGeneratorContact>().force[i], parameters.contact.stiffness * std::max(depth, 0.0), 1e-8);
    const double turn = alpha + position.wave_generator_angle;
    EXPECT_NEAR(forces.of<WaveGeneratorContact>().normal[2 * i], std::cos(turn), 1e-12);
    EXPECT_NEAR(forces.of<WaveGeneratorContact>().normal[2 * i + 1], std::sin(turn), 1e-12);
  }
}

/// delta = 4.36e-4 Q^(2/3) d^(-1/3), mm and N: 500 N press a ball of 6.35 mm in by 14.8 um.
TEST(HertzContact, HasPalmgrensApproach)
{
  const double diameter = 6.35e-3;
  const double depth = 1e-3 * 4.36e-4 * std::pow(500.0, 2.0 / 3.0) / std::cbrt(1e3 * diameter);
  EXPECT_NEAR(depth, 14.8e-6, 0.1e-6);
  EXPECT_NEAR(hertzStiffness(diameter) * HertzContact(depth).force, 500.0, 1e-9);
  EXPECT_EQ(HertzContact(-depth).force, 0.0);
  EXPECT_EQ(HertzContact(-depth).energy, 0.0);
  EXPECT_EQ(HertzContact(0.0).tangent, 0.0);
}

/// A round ring, everywhere as deep: the balls share its force, spread or single.
TEST(WaveGeneratorContact, BallsCarryARoundRingAlike)
{
  for (const std::string support : { "balls", "single_balls" })
  {
    const Parameters parameters = goldenParameters({ "contact.support=" + support, "contact.fit=10.0e-6" });
    const RingModel model(parameters);
    RingShape shape = model.restShape({});
    const RingForces forces = elementOf<WaveGeneratorContact>(model).forces(shape, { 0.3, 0.0, 0.0 });
    const double ball = hertzStiffness(parameters.bearing.ball_diameter) * std::pow(10e-6, 1.5);
    EXPECT_NEAR(forces.of<WaveGeneratorContact>().force.sum(), parameters.bearing.balls * ball, 1e-6 * ball) << support;
    EXPECT_NEAR(forces.energy, parameters.bearing.balls * 0.4 * 10e-6 * ball, 1e-6 * ball * 10e-6) << support;
  }
}

/// 3 K are worth 1.04 um of fit: steel of 30.3 mm grows by 0.35 um a kelvin.
TEST(WaveGeneratorContact, GrowsWithItsTemperature)
{
  const Parameters parameters = goldenParameters({ "contact.temperature_difference=3.0" });
  const double growth = 3.0 * 11.5e-6 * parameters.gear.flexspline_inner_radius;
  const RingModel model(parameters);
  const RingForces forces = elementOf<WaveGeneratorContact>(model).forces(model.restShape({}), { 0.3, 0.0, 0.0 });
  EXPECT_NEAR(forces.of<WaveGeneratorContact>().depth.mean(), growth, 1e-6 * growth);
}

/// Each ball at its place, on a sound bearing and where balls drop.
class OnSingleBalls : public testing::TestWithParam<bool>
{
protected:
  OnSingleBalls()
  {
    auto& contact = model_.edit<WaveGeneratorContact>();
    if (!GetParam())
    {
      contact.bearing().addIdleBall(3, 40e-6);
      contact.bearing().addOuterSpall(0.3, 30e-6, 5e-3);
      contact.bearing().addInnerSpall(0.2, 30e-6, 5e-3);
    }
    for (int i = 0; i < model_.rest.teeth(); ++i)
    {
      contact.gap()[i] = 1e-6 * (7 * i % 20);
    }
  }

  /// A shape of which no ball just begins to carry.
  void draw(RandomRing& ring)
  {
    double nearest = 0.0;
    while (nearest < HERTZ_KINK)
    {
      ring.draw(model_, shape_, position_);
      const RingForces forces = contact_.forces(shape_, position_);
      nearest = 1.0;
      for (int b = 0; b < parameters_.bearing.balls; ++b)
      {
        nearest = std::min(nearest, std::abs(forces.of<WaveGeneratorContact>().balls[b].depth));
      }
    }
  }

  const Parameters parameters_ = goldenParameters({ "contact.support=single_balls" });
  RingModel model_{ parameters_ };
  const ElementUnderTest contact_ = elementOf<WaveGeneratorContact>(model_);
  RingShape shape_{ model_.rest.teeth() };
  DrivePosition position_;
};
INSTANTIATE_TEST_SUITE_P(Sound, OnSingleBalls, testing::Values(true));
INSTANTIATE_TEST_SUITE_P(Faulty, OnSingleBalls, testing::Values(false));

TEST_P(OnSingleBalls, IsTheGradientOfItsEnergy)
{
  RandomRing ring(31);
  for (int k = 0; k < 6; ++k)
  {
    draw(ring);
    SCOPED_TRACE("shape " + std::to_string(k));
    expectGradientAndTangent(contact_, shape_, position_);
  }
}

/// A ball wherever it is between two teeth has the same stiffness in all.
TEST_P(OnSingleBalls, BallsAddUpToTheForceOnTheTeeth)
{
  RandomRing ring(32);
  draw(ring);
  const RingForces forces = contact_.forces(shape_, position_);
  const auto& found = forces.of<WaveGeneratorContact>();
  double sum = 0.0;
  for (int b = 0; b < parameters_.bearing.balls; ++b)
  {
    const SingleBalls::Ball& ball = found.balls[b];
    sum += ball.force;
    EXPECT_NEAR(ball.weight[0] + ball.weight[1] + ball.weight[2], 1.0, 1e-15);
    EXPECT_NEAR(ball.rate[0] + ball.rate[1] + ball.rate[2], 0.0, 1e-12);
  }
  EXPECT_GT(sum, 0.0);
  EXPECT_NEAR(found.force.sum(), sum, 1e-12 * sum);
}

/// After a turn of all by which the cage goes on by one ball, the balls lie under the rim as before.
TEST_P(OnSingleBalls, KeepsItsEnergyUnderARigidTurnToTheNextBall)
{
  if (!GetParam())
  {
    GTEST_SKIP() << "a fault of one ball is not that of the next";
  }
  RandomRing ring(33);
  draw(ring);
  const RingForces forces = contact_.forces(shape_, position_);
  const double angle = TWO_PI / parameters_.bearing.balls / model_.of<WaveGeneratorContact>().bearing().cageRate();
  RingShape moved = shape_;
  moved.points = turned(shape_.points, angle);
  moved.updateGeometry();
  const RingForces after = contact_.forces(
      moved, { position_.wave_generator_angle + angle, position_.output_angle, position_.wave_amplitude });
  EXPECT_LT(relativeError(turned(forces.teeth, angle), after.teeth), 1e-9);
  EXPECT_NEAR(after.energy, forces.energy, 1e-9 * forces.energy);
  EXPECT_NEAR(after.wave_generator_torque, forces.wave_generator_torque,
              1e-9 * (1.0 + std::abs(forces.wave_generator_torque)));
}
}  // namespace
}  // namespace hjt
