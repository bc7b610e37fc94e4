// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/elements/wave_generator_contact.hpp"

#include <algorithm>
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

WaveGeneratorContact::WaveGeneratorContact(const ContactParameters& parameters, const GearParameters& gear,
                                           const ManufactureParameters& manufacture)
  : law_(parameters.law)
  , smoothing_(parameters.smoothing)
  , mean_radius_(gear.flexspline_inner_radius)
  , ellipticity_(manufacture.wave_generator_ellipticity)
  , centre_x_(manufacture.wave_generator_eccentricity[0])
  , centre_y_(manufacture.wave_generator_eccentricity[1])
  , stiffness_(Eigen::VectorXd::Constant(gear.teeth_flexspline, parameters.stiffness))
{
}

Eigen::Vector2d WaveGeneratorContact::centre(const DrivePosition& position) const noexcept
{
  const double c = std::cos(position.wave_generator_angle);
  const double s = std::sin(position.wave_generator_angle);
  return { c * centre_x_ - s * centre_y_, s * centre_x_ + c * centre_y_ };
}

/// Feet of the normals from all tooth points, in the housing's axes.
void WaveGeneratorContact::findFeet(const RingShape& shape, const DrivePosition& position,
                                    RingForces& forces) const noexcept
{
  const double c = std::cos(position.wave_generator_angle);
  const double s = std::sin(position.wave_generator_angle);
  const double amplitude = position.wave_amplitude + ellipticity_;
  const double a = mean_radius_ + amplitude;
  const double b = mean_radius_ - amplitude;
  const double centre_x = centre_x_;
  const double centre_y = centre_y_;
  const int n = shape.teeth();
  const double* point = shape.points.data();
  double* normal = forces.contact_normal.data();
  double* depth = forces.contact_depth.data();
  double* curvature = forces.contact_curvature.data();
  const auto store = [&](int i, const EllipseFoot& foot)
  {
    normal[2 * i] = c * foot.normal_x - s * foot.normal_y;
    normal[2 * i + 1] = s * foot.normal_x + c * foot.normal_y;
    depth[i] = foot.depth;
    curvature[i] = foot.curvature;
  };
  const auto own = [&](int i, double& x, double& y)
  {
    x = c * point[2 * i] + s * point[2 * i + 1] - centre_x;
    y = c * point[2 * i + 1] - s * point[2 * i] - centre_y;
  };
  double x = 0.0;
  double y = 0.0;
  if (law_ == ContactLaw::POLAR)
  {
    for (int i = 0; i < n; ++i)
    {
      own(i, x, y);
      store(i, polarPoint(a, b, x, y));
    }
    return;
  }
  double farthest = 0.0;
  for (int i = 0; i < n; ++i)
  {
    double nearness = 0.0;
    own(i, x, y);
    store(i, closestPointNear(a, b, x, y, nearness));
    farthest = std::max(farthest, nearness);
  }
  if (!(farthest < NEAR_POINT))
  {
    for (int i = 0; i < n; ++i)
    {
      own(i, x, y);
      store(i, closestPoint(a, b, x, y));
    }
  }
}

void WaveGeneratorContact::addForces(const RingShape& shape, const DrivePosition& position,
                                     RingForces& forces) const noexcept
{
  findFeet(shape, position, forces);
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const ContactRamp ramp(forces.contact_depth[i], smoothing_);
    const double force = stiffness_[i] * ramp.force;
    const double nx = forces.contact_normal[2 * i];
    const double ny = forces.contact_normal[2 * i + 1];
    forces.contact_force[i] = force;
    forces.teeth[2 * i] += force * nx;
    forces.teeth[2 * i + 1] += force * ny;
    forces.wave_generator_torque -= force * (shape.points[2 * i] * ny - shape.points[2 * i + 1] * nx);
    forces.energy += stiffness_[i] * ramp.energy;
  }
}

void WaveGeneratorContact::addTangent(const RingShape& shape, const RingForces& forces,
                                      RingTangent& tangent) const noexcept
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

void WaveGeneratorContact::surfaceByAmplitude(const DrivePosition& position, const RingForces& forces,
                                              Eigen::VectorXd& rates) const noexcept
{
  const double c = std::cos(position.wave_generator_angle);
  const double s = std::sin(position.wave_generator_angle);
  const double a = mean_radius_ + position.wave_amplitude + ellipticity_;
  const double b = mean_radius_ - position.wave_amplitude - ellipticity_;
  for (Eigen::Index i = 0; i < rates.size(); ++i)
  {
    rates[i] = 0.0;
    if (forces.contact_force[i] > 0.0)
    {
      const double nx = c * forces.contact_normal[2 * i] + s * forces.contact_normal[2 * i + 1];
      const double ny = c * forces.contact_normal[2 * i + 1] - s * forces.contact_normal[2 * i];
      // The point on the surface is (a u, b v), (u, v) a unit vector; it moves by (u, -v).
      const double u = law_ == ContactLaw::POLAR ? a * a * nx : a * nx;
      const double v = law_ == ContactLaw::POLAR ? b * b * ny : b * ny;
      rates[i] = (u * nx - v * ny) / std::sqrt(u * u + v * v);
    }
  }
}
}  // namespace hjt
