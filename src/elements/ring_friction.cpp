// SPDX-License-Identifier: BSD-3-Clause
#include "elements/ring_friction.hpp"

#include <cmath>

#include "gear/angle.hpp"
#include "gear/block_sums.hpp"
#include "gear/vector_clones.hpp"

namespace hjt
{
void MeshFriction::addTerms(const ToothMesh& mesh, const ToothMesh::Scratch& found, const RingRates& rates,
                            const Eigen::Vector2d& speeds, JointFriction& friction) const noexcept
{
  const int first = friction.terms.size();
  friction.flanks = 0;
  for (const FlankContact& contact : found.flanks)
  {
    const double force = found.flank_force[contact.tooth];
    if (force == 0.0)
    {
      continue;
    }
    const Eigen::Vector2d slip(mesh.slidingSpeed(rates.shape, contact, rates.by_motor, 0.0),
                               mesh.slidingSpeed(rates.shape, contact, rates.by_output, 1.0));
    double factor = tooth_factor_[contact.tooth];
    if (rates.shape.copies() > 1)
    {
      factor += tooth_factor_[contact.tooth + rates.shape.solved];  // it slides alike
    }
    friction.flank_load[friction.flanks++] = factor * std::abs(force);
    friction.terms.push_back({ 0.0, slip });
  }
  setStrengths(first, speeds, friction);
}

void MeshFriction::setStrengths(int first, const Eigen::Vector2d& speeds, JointFriction& friction) const noexcept
{
  for (int i = 0; i < friction.flanks; ++i)
  {
    const Eigen::Vector2d slip = friction.terms[first + i].slip;
    friction.terms.setStrength(first + i, coefficient(slip.dot(speeds)) * friction.flank_load[i]);
  }
}

HJT_VECTOR_CLONES double InterfaceFriction::torque(const RingShape& shape, const WaveGeneratorContact::Scratch& found,
                                                   const Eigen::VectorXd& rates) const noexcept
{
  const int n = shape.solved;
  const double* point = shape.points.data();
  const double* force = found.force.data();
  const double* rate = rates.data();
  const auto lost = [&](int h, int i, int j)
  {
    const double x = point[2 * j] - point[2 * h];
    const double y = point[2 * j + 1] - point[2 * h + 1];
    const double across = y * (rate[2 * j] - rate[2 * h]) - x * (rate[2 * j + 1] - rate[2 * h + 1]);
    return force[i] * std::abs(across) / (x * x + y * y);  // by the rate at which the chord tilts
  };
  const double ends = lost(shape.previous(0), 0, 1) + lost(n - 2, n - 1, shape.next(n - 1));
  const double sum = ends + blockSum(1, n - 2, [&](int i) { return lost(i - 1, i, i + 1); });
  return coefficient_ * slip_lever_ * shape.copies() * sum;
}

/// (pi / 2) sum_i |M_i dkappa_i/dtheta| [N.m].
HJT_VECTOR_CLONES double FlexingLoss::bendingRate(const RingShape& shape, const Eigen::VectorXd& moment,
                                                  const Eigen::VectorXd& rates) noexcept
{
  const int n = shape.teeth();
  const double* direction = shape.directions.data();
  const double* length = shape.lengths.data();
  const double* rate = rates.data();
  const double* moments = moment.data();
  const auto turning = [&](int i, int j)
  {
    const double across =
        direction[2 * i] * (rate[2 * j + 1] - rate[2 * i + 1]) - direction[2 * i + 1] * (rate[2 * j] - rate[2 * i]);
    return across / length[i];  // of the segment from tooth i to tooth j
  };
  const double ends = std::abs(moments[0] * (turning(0, 1) - turning(n - 1, 0))) +
                      std::abs(moments[n - 1] * (turning(n - 1, 0) - turning(n - 2, n - 1)));
  const double sum =
      ends + blockSum(1, n - 2, [&](int i) { return std::abs(moments[i] * (turning(i, i + 1) - turning(i - 1, i))); });
  return 0.25 * TWO_PI * sum;
}
}  // namespace hjt
