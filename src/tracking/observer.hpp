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
/// The joint about one local stiffness, for one step: x' = transition x + input (motor torque, output torque).
/// x: motor angle and speed, output angle and speed, disturbance torque at the motor.
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
  Matrix process;  ///< covariance of the process noise over a step
};

/// The exact step of one stiffness. `inertia`: of motor and output [kg.m^2]; `step`: its length [s].
/// The torsional swing has two per cent of critical damping, so that a swing faster than the rows does not persist
/// unseen.
ObserverPiece makeObserverPiece(const Eigen::Vector2d& inertia, double ratio, double stiffness, double step,
                                const ObserverParameters& noise);

/// Kalman gain of one measured angle. The function replaces the covariance by that after the measurement (Joseph's
/// form).
ObserverPiece::Vector takeAngle(ObserverPiece::Matrix& covariance, ObserverPiece::State angle, double noise) noexcept;

/// Measurements at one instant.
struct Measurement
{
  double time{};          ///< time of the measurements [s]
  double motor_torque{};  ///< motor torque, estimated from the current [N.m]
  double load_torque{};   ///< external torque at the output, > 0 resists positive motion [N.m]
  double output_angle{};  ///< output angle by the encoder [rad]
  double motor_angle{};   ///< motor angle by the encoder; NaN: there is no such encoder [rad]
  bool restarted{};       ///< first after a gap: the state before is discarded
  double temperature{
    std::numeric_limits<double>::quiet_NaN()
  };  ///< temperature of the drive; NaN: as configured [degC]
};

/// Estimate after the measurement.
struct Observation
{
  double motor_angle{};      ///< motor angle, whose zero follows from output and load at the start [rad]
  double motor_velocity{};   ///< [rad/s]
  double output_angle{};     ///< [rad]
  double output_velocity{};  ///< [rad/s]
  double joint_torque{};     ///< torque in the gear, at the output [N.m]
  double friction_torque{};  ///< friction of a healthy joint at the motor, with its sign [N.m]
  double
      residual_torque{};   ///< torque at the motor, beyond that of a healthy joint, that explains the measurement [N.m]
  double residual_band{};  ///< three standard deviations for a healthy joint with the configured noise [N.m]
  double innovation{};     ///< measured less predicted output angle [rad]
  double innovation_band{};  ///< band of the innovation: three deviations [rad]
  bool sticking{};           ///< friction holds the motor: any torque within it fits, so the residual carries no
                             ///< information
};

/// An extended Kalman filter of a joint with four states. The measured torque drives the joint, and the encoder of the
/// output, or both encoders, correct it. The filter runs in steps of STEP, so that rows may come unevenly or not at
/// all.
///
/// Torsion and friction are the twin's (TorsionCurve, FrictionMap). The friction is implicit: as large as it takes to
/// stop the motor, but no larger than the twin's; with motor.presliding_angle it builds up over that angle. While the
/// motor sticks, the measured angle does not update the disturbance, so that the estimate does not wind up. Its band
/// widens instead. If the robot moves nevertheless, the model's output follows it until the torque of the spring
/// exceeds stiction. The remaining torque is the residual: more friction, or an unknown load. The observer never adapts
/// the model's parameters, so that no fault is adapted away. A step takes about a microsecond.
class Observer
{
public:
  static constexpr double STEP = 1.0e-3;  ///< length of a step [s]

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
  double temperature_;       // of measurements without one [degC]
  double presliding_angle_;  // presliding angle of the motor [rad]
  TorsionCurve curve_;
  std::vector<ObserverPiece> pieces_;  // linear pieces of the torsion curve
  ObserverPiece::Vector state_;
  ObserverPiece::Matrix covariance_;
  Measurement last_;
  bool started_{};
  double now_{};           // time of the state [s]
  double motor_zero_{};    // of the motor encoder [rad]
  double friction_now_{};  // [N.m]
  double mobilised_{};     // share of the friction that is mobilised
  bool sticking_{};
  double angle_deviation_{};  // expected standard deviation of the last innovation [rad]
};
}  // namespace hjt
