// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/drive_markers.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "gear/angle.hpp"
#include "gear/ring_shape.hpp"
#include "test/core/test_parameters.hpp"

namespace hjt
{
namespace
{
const Parameters& parameters()
{
  static const Parameters SHIPPED = shippedParameters({ "mesh.flank_angle=1.0" });
  return SHIPPED;
}

const MarkerStyle STYLE{ "drive", 4.0, 1.0e-4, 100.0 };

/// A round flexspline with no force on any tooth.
harmonic_joint_twin::ContactForces unloaded(const GearParameters& gear)
{
  const ToothRing ring(gear);
  harmonic_joint_twin::ContactForces forces;
  for (int i = 0; i < ring.teeth(); ++i)
  {
    forces.tooth_x.push_back(ring.points()[2 * i]);
    forces.tooth_y.push_back(ring.points()[2 * i + 1]);
  }
  forces.mesh_force.assign(ring.teeth(), 0.0);
  forces.wave_generator_force.assign(ring.teeth(), 0.0);
  forces.rim_tension.assign(ring.teeth(), 0.0);
  return forces;
}

const visualization_msgs::Marker& find(const visualization_msgs::MarkerArray& array, const std::string& name)
{
  for (const visualization_msgs::Marker& marker : array.markers)
  {
    if (marker.ns == name)
    {
      return marker;
    }
  }
  throw std::out_of_range(name);
}

TEST(DriveMarkers, StretchRadiiFromTheEngagedTeeth)
{
  const GearParameters gear = parameters().gear;
  const double fixed = gear.flexspline_inner_radius + gear.wave_amplitude + gear.toothMidHeight();
  for (const double exaggeration : { 1.0, 4.0 })
  {
    const DriveMarkers markers(parameters(), { "drive", exaggeration, 1.0e-4, 100.0 });
    const visualization_msgs::MarkerArray array = markers.draw(unloaded(gear));
    const geometry_msgs::Point& first = find(array, "wave_generator").points.front();
    const double major = gear.flexspline_inner_radius + gear.wave_amplitude;
    EXPECT_NEAR(first.x, fixed - exaggeration * (fixed - major), 1e-12);
    EXPECT_NEAR(first.y, 0.0, 1e-12);
  }
}

TEST(DriveMarkers, DrawTheEllipseWithItsMajorAxisWhereTheWaveGeneratorPoints)
{
  const GearParameters gear = parameters().gear;
  harmonic_joint_twin::ContactForces forces = unloaded(gear);
  forces.wave_generator_angle = 0.4;
  const visualization_msgs::MarkerArray array =
      DriveMarkers(parameters(), { "drive", 1.0, 1.0e-4, 100.0 }).draw(forces);
  const double major = gear.flexspline_inner_radius + gear.wave_amplitude;
  const double minor = gear.flexspline_inner_radius - gear.wave_amplitude;
  for (const geometry_msgs::Point& point : find(array, "wave_generator").points)
  {
    const double along = point.x * std::cos(0.4) + point.y * std::sin(0.4);
    const double across = point.y * std::cos(0.4) - point.x * std::sin(0.4);
    EXPECT_NEAR(std::hypot(along / major, across / minor), 1.0, 1e-9);
  }
}

TEST(DriveMarkers, DrawNoArrowWithoutForce)
{
  const GearParameters gear = parameters().gear;
  const visualization_msgs::MarkerArray array = DriveMarkers(parameters(), STYLE).draw(unloaded(gear));
  for (const char* name : { "wave_generator_force", "leading_flank_force", "trailing_flank_force" })
  {
    EXPECT_EQ(find(array, name).action, visualization_msgs::Marker::DELETE) << name;
  }
}

TEST(DriveMarkers, AnArrowEndsAtTheLoadedToothAndIsAsLongAsTheForce)
{
  const GearParameters gear = parameters().gear;
  harmonic_joint_twin::ContactForces forces = unloaded(gear);
  forces.mesh_force[50] = -80.0;
  const visualization_msgs::MarkerArray array =
      DriveMarkers(parameters(), { "drive", 1.0, 1.0e-4, 100.0 }).draw(forces);
  EXPECT_EQ(find(array, "leading_flank_force").action, visualization_msgs::Marker::DELETE);
  const auto& points = find(array, "trailing_flank_force").points;
  ASSERT_FALSE(points.empty());
  const double tip_radius = gear.flexspline_inner_radius + gear.rim_thickness + gear.tooth_height_flexspline;
  const double angle = TWO_PI * 50 / gear.teeth_flexspline;
  double farthest = 0.0;
  double nearest = 1.0;
  for (const geometry_msgs::Point& point : points)
  {
    const double distance = std::hypot(point.x - tip_radius * std::cos(angle), point.y - tip_radius * std::sin(angle));
    farthest = std::max(farthest, distance);
    nearest = std::min(nearest, distance);
  }
  EXPECT_NEAR(nearest, 0.0, 1e-9);
  EXPECT_NEAR(farthest, 80.0 * 1.0e-4, 1e-5);
  const auto& colors = find(array, "flexspline").colors;
  const std::size_t per_tooth = colors.size() / gear.teeth_flexspline;
  const std::size_t tooth = per_tooth / 2;  // the rim comes first
  EXPECT_GT(colors[50 * per_tooth + tooth].r, colors[51 * per_tooth + tooth].r);
}

TEST(DriveMarkers, ShowTheStressOfTheRim)
{
  const GearParameters gear = parameters().gear;
  harmonic_joint_twin::ContactForces forces = unloaded(gear);
  const double section = parameters().life.face_width * gear.rim_thickness;
  const double full = parameters().life.endurance_limit / parameters().stress.concentration[0];
  for (const std::size_t segment : { 19U, 20U })
  {
    forces.rim_tension[segment] = full * section;
    forces.rim_tension[segment + 100] = -full * section;
  }
  const visualization_msgs::MarkerArray array = DriveMarkers(parameters(), STYLE).draw(forces);
  const auto& colors = find(array, "flexspline").colors;
  const std::size_t per_tooth = colors.size() / gear.teeth_flexspline;
  EXPECT_FLOAT_EQ(colors[20 * per_tooth].r, 0.9F) << "tension: red";
  EXPECT_FLOAT_EQ(colors[120 * per_tooth].b, 0.9F) << "compression: blue";
  EXPECT_FLOAT_EQ(colors[60 * per_tooth].r, 0.62F) << "none: steel";
}

TEST(DriveMarkers, RefuseAnotherNumberOfTeeth)
{
  const GearParameters gear = parameters().gear;
  harmonic_joint_twin::ContactForces forces = unloaded(gear);
  forces.mesh_force.pop_back();
  EXPECT_THROW(DriveMarkers(parameters(), STYLE).draw(forces), std::invalid_argument);
}
}  // namespace
}  // namespace hjt
