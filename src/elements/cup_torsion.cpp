// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/elements/cup_torsion.hpp"

#include <cmath>

#include "harmonic_joint_twin/gear/angle.hpp"

namespace hjt
{
CupTorsion::CupTorsion(const CupParameters& parameters, const ToothRing& rest)
  : slopes_(parameters.torsion_stiffness), torques_(parameters.torsion_breakpoints), rest_radial_(rest.radial())
{
  rotations_[0] = torques_[0] / slopes_[0];
  rotations_[1] = rotations_[0] + (torques_[1] - torques_[0]) / slopes_[1];
}

double CupTorsion::meanRotation(const RingShape& shape) const noexcept
{
  double sum = 0.0;
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const double rx = rest_radial_[2 * i];
    const double ry = rest_radial_[2 * i + 1];
    const double x = shape.points[2 * i];
    const double y = shape.points[2 * i + 1];
    sum += smallAngle(rx * y - ry * x, rx * x + ry * y);
  }
  return sum / shape.teeth();
}

double CupTorsion::meanRotationRate(const RingShape& shape, const Eigen::VectorXd& speeds) noexcept
{
  double sum = 0.0;
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const double x = shape.points[2 * i];
    const double y = shape.points[2 * i + 1];
    sum += (x * speeds[2 * i + 1] - y * speeds[2 * i]) / (x * x + y * y);
  }
  return sum / shape.teeth();
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

void CupTorsion::addForces(const RingShape& shape, RingForces& forces) const noexcept
{
  const double rotation = meanRotation(shape);
  forces.cup_rotation = rotation;
  const double share = torque(rotation) / shape.teeth();
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const double x = shape.points[2 * i];
    const double y = shape.points[2 * i + 1];
    const double scale = share / (x * x + y * y);
    forces.teeth[2 * i] += scale * y;
    forces.teeth[2 * i + 1] -= scale * x;
  }
  forces.energy += storedEnergy(rotation);
}

void CupTorsion::addTangent(const RingShape& shape, const RingForces& forces, RingTangent& tangent) const noexcept
{
  const double rotation = forces.cup_rotation;
  const double share = torque(rotation) / shape.teeth();
  const double part = 1.0 / shape.teeth();
  tangent.cup_stiffness = stiffness(rotation);
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const double x = shape.points[2 * i];
    const double y = shape.points[2 * i + 1];
    const double inverse = 1.0 / (x * x + y * y);
    tangent.cup_direction[2 * i] = -part * y * inverse;
    tangent.cup_direction[2 * i + 1] = part * x * inverse;
    const double scale = share * inverse * inverse;
    Block2 block;
    block << 2.0 * x * y, y * y - x * x, y * y - x * x, -2.0 * x * y;
    tangent.addDiagonal(i, scale * block);
  }
}
}  // namespace hjt
