// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>
#include <boost/numeric/odeint/algebra/vector_space_algebra.hpp>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include "solver/joint_dynamics.hpp"

namespace hjt
{
/// Marches the joint on the response surface in steps of their own length: Boost.odeint's Runge-Kutta of Dormand and
/// Prince, order 5, controlled by its embedded error, with its interpolation at the instants asked for.
///
/// Dry friction of motor shaft and output is set-valued, as the leapfrog has it: each of the two slides one way or
/// sticks. Where a speed comes to zero, where a shaft breaks away and where the cup's sliders turn round, the step ends
/// there; likewise where the drive's speed limit begins or ceases to hold torque back. Short of it the current's lag is
/// an exact exponential, within it one more rate. The flanks' friction is regularised at FLANK_WIDTH while the motor
/// turns; while it sticks, it belongs to the output's.
class AdaptiveStepper
{
public:
  /// Motor speed at which the flanks' friction is regularised [rad/s].
  static constexpr double FLANK_WIDTH = 1e-3;

  /// Longest step times `frequency`: the method is stable and its interpolation smooth [rad].
  static constexpr double MAX_PHASE = 2.0;

  /// `tolerance`: error of a step in the output's angle [rad]; in the motor's `ratio` times that, in their speeds
  /// `frequency` [rad/s] times those.
  AdaptiveStepper(JointDynamics& dynamics, double tolerance, double ratio, double frequency) noexcept;

  void setDynamics(JointDynamics& copied) noexcept { dynamics_ = &copied; }  ///< of a copy

  /// Whether it knows all friction that acts: not a cup as one Coulomb element, nor an engaged brake with play.
  bool covers(const JointInputs& inputs) const noexcept;

  /// Starts from state `x`, whose ring is in place, with the dynamics' inputs. `x` gets what has slipped.
  void start(JointState& x) noexcept;

  /// State `length` [s] further. The ring is in place there. False: the surface ends, or no step is short enough; `x`
  /// is the last good state, `left` [s] short of it.
  bool advance(double length, JointState& x, double& left) noexcept;

  const Eigen::Vector2d& frictionTorque() const noexcept { return drag_; }  ///< on motor and output [N.m]
  int steps() const noexcept { return steps_; }                             ///< taken in the last call of `advance`

  /// `time`: since the start of the step [s].
  void operator()(const JointState& x, JointState& rate, double time) noexcept;

private:
  struct ErrorChecker
  {
    using value_type = double;
    template <class Algebra>
    double error(const Algebra&, const JointState&, const JointState&, const JointState& error, double) const noexcept
    {
      return error.head<4>().cwiseAbs().cwiseProduct(per_unit).maxCoeff();
    }
    Eigen::Vector4d per_unit;
  };
  /// A stepper of odeint copies what it has not filled yet.
  struct State : JointState
  {
    State() : JointState(Zero()) {}
    using JointState::operator=;
  };
  using DormandPrince = boost::numeric::odeint::runge_kutta_dopri5<State, double, State, double,
                                                                   boost::numeric::odeint::vector_space_algebra>;
  using Controlled = boost::numeric::odeint::controlled_runge_kutta<DormandPrince, ErrorChecker>;

  /// Where the step ends, and what stands from there on: 0 the motor, 1 the output, -1 neither.
  struct Event
  {
    double end;
    int stopped;
  };

  bool takeStep() noexcept;
  void endAtEvent() noexcept;
  template <class Function, class Begin>
  void endAt(const Function& function, const Begin& begin, double whole, Event& event) noexcept;
  void endAtStop(int i, double excess, Event& event) noexcept;
  void endAtTurnOfTheRim(double turned, double stiffness, double by_output, Event& event) noexcept;
  void endAtFade(Event& event) noexcept;
  void chooseModes() noexcept;
  void interpolate(double time, JointState& x) const noexcept;
  bool place(const JointState& x) noexcept;
  double cupRate(const JointState& x) const noexcept;
  double roomToFade(const JointState& x) const noexcept;
  double currentTorque(const JointState& x, double time) const noexcept;
  bool isAtRest() const noexcept;
  template <class Function>
  double firstZero(Function&& function, double end, double at_start, double at_end) const noexcept;

  JointDynamics* dynamics_;
  Controlled controlled_;
  double speed_tolerance_;  // of the output [rad/s]
  double first_;            // step after a start [s]
  State start_, end_;       // of the step
  State start_rate_, end_rate_;
  double whole_{};       // the step, as it was taken [s]
  double length_{};      // up to an event in it [s]
  double at_{};          // of the present instant in it [s]
  double next_{};        // to be tried [s]
  double cup_rate_{};    // of the rim at the start of the step [rad/s]
  bool event_{};         // the step ends at one
  bool left_surface_{};  // in an evaluation of the rates
  bool fades_{};         // the drive's torque with the speed
  double lag_{};         // since when the current follows: before the start of the step [s]
  int steps_{};
  std::array<int, 2> mode_{};     // of motor and output: the way they slide, 0 where they stick
  Eigen::Vector2d strength_;      // of the dry friction of each, at the last evaluation [N.m]
  Eigen::Vector2d push_;          // against it [N.m]
  Eigen::Vector2d drag_{ 0, 0 };  // all friction there [N.m]
};
}  // namespace hjt
