// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/elements/wave_generator_contact.hpp"

#include <cmath>

#include "harmonic_joint_twin/elements/contact_ramp.hpp"

namespace hjt
{
namespace
{
/// The thesis' approximation of the foot, in the ellipse's axes.
EllipseFoot polarPoint(double a, double b, double x, double y) noexcept
{
  const double radius = std::sqrt(x * x + y * y);
  const double nx = b * b * x;
  const double ny = a * a * y;
  const double inverse = 1.0 / std::sqrt(nx * nx + ny * ny);
  EllipseFoot foot;
  foot.normal_x = nx * inverse;
  foot.normal_y = ny * inverse;
  foot.depth = (a * x / radius - x) * foot.normal_x + (b * y / radius - y) * foot.normal_y;
  foot.curvature = 1.0 / radius;
  return foot;
}
}  // namespace

struct WaveGeneratorContact::Frame
{
  Frame(double mean_radius, const DrivePosition& position) noexcept
    : cos(std::cos(position.wave_generator_angle))
    , sin(std::sin(position.wave_generator_angle))
    , a(mean_radius + position.wave_amplitude)
    , b(mean_radius - position.wave_amplitude)
  {
  }

  double cos;
  double sin;
  double a;
  double b;
};

WaveGeneratorContact::WaveGeneratorContact(const ContactParameters& parameters, const GearParameters& gear)
  : law_(parameters.law)
  , smoothing_(parameters.smoothing)
  , mean_radius_(gear.flexspline_inner_radius)
  , stiffness_(Eigen::VectorXd::Constant(gear.teeth_flexspline, parameters.stiffness))
{
}

/// Foot of the normal from a tooth point; the normal in the housing's axes.
EllipseFoot WaveGeneratorContact::foot(const Frame& frame, double x, double y) const noexcept
{
  const double own_x = frame.cos * x + frame.sin * y;
  const double own_y = frame.cos * y - frame.sin * x;
  EllipseFoot foot = law_ == ContactLaw::NORMAL ? closestPoint(frame.a, frame.b, own_x, own_y) :
                                                  polarPoint(frame.a, frame.b, own_x, own_y);
  const double nx = foot.normal_x;
  foot.normal_x = frame.cos * nx - frame.sin * foot.normal_y;
  foot.normal_y = frame.sin * nx + frame.cos * foot.normal_y;
  return foot;
}

void WaveGeneratorContact::addForces(const RingShape& shape, const DrivePosition& position, RingForces& forces) const
    noexcept
{
  const Frame frame(mean_radius_, position);
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const double x = shape.points[2 * i];
    const double y = shape.points[2 * i + 1];
    const EllipseFoot at = foot(frame, x, y);
    const ContactRamp ramp(at.depth, smoothing_);
    const double force = stiffness_[i] * ramp.force;
    forces.teeth[2 * i] += force * at.normal_x;
    forces.teeth[2 * i + 1] += force * at.normal_y;
    forces.contact_force[i] = force;
    forces.contact_depth[i] = at.depth;
    forces.contact_curvature[i] = at.curvature;
    forces.contact_normal[2 * i] = at.normal_x;
    forces.contact_normal[2 * i + 1] = at.normal_y;
    forces.wave_generator_torque -= force * (x * at.normal_y - y * at.normal_x);
    forces.energy += stiffness_[i] * ramp.energy;
  }
}

void WaveGeneratorContact::addTangent(const RingShape& shape, const RingForces& forces, RingTangent& tangent) const
    noexcept
{
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const double depth = forces.contact_depth[i];
    if (depth <= 0.0)
    {
      continue;
    }
    const Eigen::Vector2d point = shape.points.segment<2>(2 * i);
    const double force = forces.contact_force[i];
    const double stiffness = stiffness_[i] * ContactRamp(depth, smoothing_).tangent;
    const Eigen::Vector2d n = forces.contact_normal.segment<2>(2 * i);
    const Eigen::Vector2d t(-n.y(), n.x());
    // The normal turns with the point at this rate; the force follows it.
    const double turn = forces.contact_curvature[i] / (1.0 - forces.contact_curvature[i] * depth);
    tangent.addDiagonal(i, stiffness * n * n.transpose() - force * turn * t * t.transpose());

    const double lever = point.x() * n.y() - point.y() * n.x();
    const double reach = point.dot(n);
    tangent.wave_generator.segment<2>(2 * i) -= stiffness * lever * n + force * (1.0 - turn * reach) * t;
    tangent.wave_generator_stiffness += stiffness * lever * lever + force * (1.0 - turn * reach) * reach;
  }
}
}  // namespace hjt
