// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "solver/cyclic_solver.hpp"
#include "solver/ring_equilibrium.hpp"
#include "studies/dynamic_ring.hpp"

namespace hjt
{
/// State of a dynamic ring, with the supplied and the dissipated energy.
struct RingMotion
{
  explicit RingMotion(int coordinates) : q(Eigen::VectorXd::Zero(coordinates)), v(Eigen::VectorXd::Zero(coordinates)) {}

  Eigen::VectorXd q;    ///< tooth points [m], wave generator angle, output angle [rad]
  Eigen::VectorXd v;    ///< speeds of `q` [m/s], [rad/s]
  double time{};        ///< [s]
  double supplied{};    ///< energy supplied since the start [J]
  double dissipated{};  ///< energy dissipated by dashpots and viscous friction [J]
};

struct StepCounts
{
  long steps{};
  long force_evaluations{};
  long factorisations{};
  long halvings{};    ///< number of steps that did not converge and were halved
  long rejections{};  ///< number of steps that were repeated because their error was too large
};

/// Interface of the integration methods of a dynamic ring.
class RingStepper
{
public:
  virtual ~RingStepper() = default;

  /// Assigns spaces to the teeth and advances the motion by `length` [s]. Returns false, without a change, on failure.
  virtual bool step(RingMotion& motion, double length) noexcept = 0;

  const StepCounts& counts() const noexcept { return counts_; }

protected:
  StepCounts counts_;
};

enum class RingMethod
{
  RUNGE_KUTTA4,
  IMPLICIT_EULER,
  TR_BDF2,
  ESDIRK4
};

/// Whether the method has an error estimate, which step control needs.
bool judgesItsError(RingMethod method);

/// Makes the stepper of a method. The out-of-balance force of an implicit stage is at most solver.force_tolerance [N]
/// or the rounding error of the coordinates. `tolerance`: largest error of a tooth's position in one step, for methods
/// with step control [m]; 0: steps of the requested length.
std::unique_ptr<RingStepper> makeRingStepper(RingMethod method, DynamicRing& ring, const SolverParameters& solver,
                                             double tolerance = 0.0);

/// Sets `motion` to the positions and speeds of a quasi-static ring, while the wave generator turns at `speed` [rad/s]
/// under a constant `load` [N.m]. `ring`: equilibrium under this load. The output turns at its mean speed over a
/// tooth pitch, because its inertia prevents faster changes. @returns a status that is ok() if there is an equilibrium.
inline SolveStatus travelInEquilibrium(const RingEquilibrium& ring, double speed, double load, RingMotion& motion)
{
  const double pitch = ring.model().rest.pitchAngle();
  RingEquilibrium ahead = ring;
  const SolveStatus status = balanceOutput(ahead, ring.position().wave_generator_angle + pitch, load);
  if (!status.ok())
  {
    return status;
  }
  const double output_speed = speed * (ahead.position().output_angle - ring.position().output_angle) / pitch;
  motion.q << ring.shape().points, ring.position().wave_generator_angle, ring.position().output_angle;
  motion.v << speed * ring.byWaveGenerator() + output_speed * ring.byOutput(), speed, output_speed;
  return status;
}

/// Direct solver for the ring's tangent over all coordinates: a cyclic matrix of the teeth with a border for the angles
/// of wave generator and output. Two right-hand sides condense the border to 2 x 2. Only the constructor allocates.
class BorderedRingSolver
{
public:
  explicit BorderedRingSolver(int teeth)
    : teeth_(teeth), border_(2 * teeth, 2), condensed_(2 * teeth, 2), scratch_(2 * teeth)
  {
  }

  /// Factors the tangent. `held`: whether wave generator and output are held, so that their solution is zero. @returns
  /// false if the tangent is singular or not finite.
  bool factor(const RingTangent& tangent, const std::array<bool, 2>& held) noexcept
  {
    held_ = held;
    if (!teeth_.factor(tangent))
    {
      return false;
    }
    if (held_[0] && held_[1])
    {
      return true;
    }
    border_.col(0) = tangent.wave_generator;
    border_.col(1) = tangent.output;
    condensed_ = border_;
    teeth_.solve<2>(condensed_);
    Eigen::Matrix2d corner = -border_.transpose() * condensed_;
    corner(0, 0) += tangent.wave_generator_stiffness;
    corner(1, 1) += tangent.output_stiffness;
    for (int k = 0; k < 2; ++k)
    {
      if (held_[static_cast<std::size_t>(k)])
      {
        corner.row(k).setZero();
        corner.col(k).setZero();
        corner(k, k) = 1.0;
      }
    }
    corner_inverse_ = corner.inverse();
    return corner_inverse_.allFinite();
  }

  /// Solves in place for 2 N coordinates of the teeth, wave generator angle and output angle.
  void solve(Eigen::VectorXd& b) noexcept
  {
    scratch_ = b.head(scratch_.size());
    teeth_.solve<1>(scratch_);
    if (held_[0] && held_[1])
    {
      b.tail<2>().setZero();
    }
    else
    {
      Eigen::Vector2d angles = b.tail<2>() - border_.transpose() * scratch_;
      for (int k = 0; k < 2; ++k)
      {
        angles[k] = held_[static_cast<std::size_t>(k)] ? 0.0 : angles[k];
      }
      angles = corner_inverse_ * angles;
      scratch_.noalias() -= condensed_ * angles;
      b.tail<2>() = angles;
    }
    b.head(scratch_.size()) = scratch_;
  }

private:
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, 2>;

  CyclicSolver teeth_;
  std::array<bool, 2> held_{};
  Columns border_;     // couplings of the teeth with wave generator angle and output angle
  Columns condensed_;  // inverse of the teeth's matrix times border_
  Eigen::Matrix2d corner_inverse_{ Eigen::Matrix2d::Identity() };
  Eigen::VectorXd scratch_;
};

/// Coefficients of a diagonally implicit, stiffly accurate Runge-Kutta method: the last stage is the end of the step.
///
/// All implicit stages have the diagonal gamma and share one factored matrix. The first stage may be explicit.
struct RungeKuttaTableau
{
  int order;                                ///< order of the method
  double gamma;                             ///< diagonal coefficient of the implicit stages [-]
  bool explicit_first;                      ///< whether the first stage is explicit, at the start of the step
  std::vector<std::vector<double>> before;  ///< weights of the earlier stages, one row for each stage [-]
  std::vector<double> times;                ///< times of the stages, as shares of the step [-]
  std::vector<double> error;                ///< weights of the embedded error estimate; empty: none [-]
  int error_power;                          ///< power of the step length in the error estimate; 0: no estimate

  int stages() const { return static_cast<int>(times.size()); }
  /// Weight of stage i in the step, from the last row.
  double weight(int i) const { return i + 1 == stages() ? gamma : before.back()[static_cast<std::size_t>(i)]; }
};

/// Implicit Euler method: order 1, L-stable. The solver ode14x of the thesis' chapter 6 extrapolates this method.
inline const RungeKuttaTableau& implicitEuler()
{
  static const RungeKuttaTableau TABLEAU{ 1, 1.0, false, { {} }, { 1.0 }, {}, 0 };
  return TABLEAU;
}

/// Order 2, L-stable, stage order 2: trapezoidal rule followed by BDF2 (Bank et al. 1985), with an embedded method of
/// order 3 (Hosea and Shampine 1996).
inline const RungeKuttaTableau& trBdf2()
{
  static const RungeKuttaTableau TABLEAU = []
  {
    const double g = 1.0 - std::sqrt(0.5);
    const double w = 0.25 * std::sqrt(2.0);
    // Weights of the step minus those of the embedded method.
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

/// Diagonally implicit Runge-Kutta method with the structure of the ring.
///
/// A stage at time t solves for the coordinates q and their speeds v:
///   f(q, v, t) - M (v - v_bar) / g = 0,   v = (q - q_bar) / g
/// where f is the force, M the mass, q_bar and v_bar follow from the earlier stages, and g = gamma h with the step h.
/// Newton's method uses the matrix K + C / g + M / g^2, whose factors serve all stages of a step while the iteration
/// contracts well. The line search uses the out-of-balance force. A step that does not converge is halved. Only the
/// constructor allocates.
class ImplicitRingStepper : public RingStepper
{
public:
  /// `solver` gives the force tolerance and the limits on iterations and halvings.
  ImplicitRingStepper(DynamicRing& ring, const RungeKuttaTableau& tableau, const SolverParameters& solver);

  bool step(RingMotion& motion, double length) noexcept override;

  /// Attempts one step with the current spaces of the teeth. @returns false, with the motion unchanged, if it diverges.
  bool attempt(RingMotion& motion, double length) noexcept;
  /// Forgets the first stage. Must be called before the first attempt, and after external changes of motion or drive.
  void restart() noexcept { begun_ = false; }
  /// Accepts the last attempt, so that the next attempt starts at the end of this attempt and not at its start.
  void accept() noexcept;
  /// Largest error of a tooth's position in the last attempt, estimated by the embedded method [m].
  double errorEstimate() const noexcept { return error_; }
  int errorPower() const noexcept { return tableau_.error_power; }  ///< RungeKuttaTableau::error_power

private:
  void begin(const Eigen::VectorXd& speeds) noexcept;
  bool solveStage(double time) noexcept;
  double residual(double time) noexcept;
  bool searchLine(double time, double& norm) noexcept;
  bool factor() noexcept;

  DynamicRing& ring_;
  const RungeKuttaTableau& tableau_;
  SolverParameters parameters_;
  Eigen::VectorXd weight_;  // weights of the forces [-], and of the torques, which count as forces at the rim [1/m]
  Eigen::VectorXd free_;    // 1 for a free coordinate, 0 for a driven body [-]
  RingTangent tangent_;
  BorderedRingSolver solver_;
  double stage_step_{};  // gamma h of the step [s]
  bool factored_{};      // whether the matrix was factored in this step
  bool begun_{};         // whether the explicit first stage is computed
  double largest_{};     // largest component of the out-of-balance force [N]
  double error_{};       // errorEstimate of the last attempt [m]
  // Working memory.
  std::vector<Eigen::VectorXd> speeds_;         // derivative of q at each stage
  std::vector<Eigen::VectorXd> accelerations_;  // derivative of v at each stage
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
