// SPDX-License-Identifier: BSD-3-Clause
#include "elements/wave_generator_contact.hpp"

#include <cmath>

#include "elements/contact_laws.hpp"
#include "gear/angle.hpp"
#include "gear/vector_loops.hpp"

namespace hjt
{
namespace
{
/// Foot of the normal by the approximation of the thesis, in the axes of the ellipse.
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

/// Stiffness k_i of the support of each tooth, see WaveGeneratorContact.
double supportStiffness(const Parameters& parameters) noexcept
{
  return parameters.contact.support == SupportKind::SPRINGS ?
             parameters.contact.stiffness :
             hertzStiffness(parameters.bearing.ball_diameter) * parameters.bearing.balls /
                 parameters.gear.teeth_flexspline;
}
}  // namespace

SingleBalls::SingleBalls(double stiffness, int teeth) : stiffness_(stiffness), tooth_pitch_(TWO_PI / teeth) {}

double SingleBalls::press(const RaceDeflection& bearing, double wave_generator_angle, const Eigen::VectorXd& depth,
                          Scratch& scratch, Eigen::VectorXd& force, double& torque) const noexcept
{
  const auto teeth = static_cast<int>(depth.size());
  const double rate = bearing.cageRate() / tooth_pitch_;
  double energy = 0.0;
  force.setZero();
  for (int b = 0; b < bearing.balls(); ++b)
  {
    Ball& ball = scratch.balls[static_cast<std::size_t>(b)];
    const double place = std::remainder(bearing.ballPlace(b, wave_generator_angle), TWO_PI) / tooth_pitch_;
    const double nearest = std::round(place);
    const double t = place - nearest;
    const int middle = (static_cast<int>(nearest) + teeth) % teeth;
    ball.tooth = { (middle + teeth - 1) % teeth, middle, (middle + 1) % teeth };
    ball.weight = { 0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t) };
    ball.rate = { (t - 0.5) * rate, -2.0 * t * rate, (t + 0.5) * rate };
    ball.second = { rate * rate, -2.0 * rate * rate, rate * rate };
    ball.drop = bearing.drop(b, wave_generator_angle);
    double pressed = -ball.drop.value;
    double along = -ball.drop.rate;
    for (std::size_t k = 0; k < 3; ++k)
    {
      pressed += ball.weight[k] * depth[ball.tooth[k]];
      along += ball.rate[k] * depth[ball.tooth[k]];
    }
    const HertzContact contact(pressed);
    ball.depth = pressed;
    ball.force = stiffness_ * contact.force;
    ball.slope = stiffness_ * contact.tangent;
    energy += stiffness_ * contact.energy;
    torque -= ball.force * along;
    for (std::size_t k = 0; k < 3; ++k)
    {
      force[ball.tooth[k]] += ball.weight[k] * ball.force;
    }
  }
  return energy;
}

void SingleBalls::addTangent(const RaceDeflection& bearing, const RingShape& shape, const Eigen::VectorXd& depth,
                             const Eigen::VectorXd& normal, const Scratch& scratch, RingTangent& tangent) const noexcept
{
  for (int b = 0; b < bearing.balls(); ++b)
  {
    const Ball& ball = scratch.balls[static_cast<std::size_t>(b)];
    if (ball.force == 0.0)
    {
      continue;
    }
    std::array<Eigen::Vector2d, 3> push;  // minus the derivative of the depth by each tooth point [-]
    double by_angle = -ball.drop.rate;
    double by_angle_twice = -ball.drop.second;
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int i = ball.tooth[k];
      const Eigen::Vector2d n = normal.segment<2>(2 * i);
      const double lever = shape.points[2 * i] * n.y() - shape.points[2 * i + 1] * n.x();
      push[k] = ball.weight[k] * n;
      by_angle += ball.weight[k] * lever + ball.rate[k] * depth[i];
      by_angle_twice += 2.0 * ball.rate[k] * lever + ball.second[k] * depth[i];
    }
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int i = ball.tooth[k];
      tangent.addDiagonal(i, ball.slope * push[k] * push[k].transpose());
      for (std::size_t m = k + 1; m < 3; ++m)
      {
        tangent.addPair(i, ball.tooth[m], ball.slope * push[k] * push[m].transpose());
      }
      tangent.wave_generator.segment<2>(2 * i) -=
          ball.slope * by_angle * push[k] + ball.force * ball.rate[k] * normal.segment<2>(2 * i);
    }
    tangent.wave_generator_stiffness += ball.slope * by_angle * by_angle + ball.force * by_angle_twice;
  }
}

void WaveGeneratorContact::Scratch::repeat() noexcept
{
  for (Eigen::VectorXd* values : { &force, &depth, &slope, &curvature })
  {
    repeatHalf(*values);
  }
  repeatHalfTurned(normal);
}

WaveGeneratorContact::Scratch::Scratch(int teeth)
  : SingleBalls::Scratch(teeth)
  , force(Eigen::VectorXd::Zero(teeth))
  , depth(teeth)
  , slope(teeth)
  , curvature(teeth)
  , normal(2 * teeth)
  , gap(teeth)
  , gap_rate(teeth)
  , gap_second(teeth)
{
}

WaveGeneratorContact::WaveGeneratorContact(const Parameters& parameters, const ToothRing& rest)
  : law_(parameters.contact.law)
  , support_(parameters.contact.support)
  , smoothing_(parameters.contact.smoothing)
  , mean_radius_(parameters.gear.flexspline_inner_radius + raceFit(parameters))
  , ellipticity_(parameters.manufacture.wave_generator_ellipticity)
  , centre_x_(parameters.manufacture.wave_generator_eccentricity[0])
  , centre_y_(parameters.manufacture.wave_generator_eccentricity[1])
  , stiffness_(Eigen::VectorXd::Constant(rest.teeth(), supportStiffness(parameters)))
  , gap_(Eigen::VectorXd::Zero(rest.teeth()))
  , bearing_(parameters.bearing)
  , single_balls_(hertzStiffness(parameters.bearing.ball_diameter), rest.teeth())
{
}

void WaveGeneratorContact::wear(double lobe, double other_lobe) noexcept
{
  const double quarter = 0.25 * (lobe + other_lobe);
  mean_radius_ -= quarter;
  ellipticity_ -= quarter;
  centre_x_ -= 0.5 * (lobe - other_lobe);
}

Eigen::Vector2d WaveGeneratorContact::centre(const DrivePosition& position) const noexcept
{
  const double c = std::cos(position.wave_generator_angle);
  const double s = std::sin(position.wave_generator_angle);
  return { c * centre_x_ - s * centre_y_, s * centre_x_ + c * centre_y_ };
}

/// Computes the foot of the normal from each tooth point to the ellipse, in the axes of the housing.
HJT_VECTOR_CLONES void WaveGeneratorContact::findFeet(const RingShape& shape, const DrivePosition& position,
                                                      Scratch& scratch) const noexcept
{
  const double c = std::cos(position.wave_generator_angle);
  const double s = std::sin(position.wave_generator_angle);
  const double amplitude = position.wave_amplitude + ellipticity_;
  const double a = mean_radius_ + amplitude;
  const double b = mean_radius_ - amplitude;
  const double centre_x = centre_x_;
  const double centre_y = centre_y_;
  const int n = shape.solved;
  const double* __restrict__ point = shape.points.data();
  double* __restrict__ normal = scratch.normal.data();
  double* __restrict__ depth = scratch.depth.data();
  double* __restrict__ curvature = scratch.curvature.data();
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
  double far = 0.0;  // number of teeth far from the ellipse; a double, so that the compiler vectorises the loop
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

/// Writes the sum of gap and sag of the faulty bearing, with its derivatives, to `scratch`.
void WaveGeneratorContact::addSag(const DrivePosition& position, Scratch& scratch) const noexcept
{
  bearing_.at(position.wave_generator_angle, scratch.gap, scratch.gap_rate, scratch.gap_second);
  scratch.gap += gap_;
}

/// Computes the force of each solved tooth on its spring or its share of the balls. @returns the energy [J].
HJT_VECTOR_CLONES double WaveGeneratorContact::press(int solved, Scratch& scratch) const noexcept
{
  const double smoothing = smoothing_;
  // A lambda that is not inlined would be compiled for the baseline processor only.
  const auto press_by = [&](const auto& law) __attribute__((always_inline))
  {
    const double* __restrict__ stiffness = stiffness_.data();
    const double* __restrict__ gap = gapOf(scratch);
    double* __restrict__ depth = scratch.depth.data();
    double* __restrict__ force = scratch.force.data();
    double* __restrict__ slope = scratch.slope.data();
    const auto press_tooth = [&](int i)
    {
      const double pressed = depth[i] - gap[i];
      const auto contact = law(pressed);
      depth[i] = pressed;
      force[i] = stiffness[i] * contact.force;
      slope[i] = stiffness[i] * contact.tangent;
      return stiffness[i] * contact.energy;
    };
    return blockSum(0, solved, press_tooth);
  };
  return support_ == SupportKind::SPRINGS ? press_by([=](double depth) { return ContactRamp(depth, smoothing); }) :
                                            press_by([](double depth) { return HertzContact(depth); });
}

HJT_VECTOR_CLONES void WaveGeneratorContact::addForces(const RingShape& shape, const DrivePosition& position,
                                                       Scratch& scratch, ForceSum& sum) const noexcept
{
  findFeet(shape, position, scratch);
  if (hasSag())
  {
    addSag(position, scratch);
  }
  double torque = 0.0;
  if (isOnSingleBalls())
  {
    scratch.depth -= gap_;
    scratch.slope.setZero();
    sum.energy +=
        single_balls_.press(bearing_, position.wave_generator_angle, scratch.depth, scratch, scratch.force, torque);
  }
  else
  {
    sum.energy += press(shape.solved, scratch);
  }
  const int n = shape.solved;
  const double* __restrict__ point = shape.points.data();
  const double* __restrict__ normal = scratch.normal.data();
  const double* __restrict__ contact_force = scratch.force.data();
  double* __restrict__ teeth = sum.teeth.data();
  const auto push_tooth = [&](int i)
  {
    const double force = contact_force[i];
    const double nx = normal[2 * i];
    const double ny = normal[2 * i + 1];
    teeth[2 * i] += force * nx;
    teeth[2 * i + 1] += force * ny;
    return force * (point[2 * i] * ny - point[2 * i + 1] * nx);
  };
  torque -= blockSum(0, n, push_tooth);
  if (hasSag())
  {
    torque += scratch.force.dot(scratch.gap_rate);
  }
  sum.wave_generator_torque += torque;
}

/// Adds the tangent of each solved tooth; that of a tooth out of contact is zero, like its force and stiffness.
HJT_VECTOR_CLONES void WaveGeneratorContact::addTangent(const RingShape& shape, const Scratch& scratch,
                                                        RingTangent& tangent) const noexcept
{
  const int n = shape.solved;
  const double* __restrict__ point = shape.points.data();
  const double* __restrict__ slope = scratch.slope.data();
  const double* __restrict__ gap = gapOf(scratch);
  const double* __restrict__ depth = scratch.depth.data();
  const double* __restrict__ normal = scratch.normal.data();
  const double* __restrict__ curvature = scratch.curvature.data();
  const double* __restrict__ contact_force = scratch.force.data();
  double* __restrict__ xx = tangent.diagonal.xx.data();
  double* __restrict__ xy = tangent.diagonal.xy.data();
  double* __restrict__ yy = tangent.diagonal.yy.data();
  double* __restrict__ by_angle = tangent.wave_generator.data();
  const auto add_tooth = [&](int i)
  {
    const double x = point[2 * i];
    const double y = point[2 * i + 1];
    const double nx = normal[2 * i];
    const double ny = normal[2 * i + 1];
    const double force = contact_force[i];
    const double stiffness = slope[i];
    // turn of normal and force for a motion of the tooth point along the surface [rad/m]
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
    return along * lever + sideways * reach;
  };
  double by_angle_twice = blockSum(0, n, add_tooth);
  if (hasSag())
  {
    // The gap depends on the wave generator's angle alone.
    for (int i = 0; i < n; ++i)
    {
      const double stiffness = slope[i];
      const double nx = normal[2 * i];
      const double ny = normal[2 * i + 1];
      const double lever = point[2 * i] * ny - point[2 * i + 1] * nx;
      const double rate = scratch.gap_rate[i];
      by_angle[2 * i] += stiffness * rate * nx;
      by_angle[2 * i + 1] += stiffness * rate * ny;
      by_angle_twice += stiffness * rate * (rate - 2.0 * lever) - contact_force[i] * scratch.gap_second[i];
    }
  }
  tangent.wave_generator_stiffness += by_angle_twice;
  if (isOnSingleBalls())
  {
    single_balls_.addTangent(bearing_, shape, scratch.depth, scratch.normal, scratch, tangent);
  }
}

void WaveGeneratorContact::surfaceByAmplitude(const DrivePosition& position, const Scratch& scratch,
                                              Eigen::VectorXd& rates) const noexcept
{
  const double c = std::cos(position.wave_generator_angle);
  const double s = std::sin(position.wave_generator_angle);
  const double a = mean_radius_ + position.wave_amplitude + ellipticity_;
  const double b = mean_radius_ - position.wave_amplitude - ellipticity_;
  for (Eigen::Index i = 0; i < rates.size(); ++i)
  {
    rates[i] = 0.0;
    if (scratch.force[i] > 0.0)
    {
      const double nx = c * scratch.normal[2 * i] + s * scratch.normal[2 * i + 1];
      const double ny = c * scratch.normal[2 * i + 1] - s * scratch.normal[2 * i];
      // The point on the surface is (a u, b v) with a unit vector (u, v). Its derivative by the amplitude is (u, -v).
      const double u = law_ == ContactLaw::POLAR ? a * a * nx : a * nx;
      const double v = law_ == ContactLaw::POLAR ? b * b * ny : b * ny;
      rates[i] = (u * nx - v * ny) / std::sqrt(u * u + v * v);
    }
  }
}
}  // namespace hjt
