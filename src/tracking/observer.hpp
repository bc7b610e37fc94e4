// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>

#include "elements/load.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "statics/torsion_curve.hpp"
#include "tracking/friction_map.hpp"

namespace hjt
{
/// Linear model of the joint over one step, with one local stiffness: (x after the step) = transition * x + input *
/// (motor torque, output torque). The state x is: angle and speed of motor and output, disturbance torque at the motor.
struct ObserverPiece
{
  using Vector = Eigen::Matrix<double, 5, 1>;
  using Matrix = Eigen::Matrix<double, 5, 5>;
  enum State : int
  {
    MOTOR_ANGLE,
    MOTOR_SPEED,
    OUTPUT_ANGLE,
    OUTPUT_SPEED,
    DISTURBANCE
  };

  double stiffness{};  ///< stiffness at the output [N.m/rad]
  Matrix transition;
  Eigen::Matrix<double, 5, 2> input;
  Matrix process;  ///< covariance of x by the process noise of a step
};

/// Integrates the linear model of the joint exactly over one step. `inertia`: inertias of motor and output [kg.m^2].
/// `stiffness`: stiffness at the output [N.m/rad]. `step`: length of the step [s]. The torsional oscillation has two
/// per cent of the critical damping, so that an oscillation that is too fast for the rows decays.
ObserverPiece makeObserverPiece(const Eigen::Vector2d& inertia, double ratio, double stiffness, double step,
                                const ObserverParameters& noise);

/// Returns the Kalman gain for one measured angle with the standard deviation `noise` [rad]. Replaces `covariance` by
/// the covariance after the measurement (Joseph's form).
ObserverPiece::Vector takeAngle(ObserverPiece::Matrix& covariance, ObserverPiece::State angle, double noise) noexcept;

/// Measurements on a joint at one instant.
struct Measurement
{
  double time{};          ///< time of the measurements [s]
  double motor_torque{};  ///< motor torque, estimated from the current [N.m]
  double load_torque{};   ///< external torque at the output, > 0 resists positive motion [N.m]
  double output_angle{};  ///< angle by the encoder at the output [rad]
  double motor_angle{};   ///< angle by the encoder at the motor; NaN: no such encoder [rad]
  bool restarted{};       ///< whether this measurement is the first one after a gap, which replaces the state
  double temperature{
    std::numeric_limits<double>::quiet_NaN()
  };  ///< temperature of the drive; NaN: as configured [degC]
};

/// Estimate of the observer after a measurement.
struct Observation
{
  double motor_angle{};      ///< motor angle; output angle and load at the start define the zero [rad]
  double motor_velocity{};   ///< speed of the motor [rad/s]
  double output_angle{};     ///< angle of the output [rad]
  double output_velocity{};  ///< speed of the output [rad/s]
  double joint_torque{};     ///< torque in the gear, at the output [N.m]
  double friction_torque{};  ///< friction of a sound joint at the motor, with the sign of the motion [N.m]
  double residual_torque{};  ///< torque at the motor that a sound joint does not explain [N.m]
  double residual_band{};    ///< three standard deviations of residual_torque in a sound joint [N.m]
  double innovation{};       ///< measured - predicted output angle [rad]
  double innovation_band{};  ///< three standard deviations of the innovation [rad]
  bool sticking{};           ///< whether friction holds the motor; residual_torque then has no meaning
};

/// Extended Kalman filter for a disturbance torque, and for angle and speed of motor and output. The measured motor
/// torque drives the model, and the measured angles correct the state. The filter advances in steps of STEP, so that
/// the times between rows may differ, and rows may be missing.
///
/// Torsion and friction are those of the twin (TorsionCurve, FrictionMap). The friction is just large enough to stop
/// the motor within the step, but at most that of the twin. With motor.presliding_angle the friction builds up over
/// this angle. While the motor sticks, the measured angle does not change the disturbance torque, so that this estimate
/// does not grow without limit; its band widens instead. If the robot moves while the model's motor sticks, the output
/// of the model follows the robot until the torque of the torsion exceeds stiction. The estimated disturbance torque is
/// the residual: a friction that the twin lacks, or an unknown load. The observer never adapts the parameters of the
/// model, because it would adapt them to a fault. A step takes about a microsecond.
class Observer
{
public:
  static constexpr double STEP = 1.0e-3;  ///< length of a step of the filter [s]

  /// @throws ParameterError if the ring finds no equilibrium under load.
  explicit Observer(const Parameters& parameters);

  Observation step(const Measurement& measurement) noexcept;

private:
  void start(const Measurement& measurement) noexcept;
  void predict(double motor_torque, double load_torque, double temperature) noexcept;
  double preslide(double most, double free, double response) noexcept;
  double correct(ObserverPiece::State angle, double measured, double noise) noexcept;

  FrictionMap friction_;
  Load load_;
  ObserverParameters noise_;
  double ratio_;
  double temperature_;       // assumed temperature of measurements without one [degC]
  double presliding_angle_;  // angle of the motor over which friction builds up [rad]
  TorsionCurve curve_;
  std::vector<ObserverPiece> pieces_;  // linear models for the pieces of the torsion curve
  ObserverPiece::Vector state_;
  ObserverPiece::Matrix covariance_;
  Measurement last_;
  bool started_{};
  double now_{};           // time of the state [s]
  double motor_zero_{};    // reading of the motor's encoder - motor angle of the state [rad]
  double friction_now_{};  // friction at the motor in the last step [N.m]
  double mobilised_{};     // share of the friction that has built up, with its sign [-]
  bool sticking_{};
  double angle_deviation_{};  // expected standard deviation of the last innovation [rad]
};
}  // namespace hjt
