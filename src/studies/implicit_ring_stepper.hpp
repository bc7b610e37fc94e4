// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "studies/bordered_ring_solver.hpp"
#include "studies/ring_stepper.hpp"

namespace hjt
{
/// Coefficients of a diagonally implicit Runge-Kutta method, stiffly accurate: the last stage is the step's end.
///
/// All implicit stages share the diagonal gamma, so one factored matrix serves them all. The first stage may be
/// explicit.
struct RungeKuttaTableau
{
  int order;
  double gamma;                             ///< diagonal of the implicit stages [-]
  bool explicit_first;                      ///< the first stage is the step's start
  std::vector<std::vector<double>> before;  ///< row per stage: weights of the stages before it [-]
  std::vector<double> times;                ///< of the stages, in steps [-]
  std::vector<double> error;                ///< weights of the embedded error estimate; empty: none [-]
  int error_power;                          ///< of the step that the estimate goes with; 0: none

  int stages() const { return static_cast<int>(times.size()); }
  /// Weight of stage i in the step: the last row.
  double weight(int i) const { return i + 1 == stages() ? gamma : before.back()[static_cast<std::size_t>(i)]; }
};

/// Order 1, L-stable: what ode14x of the thesis' chapter 6 extrapolates from.
inline const RungeKuttaTableau& implicitEuler()
{
  static const RungeKuttaTableau TABLEAU{ 1, 1.0, false, { {} }, { 1.0 }, {}, 0 };
  return TABLEAU;
}

/// Order 2, L-stable, stage order 2: trapezoidal rule and BDF2 as one method (Bank et al. 1985; embedded estimate of
/// order 3 of Hosea and Shampine 1996).
inline const RungeKuttaTableau& trBdf2()
{
  static const RungeKuttaTableau TABLEAU = []
  {
    const double g = 1.0 - std::sqrt(0.5);
    const double w = 0.25 * std::sqrt(2.0);
    // Weights of the step less those of the embedded method of order 3.
    const std::vector<double> error{ w - (1.0 - w) / 3.0, w - (3.0 * w + 1.0) / 3.0, g - g / 3.0 };
    return RungeKuttaTableau{ 2, g, true, { {}, { g }, { w, w } }, { 0.0, 2.0 * g, 1.0 }, error, 3 };
  }();
  return TABLEAU;
}

/// Order 4, L-stable, stage order 2, six stages, embedded order 3 (Kennedy and Carpenter 2003, ARK4(3)6L[2]SA, implicit
/// part).
inline const RungeKuttaTableau& esdirk4()
{
  static const RungeKuttaTableau TABLEAU = []
  {
    const std::vector<double> last{ 82889.0 / 524892.0, 0.0, 15625.0 / 83664.0, 69875.0 / 102672.0, -2260.0 / 8211.0 };
    const std::vector<double> embedded{ 4586570599.0 / 29645900160.0, 0.0,
                                        178811875.0 / 945068544.0,    814220225.0 / 1159782912.0,
                                        -3700637.0 / 11593932.0,      61727.0 / 225920.0 };
    std::vector<double> error(6);
    for (std::size_t i = 0; i < 6; ++i)
    {
      error[i] = (i < 5 ? last[i] : 0.25) - embedded[i];
    }
    return RungeKuttaTableau{ 4,
                              0.25,
                              true,
                              { {},
                                { 0.25 },
                                { 8611.0 / 62500.0, -1743.0 / 31250.0 },
                                { 5012029.0 / 34652500.0, -654441.0 / 2922500.0, 174375.0 / 388108.0 },
                                { 15267082809.0 / 155376265600.0, -71443401.0 / 120774400.0, 730878875.0 / 902184768.0,
                                  2285395.0 / 8070912.0 },
                                last },
                              { 0.0, 0.5, 83.0 / 250.0, 31.0 / 50.0, 17.0 / 20.0, 1.0 },
                              error,
                              4 };
  }();
  return TABLEAU;
}

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
