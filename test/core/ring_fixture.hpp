// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "elements/ring_sums.hpp"
#include "gear/ring_shape.hpp"
#include "model/ring_model.hpp"
#include "solver/ring_equilibrium.hpp"
#include "test/support/seeded_random.hpp"

namespace hjt
{
/// Shape of an inextensible ring pressed on the wave generator, to leading order in w (thesis ch. 6):
/// radially w cos 2a, along the rim -(w/2) sin 2a, a the angle from the major axis; turned by `twist` as a whole.
inline void pressOnWaveGenerator(const ToothRing& rest, const DrivePosition& position, double twist, RingShape& shape)
{
  const double radius = rest.points().head<2>().norm();
  for (int i = 0; i < rest.teeth(); ++i)
  {
    const double psi = i * rest.pitchAngle();
    const double around = 2.0 * (psi + twist - position.wave_generator_angle);
    const double r = radius + position.wave_amplitude * std::cos(around);
    const double angle = psi + twist - 0.5 * position.wave_amplitude / radius * std::sin(around);
    shape.points.segment<2>(2 * i) << r * std::cos(angle), r * std::sin(angle);
  }
  shape.updateGeometry();
}

/// Moves every coordinate of every tooth point by up to `amplitude` [m].
inline void shake(double amplitude, SeededRandom& random, RingShape& shape)
{
  for (Eigen::Index k = 0; k < shape.points.size(); ++k)
  {
    shape.points[k] += random.uniform(-amplitude, amplitude);
  }
  shape.updateGeometry();
}

/// The tooth part of a tangent, the cup's included, as a full matrix.
inline Eigen::MatrixXd denseTangent(const RingTangent& tangent)
{
  const int teeth = tangent.teeth();
  Eigen::MatrixXd dense = tangent.cup_stiffness * tangent.cup_direction * tangent.cup_direction.transpose();
  const auto couple = [&](int i, int j, const Block2& block)
  {
    dense.block<2, 2>(2 * i, 2 * j) += block;
    dense.block<2, 2>(2 * j, 2 * i) += block.transpose();
  };
  for (int i = 0; i < teeth; ++i)
  {
    dense.block<2, 2>(2 * i, 2 * i) += tangent.diagonal.at(i);
    couple(i, (i + 1) % teeth, tangent.next.at(i));
    couple(i, (i + 2) % teeth, tangent.second.at(i));
  }
  return dense;
}

/// The tangent over all teeth at a ring's equilibrium.
inline RingTangent wholeTangent(const RingEquilibrium& ring)
{
  const RingShape shape = ring.shape().whole();
  RingForces forces(shape.teeth());
  ring.model().forces(shape, ring.position(), forces);
  RingTangent tangent(shape.teeth());
  ring.model().tangent(shape, forces, tangent);
  return tangent;
}

inline bool allFinite(const RingForces& forces)
{
  return forces.teeth.allFinite() && forces.of<WaveGeneratorContact>().force.allFinite() &&
         forces.of<ToothMesh>().flank_force.allFinite() && std::isfinite(forces.wave_generator_torque) &&
         std::isfinite(forces.output_torque) && std::isfinite(forces.energy);
}

/// A ring inserted into its gear.
struct InsertedRing
{
  explicit InsertedRing(const Parameters& given)
    : parameters(given), amplitude(given.gear.wave_amplitude), model(given), ring(model, given.solver)
  {
    EXPECT_TRUE(ring.insert({ 0.0, 0.0, amplitude }).ok());
  }

  SolveStatus moveTo(double wave_generator_angle, double output_angle)
  {
    return ring.moveTo({ wave_generator_angle, output_angle, amplitude });
  }

  const Parameters parameters;
  const double amplitude;  // of the wave [m]
  RingModel model;
  RingEquilibrium ring;
};

/// x, y of tooth i turned by `angle`, for every tooth.
inline Eigen::VectorXd turned(const Eigen::VectorXd& vectors, double angle)
{
  Eigen::VectorXd result(vectors.size());
  for (Eigen::Index k = 0; k < vectors.size(); k += 2)
  {
    result[k] = std::cos(angle) * vectors[k] - std::sin(angle) * vectors[k + 1];
    result[k + 1] = std::sin(angle) * vectors[k] + std::cos(angle) * vectors[k + 1];
  }
  return result;
}

/// Mirrored at the x axis: tooth i takes the place of tooth N - i.
inline Eigen::VectorXd mirrored(const Eigen::VectorXd& vectors)
{
  const Eigen::Index n = vectors.size() / 2;
  Eigen::VectorXd result(vectors.size());
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const Eigen::Index j = (n - i) % n;
    result[2 * j] = vectors[2 * i];
    result[2 * j + 1] = -vectors[2 * i + 1];
  }
  return result;
}
}  // namespace hjt
