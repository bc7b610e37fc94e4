// SPDX-License-Identifier: BSD-3-Clause
#include "elements/wave_generator_contact.hpp"

#include <algorithm>
#include <cmath>

#include "elements/contact_ramp.hpp"
#include "gear/vector_clones.hpp"

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
                                           const ManufactureParameters& manufacture, const BearingParameters& bearing)
  : law_(parameters.law)
  , smoothing_(parameters.smoothing)
  , mean_radius_(gear.flexspline_inner_radius)
  , ellipticity_(manufacture.wave_generator_ellipticity)
  , centre_x_(manufacture.wave_generator_eccentricity[0])
  , centre_y_(manufacture.wave_generator_eccentricity[1])
  , stiffness_(Eigen::VectorXd::Constant(gear.teeth_flexspline, parameters.stiffness))
  , gap_(Eigen::VectorXd::Zero(gear.teeth_flexspline))
  , bearing_(bearing)
  , made_radius_(mean_radius_)
  , made_ellipticity_(ellipticity_)
  , made_centre_x_(centre_x_)
{
}

void WaveGeneratorContact::wear(double lobe, double other_lobe) noexcept
{
  const double quarter = 0.25 * (lobe + other_lobe);
  mean_radius_ = made_radius_ - quarter;
  ellipticity_ = made_ellipticity_ - quarter;
  centre_x_ = made_centre_x_ - 0.5 * (lobe - other_lobe);
}

Eigen::Vector2d WaveGeneratorContact::centre(const DrivePosition& position) const noexcept
{
  const double c = std::cos(position.wave_generator_angle);
  const double s = std::sin(position.wave_generator_angle);
  return { c * centre_x_ - s * centre_y_, s * centre_x_ + c * centre_y_ };
}

/// Feet of the normals from all tooth points, in the housing's axes.
HJT_VECTOR_CLONES void WaveGeneratorContact::findFeet(const RingShape& shape, const DrivePosition& position,
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
  const double* __restrict__ point = shape.points.data();
  double* __restrict__ normal = forces.contact_normal.data();
  double* __restrict__ depth = forces.contact_depth.data();
  double* __restrict__ curvature = forces.contact_curvature.data();
  const auto store = [&](int i, const EllipseFoot& foot)
  {
    normal[2 * i] = c * foot.normal_x - s * foot.normal_y;
    normal[2 * i + 1] = s * foot.normal_x + c * foot.normal_y;
    depth[i] = foot.depth;
    curvature[i] = foot.curvature;
  };
  const auto own_x = [&](int i) { return c * point[2 * i] + s * point[2 * i + 1] - centre_x; };
  const auto own_y = [&](int i) { return c * point[2 * i + 1] - s * point[2 * i] - centre_y; };
  if (law_ == ContactLaw::POLAR)
  {
    for (int i = 0; i < n; ++i)
    {
      store(i, polarPoint(a, b, own_x(i), own_y(i)));
    }
    return;
  }
  double far = 0.0;  // teeth; as wide as the other numbers, for the vectors
#pragma omp simd reduction(+ : far)
  for (int i = 0; i < n; ++i)
  {
    const double x = own_x(i);
    const double y = own_y(i);
    store(i, closestPointNear(a, b, x, y));
    far += isNear(a, b, x, y) ? 0.0 : 1.0;
  }
  if (far > 0.0)
  {
    for (int i = 0; i < n; ++i)
    {
      store(i, closestPoint(a, b, own_x(i), own_y(i)));
    }
  }
}

/// The gap with the sag of the faulty bearing, left in `forces`.
void WaveGeneratorContact::addSag(const DrivePosition& position, RingForces& forces) const noexcept
{
  bearing_.at(position.wave_generator_angle, forces.gap, forces.gap_rate, forces.gap_second);
  forces.gap += gap_;
}

HJT_VECTOR_CLONES void WaveGeneratorContact::addForces(const RingShape& shape, const DrivePosition& position,
                                                       RingForces& forces) const noexcept
{
  findFeet(shape, position, forces);
  if (!bearing_.sound())
  {
    addSag(position, forces);
  }
  const int n = shape.teeth();
  const double* __restrict__ point = shape.points.data();
  const double* __restrict__ stiffness = stiffness_.data();
  const double* __restrict__ gap = gapOf(forces);
  double* __restrict__ depth = forces.contact_depth.data();
  const double* __restrict__ normal = forces.contact_normal.data();
  double* __restrict__ contact_force = forces.contact_force.data();
  double* __restrict__ teeth = forces.teeth.data();
  const double smoothing = smoothing_;
  double torque = 0.0;
  double energy = 0.0;
#pragma omp simd reduction(+ : torque, energy)
  for (int i = 0; i < n; ++i)
  {
    const double pressed = depth[i] - gap[i];
    depth[i] = pressed;
    const ContactRamp ramp(pressed, smoothing);
    const double force = stiffness[i] * ramp.force;
    const double nx = normal[2 * i];
    const double ny = normal[2 * i + 1];
    contact_force[i] = force;
    teeth[2 * i] += force * nx;
    teeth[2 * i + 1] += force * ny;
    torque -= force * (point[2 * i] * ny - point[2 * i + 1] * nx);
    energy += stiffness[i] * ramp.energy;
  }
  if (!bearing_.sound())
  {
    torque += forces.contact_force.dot(forces.gap_rate);
  }
  forces.wave_generator_torque += torque;
  forces.energy += energy;
}

/// A tooth out of contact has neither force nor stiffness and adds nothing.
HJT_VECTOR_CLONES void WaveGeneratorContact::addTangent(const RingShape& shape, const RingForces& forces,
                                                        RingTangent& tangent) const noexcept
{
  const int n = shape.teeth();
  const double* __restrict__ point = shape.points.data();
  const double* __restrict__ tooth_stiffness = stiffness_.data();
  const double* __restrict__ gap = gapOf(forces);
  const double* __restrict__ depth = forces.contact_depth.data();
  const double* __restrict__ normal = forces.contact_normal.data();
  const double* __restrict__ curvature = forces.contact_curvature.data();
  const double* __restrict__ contact_force = forces.contact_force.data();
  double* __restrict__ xx = tangent.diagonal.xx.data();
  double* __restrict__ xy = tangent.diagonal.xy.data();
  double* __restrict__ yy = tangent.diagonal.yy.data();
  double* __restrict__ by_angle = tangent.wave_generator.data();
  const double smoothing = smoothing_;
  double sum = 0.0;
#pragma omp simd reduction(+ : sum)
  for (int i = 0; i < n; ++i)
  {
    const double x = point[2 * i];
    const double y = point[2 * i + 1];
    const double nx = normal[2 * i];
    const double ny = normal[2 * i + 1];
    const double force = contact_force[i];
    const double stiffness = tooth_stiffness[i] * ContactRamp(depth[i], smoothing).tangent;
    // The normal turns with the point at this rate; the force follows it.
    const double turn = curvature[i] / (1.0 - curvature[i] * (depth[i] + gap[i]));
    const double across = -force * turn;
    xx[i] += stiffness * nx * nx + across * ny * ny;
    xy[i] += (stiffness - across) * nx * ny;
    yy[i] += stiffness * ny * ny + across * nx * nx;

    const double lever = x * ny - y * nx;
    const double reach = x * nx + y * ny;
    const double along = stiffness * lever;
    const double sideways = force * (1.0 - turn * reach);
    by_angle[2 * i] -= along * nx - sideways * ny;
    by_angle[2 * i + 1] -= along * ny + sideways * nx;
    sum += along * lever + sideways * reach;
  }
  if (!bearing_.sound())
  {
    // The gap changes with the wave generator's angle alone.
    for (int i = 0; i < n; ++i)
    {
      const double stiffness = tooth_stiffness[i] * ContactRamp(depth[i], smoothing).tangent;
      const double nx = normal[2 * i];
      const double ny = normal[2 * i + 1];
      const double lever = point[2 * i] * ny - point[2 * i + 1] * nx;
      const double rate = forces.gap_rate[i];
      by_angle[2 * i] += stiffness * rate * nx;
      by_angle[2 * i + 1] += stiffness * rate * ny;
      sum += stiffness * rate * (rate - 2.0 * lever) - contact_force[i] * forces.gap_second[i];
    }
  }
  tangent.wave_generator_stiffness += sum;
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
