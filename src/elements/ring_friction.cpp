// SPDX-License-Identifier: BSD-3-Clause
#include "elements/ring_friction.hpp"

#include "elements/contact_laws.hpp"
#include "gear/angle.hpp"
#include "gear/vector_loops.hpp"

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
      factor += tooth_factor_[contact.tooth + rates.shape.solved];  // the tooth half a turn away has the same slip
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
    return force[i] * std::abs(across) / (x * x + y * y);  // normal force times rate of tilt of the chord
  };
  const double ends = lost(shape.previous(0), 0, 1) + lost(n - 2, n - 1, shape.next(n - 1));
  const double sum = ends + blockSum(1, n - 2, [&](int i) { return lost(i - 1, i, i + 1); });
  return coefficient_ * slip_lever_ * shape.copies() * sum;
}

/// Torque (pi / 2) sum_i |M_i dkappa_i/dtheta| [N.m], see FlexingLoss.
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
    return across / length[i];  // rate of turn of the segment from tooth i to tooth j
  };
  const double ends = std::abs(moments[0] * (turning(0, 1) - turning(n - 1, 0))) +
                      std::abs(moments[n - 1] * (turning(n - 1, 0) - turning(n - 2, n - 1)));
  const double sum =
      ends + blockSum(1, n - 2, [&](int i) { return std::abs(moments[i] * (turning(i, i + 1) - turning(i - 1, i))); });
  return 0.25 * TWO_PI * sum;
}

namespace
{
/// Speed of the wave generator's surface along the contact normal of a tooth, per wave generator speed [m/rad].
double surfaceLever(const RingShape& shape, const WaveGeneratorContact::Scratch& contact, int i) noexcept
{
  return shape.points[2 * i] * contact.normal[2 * i + 1] - shape.points[2 * i + 1] * contact.normal[2 * i];
}
}  // namespace

/// Damping coefficient between tooth i and the wave generator [N.s/m].
double RingDamping::contactStrength(const Contact& contact, int i) const noexcept
{
  return contact.force[i] > 0.0 ? contact_ * ContactRamp(contact.depth[i], smoothing_).tangent : 0.0;
}

HJT_VECTOR_CLONES void RingDamping::add(const Contact& contact, const RingRates& rates,
                                        JointFriction& friction) const noexcept
{
  const RingShape& shape = rates.shape;
  const int n = shape.solved;
  const double* m = rates.by_motor.data();
  const double* o = rates.by_output.data();
  const double* direction = shape.directions.data();
  const double* point = shape.points.data();
  const double* normal = contact.normal.data();
  const double* depth = contact.depth.data();
  const double smoothing = smoothing_;
  const double tension = tension_;
  const double tooth = tooth_;
  const double contact_strength = contact_;
  const auto stretch = [&](const double* rate, int i, int j) {
    return direction[2 * i] * (rate[2 * j] - rate[2 * i]) + direction[2 * i + 1] * (rate[2 * j + 1] - rate[2 * i + 1]);
  };
  const auto inward = [&](const double* rate, int i)
  { return normal[2 * i] * rate[2 * i] + normal[2 * i + 1] * rate[2 * i + 1]; };
  const double last_m = stretch(m, n - 1, shape.next(n - 1));
  const double last_o = stretch(o, n - 1, shape.next(n - 1));
  const auto by_segment = [&](int i, auto& rows, int k)
  {
    const double stretch_m = stretch(m, i, i + 1);
    const double stretch_o = stretch(o, i, i + 1);
    rows[0][k] = tension * stretch_m * stretch_m;
    rows[1][k] = tension * stretch_m * stretch_o;
    rows[2][k] = tension * stretch_o * stretch_o;
  };
  const auto by_tooth = [&](int i, auto& rows, int k)
  {
    const double dashpot = contact_strength * ContactRamp(depth[i], smoothing).tangent;
    const double surface = point[2 * i] * normal[2 * i + 1] - point[2 * i + 1] * normal[2 * i];
    const double depth_m = surface - inward(m, i);
    const double depth_o = -inward(o, i);
    rows[0][k] = dashpot * depth_m * depth_m + tooth * (m[2 * i] * m[2 * i] + m[2 * i + 1] * m[2 * i + 1]);
    rows[1][k] = dashpot * depth_m * depth_o + tooth * (m[2 * i] * o[2 * i] + m[2 * i + 1] * o[2 * i + 1]);
    rows[2][k] = dashpot * depth_o * depth_o + tooth * (o[2 * i] * o[2 * i] + o[2 * i + 1] * o[2 * i + 1]);
  };
  const auto [mm_segments, mo_segments, oo_segments] = blockSums<3>(0, n - 1, by_segment);
  const auto [mm_teeth, mo_teeth, oo_teeth] = blockSums<3>(0, n, by_tooth);
  const double mm = tension * last_m * last_m + mm_segments + mm_teeth;
  const double mo = tension * last_m * last_o + mo_segments + mo_teeth;
  const double oo = tension * last_o * last_o + oo_segments + oo_teeth;
  const double copies = shape.copies();
  friction.viscous(0, 0) += copies * mm;
  friction.viscous(0, 1) += copies * mo;
  friction.viscous(1, 0) += copies * mo;
  friction.viscous(1, 1) += copies * oo;
}

HJT_VECTOR_CLONES DashpotPower RingDamping::addForces(const RingShape& shape, const Contact& contact,
                                                      const Eigen::VectorXd& speeds, const Eigen::VectorXd& growth,
                                                      Eigen::VectorXd& force) const noexcept
{
  const int n = shape.teeth();
  const double* __restrict__ speed = speeds.data();
  const double* __restrict__ direction = shape.directions.data();
  const double* __restrict__ point = shape.points.data();
  const double* __restrict__ normal = contact.normal.data();
  const double* __restrict__ depth = contact.depth.data();
  const double* __restrict__ pressed = contact.force.data();
  const double* __restrict__ grows = growth.data();
  double* __restrict__ out = force.data();
  const double tension = tension_;
  const double tooth = tooth_;
  const double dashpot = contact_;
  const double smoothing = smoothing_;
  const double turning = speed[2 * n];
  const auto stretch_rate = [&](int i, int j)
  {
    return direction[2 * i] * (speed[2 * j] - speed[2 * i]) +
           direction[2 * i + 1] * (speed[2 * j + 1] - speed[2 * i + 1]);
  };
  // Each tooth adds the forces of its two segments to its own entry, so that no two teeth write to the same entry.
  const auto add_segments = [&](int before, int i, int after)
  {
    const double rate = stretch_rate(i, after);
    const double pull = tension * rate;
    const double pull_before = tension * stretch_rate(before, i);
    out[2 * i] += pull * direction[2 * i] - pull_before * direction[2 * before];
    out[2 * i + 1] += pull * direction[2 * i + 1] - pull_before * direction[2 * before + 1];
    return pull * rate;
  };
  const double ends = add_segments(n - 1, 0, 1) + add_segments(n - 2, n - 1, 0);
  const double by_segments = blockSum(1, n - 2, [&](int i) { return add_segments(i - 1, i, i + 1); });
  const auto add_contact = [&](int i, auto& rows, int k)
  {
    const double vx = speed[2 * i];
    const double vy = speed[2 * i + 1];
    const double strength = pressed[i] > 0.0 ? dashpot * ContactRamp(depth[i], smoothing).tangent : 0.0;
    const double lever = point[2 * i] * normal[2 * i + 1] - point[2 * i + 1] * normal[2 * i];
    const double rate = lever * turning + grows[i] - normal[2 * i] * vx - normal[2 * i + 1] * vy;
    const double push = strength * rate;
    out[2 * i] += push * normal[2 * i] - tooth * vx;
    out[2 * i + 1] += push * normal[2 * i + 1] - tooth * vy;
    rows[0][k] = push * lever;
    rows[1][k] = push * rate + tooth * (vx * vx + vy * vy);
    rows[2][k] = push * grows[i];
  };
  const auto [torque, by_teeth, supplied] = blockSums<3>(0, n, add_contact);
  out[2 * n] -= torque;  // reaction on the wave generator
  return { ends + by_segments + by_teeth, supplied };
}

void RingDamping::addTangent(const RingShape& shape, const Contact& contact, double scale,
                             RingTangent& tangent) const noexcept
{
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const int j = shape.next(i);
    const Eigen::Vector2d along = shape.directions.segment<2>(2 * i);
    const Block2 stretch = scale * tension_ * along * along.transpose();
    const Eigen::Vector2d normal = contact.normal.segment<2>(2 * i);
    const double strength = scale * contactStrength(contact, i);
    const double lever = surfaceLever(shape, contact, i);
    tangent.addDiagonal(i, scale * tooth_ * Block2::Identity() + stretch + strength * normal * normal.transpose());
    tangent.addDiagonal(j, stretch);
    tangent.addPair(i, j, -stretch);
    tangent.wave_generator.segment<2>(2 * i) -= strength * lever * normal;
    tangent.wave_generator_stiffness += strength * lever * lever;
  }
}
}  // namespace hjt
