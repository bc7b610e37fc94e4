// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/drive_markers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

#include <Eigen/Core>

#include "gear/angle.hpp"

namespace hjt
{
namespace
{
using visualization_msgs::Marker;
using Point = Eigen::Vector2d;

constexpr double LINE_WIDTH = 0.2e-3;   // width of a line [m]
constexpr double TEXT_HEIGHT = 1.8e-3;  // height of a letter [m]
constexpr double ARROW_WIDTH = 0.2e-3;  // width of an arrow's shaft [m]
constexpr double ARROW_HEAD = 0.7e-3;   // length and width of an arrow's head [m]
constexpr double MIN_ARROW = 0.2e-3;    // least length of a drawn arrow [m]
constexpr double TIP_SHARE = 0.12;      // half width of a drawn tooth at the tip [pitches]
constexpr double ROOT_SHARE = 0.28;     // half width of a drawn tooth at the root [pitches]
constexpr double RING_HEIGHTS = 2.0;    // radial height of the circular spline's ring outside the roots [tooth heights]
constexpr double ROOT_CLEARANCE = 1.2;  // depth of the circular spline's spaces [tooth heights]
constexpr int ELLIPSE_POINTS = 180;

std_msgs::ColorRGBA color(float red, float green, float blue)
{
  std_msgs::ColorRGBA made;
  made.r = red;
  made.g = green;
  made.b = blue;
  made.a = 1.0F;
  return made;
}

const std_msgs::ColorRGBA STEEL = color(0.62F, 0.66F, 0.70F);
const std_msgs::ColorRGBA DARK_STEEL = color(0.35F, 0.39F, 0.44F);
const std_msgs::ColorRGBA FULL_LOAD = color(0.90F, 0.10F, 0.10F);
const std_msgs::ColorRGBA GREEN = color(0.25F, 0.65F, 0.35F);
const std_msgs::ColorRGBA ORANGE = color(0.95F, 0.55F, 0.10F);
const std_msgs::ColorRGBA BLUE = color(0.20F, 0.45F, 0.90F);
const std_msgs::ColorRGBA BLACK = color(0.05F, 0.05F, 0.05F);

/// Colour for a share `of` the full value: that of steel at 0, `full` at 1 or more, and a mixture between.
std_msgs::ColorRGBA shareColor(double of, const std_msgs::ColorRGBA& full)
{
  const auto share = static_cast<float>(std::min(1.0, of));
  return color(STEEL.r + share * (full.r - STEEL.r), STEEL.g + share * (full.g - STEEL.g),
               STEEL.b + share * (full.b - STEEL.b));
}

Marker makeMarker(const std_msgs::Header& header, const char* name, int type, const std_msgs::ColorRGBA& made)
{
  Marker marker;
  marker.header = header;
  marker.ns = name;
  marker.type = type;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color = made;
  return marker;
}

void addPoint(Marker& marker, const Point& at)
{
  geometry_msgs::Point point;
  point.x = at.x();
  point.y = at.y();
  marker.points.push_back(point);
}

/// Adds front and back of a triangle, because rviz does not draw the back.
void addTriangle(Marker& marker, const Point& a, const Point& b, const Point& c, const std_msgs::ColorRGBA& made)
{
  for (const Point* corner : { &a, &b, &c, &a, &c, &b })
  {
    addPoint(marker, *corner);
    marker.colors.push_back(made);
  }
}

void addQuad(Marker& marker, const Point& a, const Point& b, const Point& c, const Point& d,
             const std_msgs::ColorRGBA& made)
{
  addTriangle(marker, a, b, c, made);
  addTriangle(marker, a, c, d, made);
}

/// Adds an arrow that ends at `tip`. `along`: length and direction of the arrow [m].
void addArrow(Marker& marker, const Point& tip, const Point& along)
{
  const double length = along.norm();
  if (!(length > MIN_ARROW))
  {
    return;
  }
  const Point ahead = along / length;
  const Point aside(-ahead.y(), ahead.x());
  const Point neck = tip - std::min(length, ARROW_HEAD) * ahead;
  const Point tail = tip - along;
  addQuad(marker, tail - 0.5 * ARROW_WIDTH * aside, tail + 0.5 * ARROW_WIDTH * aside, neck + 0.5 * ARROW_WIDTH * aside,
          neck - 0.5 * ARROW_WIDTH * aside, marker.color);
  addTriangle(marker, neck - 0.5 * ARROW_HEAD * aside, neck + 0.5 * ARROW_HEAD * aside, tip, marker.color);
}

Point direction(double angle)
{
  return { std::cos(angle), std::sin(angle) };
}

/// Stretches radial distances from a circle about the origin.
struct Stretch
{
  double radius;  // radius of the circle [m]
  double factor;  // factor by which distances from the circle are stretched [-]

  Point operator()(const Point& at) const
  {
    const double r = at.norm();
    return at * ((radius + factor * (r - radius)) / r);
  }
};
}  // namespace

DriveMarkers::DriveMarkers(const Parameters& parameters, const MarkerStyle& style)
  : gear_(parameters.gear)
  , flank_angle_(parameters.mesh.flank_angle)
  , stress_(parameters)
  , full_stress_(parameters.life.endurance_limit /
                 parameters.stress.concentration[static_cast<std::size_t>(StressPlace::TOOTH_SPACE)])
  , style_(style)
  , fixed_radius_(gear_.flexspline_inner_radius + gear_.wave_amplitude + gear_.toothMidHeight())
{
}

/// Markers of rim, teeth and forces, and the numbers for the text of the marker `loads`.
struct DriveMarkers::Teeth
{
  Marker flexspline;
  Marker pressing;
  Marker leading;
  Marker trailing;
  int loaded{};
  double largest{};           // largest force on a flank [N]
  double largest_pressing{};  // largest force of the wave generator on a tooth [N]
};

/// Draws the ellipse of the wave generator, and its major axis.
std::pair<Marker, Marker> DriveMarkers::drawWaveGenerator(const std_msgs::Header& header, double angle) const
{
  const Stretch drawn{ fixed_radius_, style_.exaggeration };
  Marker wave = makeMarker(header, "wave_generator", Marker::LINE_STRIP, GREEN);
  Marker axis = makeMarker(header, "wave_generator", Marker::LINE_LIST, GREEN);
  axis.id = 1;
  wave.scale.x = axis.scale.x = LINE_WIDTH;
  const double major = gear_.flexspline_inner_radius + gear_.wave_amplitude;
  const double minor = gear_.flexspline_inner_radius - gear_.wave_amplitude;
  const Point along = direction(angle);
  const Point across(-along.y(), along.x());
  for (int i = 0; i <= ELLIPSE_POINTS; ++i)
  {
    const Point at = direction(TWO_PI * i / ELLIPSE_POINTS);
    addPoint(wave, drawn(major * at.x() * along + minor * at.y() * across));
  }
  for (const double side : { -1.0, 1.0 })
  {
    addPoint(axis, drawn(side * major * along));
    addPoint(axis, 0.8 * drawn(side * major * along));
  }
  return { std::move(wave), std::move(axis) };
}

/// Draws tooth `i` with its segment of the rim and its forces.
void DriveMarkers::drawTooth(const harmonic_joint_twin::ContactForces& forces, std::size_t i, Teeth& teeth) const
{
  const Stretch drawn{ fixed_radius_, style_.exaggeration };
  const double pitch = TWO_PI * (gear_.flexspline_inner_radius + gear_.toothMidHeight()) / gear_.teeth_flexspline;
  const std::size_t count = forces.tooth_x.size();
  const auto point = [&forces, count](std::size_t j)
  { return Point(forces.tooth_x[j % count], forces.tooth_y[j % count]); };
  const Point here = point(i);
  const Point tangent = (point(i + 1) - point(i + count - 1)).normalized();
  const Point outward(tangent.y(), -tangent.x());
  const double force = std::abs(forces.mesh_force[i]);
  const std_msgs::ColorRGBA load = shareColor(force / style_.full_force, FULL_LOAD);
  const Point before = here - point(i + count - 1);
  const Point behind = point(i + 1) - here;
  const double turn = smallAngle(before.x() * behind.y() - before.y() * behind.x(), before.dot(behind));
  const double stress =
      stress_.inToothSpace(turn - TWO_PI / gear_.teeth_flexspline,
                           0.5 * (forces.rim_tension[i] + forces.rim_tension[(i + count - 1) % count]));
  const std_msgs::ColorRGBA stressed = shareColor(std::abs(stress) / full_stress_, stress > 0.0 ? FULL_LOAD : BLUE);
  const Point root = here + gear_.rim_thickness * outward;
  const Point tip = root + gear_.tooth_height_flexspline * outward;
  const Point half_root = ROOT_SHARE * pitch * tangent;
  const Point half_tip = TIP_SHARE * pitch * tangent;
  const Point half_rim = 0.5 * pitch * tangent;
  addQuad(teeth.flexspline, drawn(here - half_rim), drawn(here + half_rim), drawn(root + half_rim),
          drawn(root - half_rim), stressed);
  addQuad(teeth.flexspline, drawn(root - half_root), drawn(root + half_root), drawn(tip + half_tip),
          drawn(tip - half_tip), load);

  addArrow(teeth.pressing, drawn(here), style_.arrow_length * forces.wave_generator_force[i] * outward);
  const bool is_leading = forces.mesh_force[i] > 0.0;
  const Point onto = -std::sin(flank_angle_) * outward + (is_leading ? -1.0 : 1.0) * std::cos(flank_angle_) * tangent;
  addArrow(is_leading ? teeth.leading : teeth.trailing, drawn(tip), style_.arrow_length * force * onto);

  teeth.loaded += force > 0.0 ? 1 : 0;
  teeth.largest = std::max(teeth.largest, force);
  teeth.largest_pressing = std::max(teeth.largest_pressing, forces.wave_generator_force[i]);
}

Marker DriveMarkers::drawCircularSpline(const std_msgs::Header& header, double output_angle) const
{
  const Stretch drawn{ fixed_radius_, style_.exaggeration };
  Marker circular = makeMarker(header, "circular_spline", Marker::TRIANGLE_LIST, DARK_STEEL);
  const double tip = gear_.tip_radius_circular_spline;
  const double root = tip + ROOT_CLEARANCE * gear_.tooth_height_flexspline;
  const double edge = root + RING_HEIGHTS * gear_.tooth_height_flexspline;
  const double pitch = TWO_PI / gear_.teeth_circular_spline;
  for (int i = 0; i < gear_.teeth_circular_spline; ++i)
  {
    // A tooth of the circular spline is half a pitch from the space of equal number.
    const double middle = output_angle + (i + 0.5) * pitch;
    const auto at = [&](double radius, double pitches) { return drawn(radius * direction(middle + pitches * pitch)); };
    addQuad(circular, at(tip, -TIP_SHARE), at(tip, TIP_SHARE), at(root, ROOT_SHARE), at(root, -ROOT_SHARE), DARK_STEEL);
    addQuad(circular, at(root, -0.5), at(root, 0.5), at(edge, 0.5), at(edge, -0.5), DARK_STEEL);
  }
  return circular;
}

visualization_msgs::MarkerArray DriveMarkers::draw(const harmonic_joint_twin::ContactForces& forces) const
{
  const auto count = static_cast<std::size_t>(gear_.teeth_flexspline);
  if (forces.tooth_x.size() != count || forces.tooth_y.size() != count || forces.mesh_force.size() != count ||
      forces.wave_generator_force.size() != count || forces.rim_tension.size() != count)
  {
    throw std::invalid_argument("contact forces have " + std::to_string(forces.tooth_x.size()) +
                                " teeth, but gear.teeth_flexspline is " + std::to_string(count));
  }
  std_msgs::Header header = forces.header;
  header.frame_id = style_.frame;
  std::pair<Marker, Marker> wave = drawWaveGenerator(header, forces.wave_generator_angle);
  Teeth teeth{ makeMarker(header, "flexspline", Marker::TRIANGLE_LIST, STEEL),
               makeMarker(header, "wave_generator_force", Marker::TRIANGLE_LIST, GREEN),
               makeMarker(header, "leading_flank_force", Marker::TRIANGLE_LIST, ORANGE),
               makeMarker(header, "trailing_flank_force", Marker::TRIANGLE_LIST, BLUE) };
  for (std::size_t i = 0; i < count; ++i)
  {
    drawTooth(forces, i, teeth);
  }
  Marker circular = drawCircularSpline(header, forces.output_angle);

  Marker text = makeMarker(header, "loads", Marker::TEXT_VIEW_FACING, BLACK);
  char line[120];
  std::snprintf(line, sizeof line, "%d teeth loaded with at most %.0f N; force of the wave generator at most %.0f N",
                teeth.loaded, teeth.largest, teeth.largest_pressing);
  text.text = line;
  text.scale.z = TEXT_HEIGHT;

  visualization_msgs::MarkerArray array;
  array.markers = { std::move(wave.first),       std::move(wave.second),
                    std::move(teeth.flexspline), std::move(circular),
                    std::move(teeth.pressing),   std::move(teeth.leading),
                    std::move(teeth.trailing),   std::move(text) };
  // Removes empty markers: rviz reports a list of triangles without points as an error.
  for (Marker& marker : array.markers)
  {
    marker.action = marker.points.empty() && marker.text.empty() ? Marker::DELETE : Marker::ADD;
  }
  return array;
}
}  // namespace hjt
