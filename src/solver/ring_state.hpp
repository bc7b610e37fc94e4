// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <Eigen/Core>

#include "model/ring_model.hpp"

namespace hjt
{
/// Loops over the coordinates of the first `teeth` teeth, which the solver goes through at every step, for the compiler
/// to vectorise. Vectors of one call have one size and are not the same, unless stated.
namespace ring_vectors
{
/// Largest absolute value; NaN if one is not finite.
double largest(const Eigen::VectorXd& values, int teeth) noexcept;

/// result = start + length * step.
void addScaled(const Eigen::VectorXd& start, double length, const Eigen::VectorXd& step, Eigen::VectorXd& result,
               int teeth) noexcept;

double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b, int teeth) noexcept;

/// How many signs of one value a tooth differ: positive in one, not in the other.
int signsChanged(const Eigen::VectorXd& a, const Eigen::VectorXd& b, int teeth) noexcept;

/// x and y of all teeth, turned by an angle of cosine c and sine s, to the tooth `places` further (0 ... N - 1).
void turn(const Eigen::VectorXd& values, int places, double c, double s, Eigen::VectorXd& turned) noexcept;

/// A sum of three vectors with a factor each.
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

/// result = sum with these factors, turned to the tooth `places` further (0 ... teeth - 1), on half a ring of `teeth`
/// teeth: those that leave it at its end come in at its start reversed.
void turnHalf(const Combination& vectors, const Combination::Factors& factors, int places, double c, double s,
              Eigen::VectorXd& result, int teeth) noexcept;

/// result = sum with the first factors + the sum with the others, turned to the tooth `places` further as by `turn`.
/// The vectors are whole, of the result its first `teeth` teeth.
void addTurned(const Combination& vectors, const Combination::Factors& here, const Combination::Factors& turned,
               int places, double c, double s, Eigen::VectorXd& result, int teeth) noexcept;
}  // namespace ring_vectors

/// The ring at a position, and how it follows both angles from there: all that a failed move must restore.
struct RingState
{
  explicit RingState(const RingModel& model)
    : shape(model.restShape({}))
    , by_wave_generator(Eigen::VectorXd::Zero(2 * model.rest.teeth()))
    , by_output(Eigen::VectorXd::Zero(2 * model.rest.teeth()))
    , stiffness(Eigen::Matrix2d::Zero())
  {
  }

  /// Takes over another state but for the directions and lengths of its shape (RingShape::updateGeometry).
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
  Eigen::VectorXd by_wave_generator;  ///< rates of the tooth points in equilibrium [m/rad]
  Eigen::VectorXd by_output;          ///< [m/rad]
  Eigen::Matrix2d stiffness;          ///< by (wave generator, output) angle, the ring following [N.m/rad]
  double cup_stiffness{};  ///< slope of the cup that rates and stiffness are of; 0: they are of no tangent [N.m/rad]
  double residual{};       ///< largest out-of-balance force component on a tooth [N]
};
}  // namespace hjt
