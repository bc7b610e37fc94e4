// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "studies/dynamic_ring.hpp"

namespace hjt
{
/// State of a dynamic ring, with its energy ledger.
struct RingMotion
{
  explicit RingMotion(int coordinates) : q(Eigen::VectorXd::Zero(coordinates)), v(Eigen::VectorXd::Zero(coordinates)) {}

  Eigen::VectorXd q;    ///< tooth points [m], wave generator angle, output angle [rad]
  Eigen::VectorXd v;    ///< their speeds
  double time{};        ///< [s]
  double supplied{};    ///< energy from outside since the start [J]
  double dissipated{};  ///< by dashpots and viscous friction [J]
};

/// Cost of a run.
struct StepCounts
{
  long steps{};
  long force_evaluations{};
  long factorisations{};
  long halvings{};    ///< of steps that did not converge
  long rejections{};  ///< of steps whose error was too large
};

/// A method of marching a dynamic ring.
class RingStepper
{
public:
  virtual ~RingStepper() = default;

  /// One step; teeth and spaces are paired at its start. On failure the motion stays as it was.
  virtual bool step(RingMotion& motion, double length) noexcept = 0;

  const StepCounts& counts() const noexcept { return counts_; }

protected:
  StepCounts counts_;
};
}  // namespace hjt
