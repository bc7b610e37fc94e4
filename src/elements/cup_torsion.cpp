// SPDX-License-Identifier: BSD-3-Clause
#include "elements/cup_torsion.hpp"

#include <cmath>

#include "gear/angle.hpp"
#include "gear/vector_loops.hpp"

namespace hjt
{
CupTorsion::CupTorsion(const Parameters& parameters, const ToothRing& rest)
  : wall_compliance_(1.0 / parameters.cup.wall_stiffness)
  , slopes_(parameters.cup.torsion_stiffness)
  , torques_(parameters.cup.torsion_breakpoints)
  , rest_radial_(rest.radial())
{
  placeBreakpoints();
}

void CupTorsion::scaleWall(double factor) noexcept
{
  const double added = wall_compliance_ * (1.0 / factor - 1.0);
  wall_compliance_ += added;
  for (double& slope : slopes_)
  {
    slope /= 1.0 + slope * added;
  }
  placeBreakpoints();
}

void CupTorsion::placeBreakpoints() noexcept
{
  for (std::size_t i = 0; i < slopes_.size(); ++i)
  {
    compliances_[i] = 1.0 / slopes_[i];
  }
  rotations_[0] = torques_[0] / slopes_[0];
  rotations_[1] = rotations_[0] + (torques_[1] - torques_[0]) / slopes_[1];
}

HJT_VECTOR_CLONES double CupTorsion::meanRotation(const RingShape& shape) const noexcept
{
  const int n = shape.solved;
  const double* __restrict__ rest = rest_radial_.data();
  const double* __restrict__ point = shape.points.data();
  const auto along = [&](int i) { return rest[2 * i] * point[2 * i] + rest[2 * i + 1] * point[2 * i + 1]; };
  const auto across = [&](int i) { return rest[2 * i] * point[2 * i + 1] - rest[2 * i + 1] * point[2 * i]; };
  const auto small_angles = [&](int i, auto& rows, int k)
  {
    rows[0][k] = smallAngle(across(i) / along(i));
    // The count of large angles is a double like the sums, so that the compiler vectorises the loop.
    rows[1][k] = std::abs(across(i)) < SMALL_TANGENT * along(i) ? 0.0 : 1.0;
  };
  auto [sum, large] = blockSums<2>(0, n, small_angles);
  if (large > 0.0)
  {
    sum = 0.0;
    for (int i = 0; i < n; ++i)
    {
      sum += smallAngle(across(i), along(i));
    }
  }
  return sum / n;
}

HJT_VECTOR_CLONES double CupTorsion::meanRotationRate(const RingShape& shape, const Eigen::VectorXd& speeds) noexcept
{
  const int n = shape.solved;
  const double* __restrict__ point = shape.points.data();
  const double* __restrict__ speed = speeds.data();
  const auto rotation_rate = [&](int i)
  {
    const double x = point[2 * i];
    const double y = point[2 * i + 1];
    return (x * speed[2 * i + 1] - y * speed[2 * i]) / (x * x + y * y);
  };
  return blockSum(0, n, rotation_rate) / n;
}

double CupTorsion::torque(double rotation) const noexcept
{
  const double size = std::abs(rotation);
  double torque = slopes_[0] * size;
  if (size > rotations_[1])
  {
    torque = torques_[1] + slopes_[2] * (size - rotations_[1]);
  }
  else if (size > rotations_[0])
  {
    torque = torques_[0] + slopes_[1] * (size - rotations_[0]);
  }
  return std::copysign(torque, rotation);
}

double CupTorsion::rotationAtTorque(double torque) const noexcept
{
  const double size = std::abs(torque);
  double rotation = size * compliances_[0];
  if (size > torques_[1])
  {
    rotation = rotations_[1] + (size - torques_[1]) * compliances_[2];
  }
  else if (size > torques_[0])
  {
    rotation = rotations_[0] + (size - torques_[0]) * compliances_[1];
  }
  return std::copysign(rotation, torque);
}

double CupTorsion::storedEnergy(double rotation) const noexcept
{
  const double size = std::abs(rotation);
  const double end = torque(size);
  if (size <= rotations_[0])
  {
    return 0.5 * end * size;
  }
  double energy = 0.5 * torques_[0] * rotations_[0];
  if (size <= rotations_[1])
  {
    return energy + 0.5 * (torques_[0] + end) * (size - rotations_[0]);
  }
  energy += 0.5 * (torques_[0] + torques_[1]) * (rotations_[1] - rotations_[0]);
  return energy + 0.5 * (torques_[1] + end) * (size - rotations_[1]);
}

double CupTorsion::stiffness(double rotation) const noexcept
{
  const double size = std::abs(rotation);
  return size > rotations_[1] ? slopes_[2] : size > rotations_[0] ? slopes_[1] : slopes_[0];
}

HJT_VECTOR_CLONES void CupTorsion::addForces(const RingShape& shape, const DrivePosition&, Scratch& scratch,
                                             ForceSum& sum) const noexcept
{
  const double rotation = meanRotation(shape);
  scratch.rotation = rotation;
  const int n = shape.solved;
  const double share = torque(rotation) / shape.teeth();
  const double* __restrict__ point = shape.points.data();
  double* __restrict__ force = sum.teeth.data();
#pragma omp simd
  for (int i = 0; i < n; ++i)
  {
    const double x = point[2 * i];
    const double y = point[2 * i + 1];
    const double scale = share / (x * x + y * y);
    force[2 * i] += scale * y;
    force[2 * i + 1] -= scale * x;
  }
  sum.energy += storedEnergy(rotation) / shape.copies();
}

HJT_VECTOR_CLONES void CupTorsion::addTangent(const RingShape& shape, const Scratch& scratch,
                                              RingTangent& tangent) const noexcept
{
  const int n = shape.solved;
  const double rotation = scratch.rotation;
  const double share = torque(rotation) / shape.teeth();
  const double part = 1.0 / shape.teeth();
  const double* __restrict__ point = shape.points.data();
  double* __restrict__ cup = tangent.cup_direction.data();
  double* __restrict__ xx = tangent.diagonal.xx.data();
  double* __restrict__ xy = tangent.diagonal.xy.data();
  double* __restrict__ yy = tangent.diagonal.yy.data();
  tangent.cup_stiffness = stiffness(rotation);
#pragma omp simd
  for (int i = 0; i < n; ++i)
  {
    const double x = point[2 * i];
    const double y = point[2 * i + 1];
    const double inverse = 1.0 / (x * x + y * y);
    cup[2 * i] = -part * y * inverse;
    cup[2 * i + 1] = part * x * inverse;
    const double scale = share * inverse * inverse;
    const double product = scale * 2.0 * x * y;
    const double difference = scale * (y * y - x * x);
    xx[i] += product;
    xy[i] += difference;
    yy[i] -= product;
  }
}
}  // namespace hjt
