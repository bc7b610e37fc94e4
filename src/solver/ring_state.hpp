// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <Eigen/Core>

#include "model/ring_model.hpp"

namespace hjt
{
/// Vectorised loops over the coordinates of the first `teeth` teeth, which the solver calls in every step. All vectors
/// of a call have equal size and must be different objects.
namespace ring_vectors
{
/// Largest absolute value; NaN if any value is not finite.
double largest(const Eigen::VectorXd& values, int teeth) noexcept;

/// result = start + length * step.
void addScaled(const Eigen::VectorXd& start, double length, const Eigen::VectorXd& step, Eigen::VectorXd& result,
               int teeth) noexcept;

double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b, int teeth) noexcept;

/// Number of values that are positive in one vector and not positive in the other.
int signsChanged(const Eigen::VectorXd& a, const Eigen::VectorXd& b, int teeth) noexcept;

/// Turns all teeth: tooth i + `places` gets x and y of tooth i, rotated by the angle with the cosine `c` and the sine
/// `s`. `places`: 0 ... number of teeth - 1.
void turn(const Eigen::VectorXd& values, int places, double c, double s, Eigen::VectorXd& turned) noexcept;

struct Combination
{
  const double* a;
  const double* b;
  const double* c;

  struct Factors
  {
    double a;
    double b;
    double c;
  };
};

/// result = the sum of `vectors` times `factors`, turned as in `turn`, on a half ring of `teeth` teeth. Values that
/// leave the half ring at its end enter at its start with opposite sign. `places`: 0 ... teeth - 1.
void turnHalf(const Combination& vectors, const Combination::Factors& factors, int places, double c, double s,
              Eigen::VectorXd& result, int teeth) noexcept;

/// result = sum of `vectors` times `here` + sum of `vectors` times `turned`, the second sum turned as in `turn`. The
/// vectors have all teeth. Only the first `teeth` teeth of the result are computed.
void addTurned(const Combination& vectors, const Combination::Factors& here, const Combination::Factors& turned,
               int places, double c, double s, Eigen::VectorXd& result, int teeth) noexcept;
}  // namespace ring_vectors

/// The ring at a position, with its derivatives by motor and output angle: all data that a failed move restores.
struct RingState
{
  explicit RingState(const RingModel& model)
    : shape(model.restShape({}))
    , by_wave_generator(Eigen::VectorXd::Zero(2 * model.rest.teeth()))
    , by_output(Eigen::VectorXd::Zero(2 * model.rest.teeth()))
    , stiffness(Eigen::Matrix2d::Zero())
  {
  }

  /// Copies another state except directions and lengths of its shape, which RingShape::updateGeometry computes again.
  void keep(const RingState& other) noexcept
  {
    const auto copy = [](const Eigen::VectorXd& from, Eigen::VectorXd& to)
    { std::copy(from.data(), from.data() + from.size(), to.data()); };
    copy(other.shape.points, shape.points);
    shape.space = other.shape.space;
    shape.solved = other.shape.solved;
    position = other.position;
    copy(other.by_wave_generator, by_wave_generator);
    copy(other.by_output, by_output);
    stiffness = other.stiffness;
    cup_stiffness = other.cup_stiffness;
    residual = other.residual;
  }

  RingShape shape;
  DrivePosition position;
  /// derivatives of the tooth points in equilibrium by wave generator angle [m/rad]
  Eigen::VectorXd by_wave_generator;
  Eigen::VectorXd by_output;  ///< derivatives of the tooth points in equilibrium by output angle [m/rad]
  Eigen::Matrix2d stiffness;  ///< second derivatives of the energy by both angles, in equilibrium [N.m/rad]
  /// slope of the cup for which derivatives and stiffness are valid [N.m/rad]; 0: derivatives and stiffness are invalid
  double cup_stiffness{};
  double residual{};  ///< largest out-of-balance force component on a tooth [N]
};
}  // namespace hjt
