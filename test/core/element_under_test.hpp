// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <functional>

#include "ring_fixture.hpp"

namespace hjt
{
/// One element of the ring, or all of them, behind the one interface the tests need.
struct ElementUnderTest
{
  using Shape = const RingShape&;
  using Position = const DrivePosition&;

  std::function<void(Shape, Position, RingForces&)> add_forces;
  std::function<void(Shape, const RingForces&, RingTangent&)> add_tangent;

  RingForces forces(Shape shape, Position position) const
  {
    RingForces forces(shape.teeth());
    forces.setZero(shape.teeth());
    add_forces(shape, position, forces);
    return forces;
  }

  RingTangent tangent(Shape shape, Position position) const
  {
    RingTangent tangent(shape.teeth());
    tangent.setZero();
    add_tangent(shape, forces(shape, position), tangent);
    return tangent;
  }
};

template <class Element>
ElementUnderTest elementOf(const RingModel& model)
{
  return { [&model](auto& shape, auto& position, RingForces& forces)
           { model.of<Element>().addForces(shape, position, forces.of<Element>(), forces); },
           [&model](auto& shape, const RingForces& forces, auto& tangent)
           { model.of<Element>().addTangent(shape, forces.of<Element>(), tangent); } };
}

/// The ring's coordinates in one row: 2 N of the tooth points [m], wave generator angle, output angle [rad].
/// Central differences along each of them.
struct FiniteDifference
{
  Eigen::VectorXd gradient;  ///< of the energy
  Eigen::MatrixXd hessian;   ///< minus the derivative of all forces; row: force, column: coordinate
};

inline Eigen::VectorXd allForces(const RingForces& forces)
{
  Eigen::VectorXd all(forces.teeth.size() + 2);
  all << forces.teeth, forces.wave_generator_torque, forces.output_torque;
  return all;
}

inline FiniteDifference differentiate(const ElementUnderTest& element, RingShape shape, DrivePosition position)
{
  // The truncation error falls with the square of the step, rounding grows with its inverse; at these steps both stay
  // below 1e-7 of the largest value, whichever element.
  constexpr double POINT_STEP = 2e-9;  // m
  constexpr double ANGLE_STEP = 1e-7;  // rad
  const Eigen::Index size = shape.points.size() + 2;
  FiniteDifference result{ Eigen::VectorXd(size), Eigen::MatrixXd(size, size) };
  for (Eigen::Index k = 0; k < size; ++k)
  {
    const bool point = k < size - 2;
    double& coordinate = point         ? shape.points[k] :
                         k == size - 2 ? position.wave_generator_angle :
                                         position.output_angle;
    const double middle = coordinate;
    const double step = point ? POINT_STEP : ANGLE_STEP;
    coordinate = middle + step;
    const double upper = coordinate;
    shape.updateGeometry();
    const RingForces after = element.forces(shape, position);
    coordinate = middle - step;
    const double width = upper - coordinate;
    shape.updateGeometry();
    const RingForces before = element.forces(shape, position);
    coordinate = middle;
    result.gradient[k] = (after.energy - before.energy) / width;
    result.hessian.col(k) = (allForces(before) - allForces(after)) / width;
  }
  return result;
}

// Differences of forces and energies carry some 1e-8 of the largest (see differentiate); a wrong factor, sign or a
// missing term shows as 1e-3 or more.
constexpr double DIFFERENCE_TOLERANCE = 2e-6;

/// Largest difference between two arrays over the largest value of either.
inline double relativeError(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b)
{
  const double scale = std::max(a.lpNorm<Eigen::Infinity>(), b.lpNorm<Eigen::Infinity>());
  return scale > 0.0 ? (a - b).lpNorm<Eigen::Infinity>() / scale : 0.0;
}

/// Checks the force and the tangent an element gives against differences of its energy and its forces.
inline void expectGradientAndTangent(const ElementUnderTest& element, const RingShape& shape,
                                     const DrivePosition& position)
{
  const Eigen::Index n = shape.points.size();
  const RingForces forces = element.forces(shape, position);
  const RingTangent tangent = element.tangent(shape, position);
  const FiniteDifference numeric = differentiate(element, shape, position);
  EXPECT_LT(relativeError(-numeric.gradient.head(n), forces.teeth), DIFFERENCE_TOLERANCE);
  // The torques are sums of forces of either sign with levers of some 2 w or more.
  const double torque_scale = forces.teeth.lpNorm<1>() * 0.7e-3;
  EXPECT_NEAR(-numeric.gradient[n], forces.wave_generator_torque, DIFFERENCE_TOLERANCE * torque_scale);
  EXPECT_NEAR(-numeric.gradient[n + 1], forces.output_torque, DIFFERENCE_TOLERANCE * torque_scale);

  EXPECT_LT(relativeError(numeric.hessian.topLeftCorner(n, n), denseTangent(tangent)), DIFFERENCE_TOLERANCE);
  EXPECT_LT(relativeError(numeric.hessian.col(n).head(n), tangent.wave_generator), DIFFERENCE_TOLERANCE);
  EXPECT_LT(relativeError(numeric.hessian.col(n + 1).head(n), tangent.output), DIFFERENCE_TOLERANCE);
  EXPECT_LT(relativeError(numeric.hessian.row(n).head(n).transpose(), tangent.wave_generator), DIFFERENCE_TOLERANCE);
  EXPECT_LT(relativeError(numeric.hessian.row(n + 1).head(n).transpose(), tangent.output), DIFFERENCE_TOLERANCE);
  Eigen::Matrix2d angles;
  angles << tangent.wave_generator_stiffness, 0.0, 0.0, tangent.output_stiffness;
  EXPECT_LT(relativeError(numeric.hessian.bottomRightCorner(2, 2), angles), DIFFERENCE_TOLERANCE);
}
}  // namespace hjt
