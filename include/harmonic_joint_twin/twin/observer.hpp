// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "harmonic_joint_twin/elements/load.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/twin/friction_map.hpp"

namespace hjt
{
/// What the observer is told of its sensors and of what no model knows. The gains follow from nothing else.
struct ObserverNoise
{
  double motor_angle{};         ///< of the motor encoder, rms [rad]
  double output_angle{};        ///< of the output encoder, rms [rad]
  double disturbance_growth{};  ///< rms of what the unmodelled torque at the motor changes in a second [N.m/sqrt(s)]
  double load_noise{};          ///< of the load torque, white, rms over one period [N.m]
};

/// The joint about one local stiffness, one period on: x' = transition x + input (motor torque, output torque).
/// x: motor angle and speed, output angle and speed, disturbance torque at the motor.
struct ObserverDesign
{
  using Vector = Eigen::Matrix<double, 5, 1>;
  using Matrix = Eigen::Matrix<double, 5, 5>;

  double stiffness{};  ///< [N.m/rad] at the output
  Matrix transition;
  Eigen::Matrix<double, 5, 2> input;
  Eigen::Matrix<double, 5, 2> gain;  ///< correction by the innovations of both angles
  double disturbance_deviation{};    ///< of the estimated disturbance, rms, if the noise is as stated [N.m]
  double spectral_radius{};          ///< of the error's transition; below 1 it dies out
};

/// Steady-state Kalman gain of the joint at one stiffness. `inertia`: of motor and output [kg.m^2].
/// Two per cent of critical damping are taken for the torsional swing, so that a swing faster than the sampling cannot hide.
ObserverDesign designObserver(const Eigen::Vector2d& inertia, double ratio, double stiffness, double period,
                              const ObserverNoise& noise);

/// What the observer knows after a measurement.
struct Observation
{
  double motor_angle{};      ///< [rad]
  double motor_velocity{};   ///< [rad/s]
  double output_angle{};     ///< [rad]
  double output_velocity{};  ///< [rad/s]
  double joint_torque{};     ///< in the gear, at the output [N.m]
  double friction_torque{};  ///< a healthy joint's, at the motor, with its sign [N.m]
  double residual_torque{};  ///< at the motor: what the measurement needs beyond the healthy joint [N.m]
  double residual_band{};    ///< of it, three deviations, if the noise is as stated and the joint healthy [N.m]
  bool sticking{};           ///< friction holds the motor: within it any torque fits, so the residual says nothing new
};

/// The joint of four states, driven by the measured torque and corrected towards both encoders.
///
/// The torsion is the twin's own curve, the friction the twin's own (FrictionMap), taken implicitly: as large as needed to
/// stop the motor, at most what it is. While the model sticks, torque within the friction moves nothing, so nothing winds up.
/// What the encoders ask for beyond is one torque, the residual: friction that has grown, a load that was not told. The
/// model's own parameters are never adapted, so a fault cannot be learnt away. A step costs about a microsecond.
class Observer
{
public:
  /// `period` of the measurements [s]. @throws ParameterError if the ring finds no equilibrium under load.
  Observer(const Parameters& parameters, const ObserverNoise& noise, double period);

  void reset(double motor_angle, double output_angle) noexcept;

  /// One period on: `motor_torque` mean over it, `load_torque` external at the output, then both angles.
  Observation step(double motor_torque, double load_torque, double motor_angle, double output_angle) noexcept;

private:
  struct CurvePoint
  {
    double torsion;  // [rad]
    double torque;   // [N.m]
  };
  double torque(double torsion, double& slope) const noexcept;
  const ObserverDesign& nearest(double slope) const noexcept;

  FrictionMap friction_;
  Load load_;
  double ratio_;
  double temperature_;
  std::vector<CurvePoint> curve_;  // for torsion >= 0, ascending
  std::vector<ObserverDesign> designs_;
  ObserverDesign::Vector state_;
};
}  // namespace hjt
