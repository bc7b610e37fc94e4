// SPDX-License-Identifier: BSD-3-Clause
// Friction of the whole gear: what the analyses say, against closed forms and against the running joint.

#include <cmath>
#include <map>

#include "elements/friction_laws.hpp"
#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/statics/loss_analysis.hpp"
#include "harmonic_joint_twin/statics/torsion_loop.hpp"
#include "statics/gear_design.hpp"
#include "test/core/stepped_joint.hpp"
#include "test/core/test_parameters.hpp"

namespace hjt
{
namespace
{
constexpr double RPM = TWO_PI / 60.0;  // rad/s

TEST(BearingFriction, IsPalmgrensByHand)
{
  BearingParameters parameters;
  parameters.lubricant_factor = 1.5;
  parameters.load_factor = 5e-4;
  parameters.race_preload = 400.0;
  parameters.pitch_diameter = 50e-3;
  parameters.viscosity = 80e-6;
  parameters.oil_viscosity = 80e-6;
  parameters.viscosity_temperature = 25.0;
  parameters.viscosity_slope = 3.7;
  const BearingFriction bearing(parameters);
  // 1.5 (80 x 1000)^(2/3) 50^3 1e-7 N.mm and 5e-4 (600 + 400) 50 N.mm.
  EXPECT_NEAR(bearing.torque(1000.0 * RPM, 600.0, 25.0), 1e-3 * (34.8119 + 25.0), 1e-7);
  // Below 2000 mm^2/s rpm, here 25 rpm, the speed part is constant: 1.5 160 50^3 1e-7 N.mm.
  EXPECT_NEAR(bearing.torque(-10.0 * RPM, 600.0, 25.0), 1e-3 * (3.0 + 25.0), 1e-12);
  EXPECT_EQ(bearing.torque(0.0, 600.0, 25.0), bearing.torque(10.0 * RPM, 600.0, 25.0));
}

TEST(BearingFriction, OilThinsAsInTheChart)
{
  BearingParameters parameters;
  // An oil of 46 mm^2/s at 40 degC and 6.8 mm^2/s at 100 degC (ISO VG 46, viscosity index 100): slope from these two.
  parameters.viscosity = 46e-6;
  parameters.oil_viscosity = 46e-6;
  parameters.viscosity_temperature = 40.0;
  parameters.viscosity_slope =
      std::log10(std::log10(46.7) / std::log10(7.5)) / std::log10((100.0 + 273.15) / (40.0 + 273.15));
  const BearingFriction bearing(parameters);
  EXPECT_NEAR(bearing.viscosity(40.0), 46e-6, 1e-12);
  EXPECT_NEAR(bearing.viscosity(100.0), 6.8e-6, 1e-11);
  EXPECT_GT(bearing.viscosity(0.0), 8.0 * bearing.viscosity(40.0));

  // A grease that acts with three times that viscosity thins as its oil does.
  parameters.viscosity = 138e-6;
  const BearingFriction grease(parameters);
  for (const double temperature : { 0.0, 40.0, 100.0 })
  {
    EXPECT_NEAR(grease.viscosity(temperature), 3.0 * bearing.viscosity(temperature), 1e-15);
  }
}

TEST(BearingFriction, ConstantShareStaysWhereGreaseThinsOrDegrades)
{
  BearingParameters parameters = shippedParameters().bearing;
  parameters.race_preload = 0.0;
  const BearingFriction gear(parameters);
  parameters.viscosity *= std::pow(1.0 / 0.6, 1.5);  // a joint: two thirds as much again, of no grease
  parameters.constant_share = 0.4;
  const BearingFriction joint(parameters);
  BearingFriction old_gear = gear;
  BearingFriction old_joint = joint;
  old_gear.scaleViscosity(3.0);
  old_joint.scaleViscosity(3.0);
  const double extra = joint.torque(100.0, 0.0, 25.0) - gear.torque(100.0, 0.0, 25.0);
  EXPECT_NEAR(extra, 2.0 / 3.0 * gear.torque(100.0, 0.0, 25.0), 1e-12);
  for (const double temperature : { 0.0, 25.0, 60.0 })
  {
    EXPECT_NEAR(joint.torque(100.0, 0.0, temperature) - gear.torque(100.0, 0.0, temperature), extra, 1e-12);
    EXPECT_NEAR(old_joint.torque(100.0, 0.0, temperature) - old_gear.torque(100.0, 0.0, temperature), extra, 1e-12);
  }
}

TEST(BearingFriction, ShippedOilIsThatOfItsGrease)
{
  BearingParameters parameters = shippedParameters().bearing;
  parameters.viscosity = parameters.oil_viscosity;
  const BearingFriction oil(parameters);
  // SK-1A: 80 mm^2/s at 25 degC (thesis), 37 and 5.9 quoted at 40 and 100 degC.
  EXPECT_NEAR(oil.viscosity(25.0), 80e-6, 1e-12);
  EXPECT_NEAR(oil.viscosity(40.0), 37e-6, 0.03 * 37e-6);
  EXPECT_NEAR(oil.viscosity(100.0), 5.9e-6, 0.03 * 5.9e-6);
}

using RunningJoint = testing::TestWithParam<double>;
INSTANTIATE_TEST_SUITE_P(Loads, RunningJoint, testing::Values(0.0, 20.0, 60.0));

TEST_P(RunningJoint, RunsWhereMotorTorqueIsLoadAndLosses)
{
  // The motor is held at a speed by a stiff speed control; the torque it takes is what the analysis says.
  constexpr double SPEED = 60.0;  // [rad/s]
  const double load = GetParam();
  SteppedJoint joint(shippedParameters({ "output.load_inertia=0.1" }));
  joint.inputs.load_torque = load;
  double work = 0.0;
  const auto control = [&](int /*step*/) { joint.inputs.motor_torque = 0.3 * (SPEED - joint.stepper.speeds()[0]); };
  joint.run(5000, control);
  const double start = joint.stepper.motorAngle();
  for (int i = 0; i < 5000; ++i)
  {
    const double before = joint.stepper.motorAngle();
    joint.run(1, control);
    work += joint.inputs.motor_torque * (joint.stepper.motorAngle() - before);
  }
  const double travel = joint.stepper.motorAngle() - start;
  const double speed = travel / 0.5;
  const LossRow row = analyseLosses(joint.parameters, { speed }, { load }, 32, nullptr).front();
  ASSERT_TRUE(row.status.ok());
  const double reduced = load / nominalRatio(joint.parameters.gear);
  EXPECT_NEAR(row.load_reduced, reduced, 2e-3 * reduced);
  const double expected = row.load_reduced + row.loss.gear() + row.loss.motor;
  EXPECT_NEAR(work / travel, expected, 0.005 * expected);
}

TEST(Breakaway, IsWhereTheJointBeginsToMove)
{
  const Parameters parameters = shippedParameters({ "motor.coulomb_torque=0.0", "input.temperature=20.0" });
  const Breakaway breakaway = analyseBreakaway(parameters, 16);
  ASSERT_TRUE(breakaway.status.ok());
  const auto travel = [&](double motor_torque, double load_torque)
  {
    SteppedJoint joint(parameters);
    joint.inputs.motor_torque = motor_torque;
    joint.inputs.load_torque = load_torque;
    joint.run(5000);  // for the load, put on at once, to stop swinging
    const double start = joint.stepper.motorAngle();
    joint.run(5000);
    return std::abs(joint.stepper.motorAngle() - start);
  };
  constexpr double CREEP = 1e-3;  // rad: friction of a stuck gear is regularised
  EXPECT_LT(travel(0.95 * breakaway.starting, 0.0), CREEP);
  EXPECT_GT(travel(1.05 * breakaway.starting, 0.0), 1.0);
  EXPECT_LT(travel(0.0, 0.95 * breakaway.back_driving), CREEP);
  EXPECT_GT(travel(0.0, 1.05 * breakaway.back_driving), 1.0);
}

TEST(TorsionLoop, IsAsWideAsTheFrictionOverTheStiffness)
{
  const Parameters parameters = shippedParameters({ "cup.friction_torque=2.0" });
  const TorsionLoop loop = analyseTorsionLoop(parameters, 60.0, 2.68, 100);
  ASSERT_TRUE(loop.status.ok());
  ASSERT_EQ(loop.points.size(), 202U);
  EXPECT_NEAR(loop.hysteresis, 2.0 * 2.0 / parameters.cup.torsion_stiffness[0], 0.02 * loop.hysteresis);
  // Odd: the same both ways.
  EXPECT_NEAR(loop.points.front().output_angle, -loop.points[100].output_angle, 1e-9);
  // Without any friction it closes.
  const TorsionLoop closed = analyseTorsionLoop(
      shippedParameters({ "cup.friction_torque=0.0", "mesh.friction_static=0.0", "mesh.friction_kinetic=0.0" }), 60.0,
      2.68, 100);
  EXPECT_EQ(closed.hysteresis, 0.0);
  EXPECT_NEAR(closed.lost_motion, 2.0 * 2.68 / 31e3, 0.03 * closed.lost_motion);
}

ParameterMap configured()
{
  ParameterMap map;
  readDefaultConfiguration(HJT_TEST_CONFIG_DIR, map);
  return map;
}

double number(const ParameterMap& map, const std::string& key)
{
  return numberOf(map.at(key).value).value();
}

/// Of a size that no catalogue has, so that friction is not fitted.
GearDesign designed(const GearRequest& request)
{
  return designGear(configured(), request, gearFigures(request));
}

TEST(GearDesign, OfAnotherSizeIsGeometricallySimilar)
{
  constexpr double SIZE = 30.0;
  constexpr double FACTOR = SIZE / 25.0;
  GearRequest request;
  request.size = SIZE;
  const GearDesign larger = designed(request);
  const ParameterMap before = configured();
  // A length by the first power; of one material a spring of bending by the third per angle, a mass by the third.
  const std::map<std::string, int> powers{ { "gear.flexspline_inner_radius", 1 },
                                           { "gear.rim_thickness", 1 },
                                           { "gear.tooth_height_flexspline", 1 },
                                           { "gear.tip_radius_circular_spline", 1 },
                                           { "gear.wave_amplitude", 1 },
                                           { "mesh.flank_clearance", 1 },
                                           { "mesh.engagement_depth", 1 },
                                           { "bearing.pitch_diameter", 1 },
                                           { "bearing.ball_diameter", 1 },
                                           { "contact.slip_lever", 1 },
                                           { "stress.wall_thickness", 1 },
                                           { "life.face_width", 1 },
                                           { "ring.tension_stiffness", 1 },
                                           { "ring.bending_stiffness", 3 },
                                           { "ring.mass", 3 },
                                           { "cup.wall_stiffness", 3 },
                                           { "bearing.race_bending_stiffness", 3 },
                                           { "bearing.race_preload", 2 },
                                           { "motor.wave_generator_inertia", 5 } };
  for (const auto& [key, power] : powers)
  {
    const double expected = number(before, key) * std::pow(FACTOR, power);
    EXPECT_NEAR(number(larger.map, key), expected, 1e-9 * std::abs(expected)) << key;
  }
  EXPECT_EQ(number(larger.map, "gear.teeth_flexspline"), 200.0);
}

TEST(GearDesign, OfHalfTheRatioHasTeethOfTwiceTheHeight)
{
  GearRequest request;
  request.size = 25.001;
  request.ratio = 50;
  const GearDesign coarse = designed(request);
  const ParameterMap before = configured();
  EXPECT_EQ(number(coarse.map, "gear.teeth_flexspline"), 100.0);
  EXPECT_EQ(number(coarse.map, "gear.teeth_circular_spline"), 102.0);
  const double height = number(before, "gear.tooth_height_flexspline");
  EXPECT_NEAR(number(coarse.map, "gear.tooth_height_flexspline"), 2.0 * height, 1e-3 * height);
  EXPECT_NEAR(number(coarse.map, "gear.flexspline_inner_radius"), number(before, "gear.flexspline_inner_radius"), 1e-5);
}
}  // namespace
}  // namespace hjt
