// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

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
}  // namespace hjt
