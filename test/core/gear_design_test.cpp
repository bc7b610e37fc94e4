// SPDX-License-Identifier: BSD-3-Clause
// A gear of another size or ratio against the laws of similarity.
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "test_parameters.hpp"

#include "base/number_text.hpp"
#include "statics/gear_design.hpp"

namespace hjt
{
namespace
{
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
