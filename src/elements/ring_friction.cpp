// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/elements/ring_friction.hpp"

#include <cmath>

namespace hjt
{
void MeshFriction::addTerms(const ToothMesh& mesh, const RingShape& shape, const DrivePosition& position,
                            const RingForces& forces, const RingRates& rates, const Eigen::Vector2d& speeds,
                            JointFriction& friction) const noexcept
{
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const double force = forces.flank_force[i];
    if (force == 0.0)
    {
      continue;
    }
    const bool leading = force > 0.0;
    const Eigen::Vector2d slip(mesh.slidingSpeed(shape, position, i, rates.by_motor, 0.0, leading),
                               mesh.slidingSpeed(shape, position, i, rates.by_output, 1.0, leading));
    friction.terms.push_back({ coefficient(slip.dot(speeds)) * std::abs(force), slip });
  }
}

double InterfaceFriction::torque(const RingShape& shape, const RingForces& forces,
                                 const Eigen::VectorXd& rates) const noexcept
{
  double sum = 0.0;
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const int j = shape.next(i);
    const int h = shape.previous(i);
    const Chord chord = shape.chord(i);
    const double tilt =
        (chord.normal.x() * (rates[2 * j] - rates[2 * h]) + chord.normal.y() * (rates[2 * j + 1] - rates[2 * h + 1])) /
        chord.length;
    sum += forces.contact_force[i] * std::abs(tilt);
  }
  return parameters_.friction_coefficient * parameters_.slip_lever * sum;
}
}  // namespace hjt
