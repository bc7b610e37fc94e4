// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "studies/bordered_ring_solver.hpp"
#include "studies/ring_stepper.hpp"
#include "studies/runge_kutta_tableau.hpp"

namespace hjt
{
/// Diagonally implicit Runge-Kutta on the ring's own structure.
///
/// A stage at time t solves for the coordinates q, with q_bar and v_bar from the stages before and g = gamma h:
///   f(q, v, t) - M (v - v_bar) / g = 0,   v = (q - q_bar) / g
/// by Newton with the matrix K + C / g + M / g^2, which is the cyclic block-tridiagonal one of the equilibrium with a
/// larger diagonal. Its factors serve all stages of a step while they contract well; line search on the out-of-balance
/// force; a step that does not converge is done in halves. No allocation after construction.
class ImplicitRingStepper : public RingStepper
{
public:
  /// Of `solver` it takes the force tolerance, the bound on iterations and that on halvings.
  ImplicitRingStepper(DynamicRing& ring, const RungeKuttaTableau& tableau, const SolverParameters& solver);

  bool step(RingMotion& motion, double length) noexcept override;

  /// One step of just this length, teeth and spaces as they are. False: the motion stays.
  bool attempt(RingMotion& motion, double length) noexcept;
  /// To be called before the first attempt from a motion, and whenever motion or drive were changed from outside.
  void restart() noexcept { begun_ = false; }
  /// The last attempt stands: the next one goes on from its end. Otherwise the next one starts where that did.
  void accept() noexcept;
  /// Of the last attempt in the positions, by the tableau's embedded method: the largest over the teeth [m].
  double errorEstimate() const noexcept { return error_; }
  int errorPower() const noexcept
  {
    return tableau_.error_power;
  }  ///< of the step's length that the estimate goes with

private:
  void begin(const Eigen::VectorXd& speeds) noexcept;
  bool solveStage(double time) noexcept;
  double residual(double time) noexcept;
  bool searchLine(double time, double& norm) noexcept;
  bool factor() noexcept;

  DynamicRing& ring_;
  const RungeKuttaTableau& tableau_;
  SolverParameters parameters_;
  Eigen::VectorXd weight_;  // of the coordinates' forces, so that torques count as forces at the rim [-], [1/m]
  Eigen::VectorXd free_;    // 1, or 0 for a driven body [-]
  RingTangent tangent_;
  BorderedRingSolver solver_;
  double stage_step_{};  // gamma h of the present step [s]
  bool factored_{};      // in this step
  bool begun_{};         // the explicit first stage is at hand
  double largest_{};     // component of the out-of-balance force [N]
  double error_{};       // [m]
  // Scratch, sized once.
  std::vector<Eigen::VectorXd> speeds_;         // per stage: derivative of q
  std::vector<Eigen::VectorXd> accelerations_;  // per stage: derivative of v
  std::vector<RingPower> powers_;
  Eigen::VectorXd q_bar_;
  Eigen::VectorXd v_bar_;
  Eigen::VectorXd q_;
  Eigen::VectorXd v_;
  Eigen::VectorXd residual_;
  Eigen::VectorXd newton_;
  Eigen::VectorXd start_;
  RingMotion begin_;
};
}  // namespace hjt
