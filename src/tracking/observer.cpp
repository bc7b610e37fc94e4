// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/observer.hpp"

#include <algorithm>
#include <cmath>

#include <unsupported/Eigen/MatrixFunctions>

#include "elements/friction_laws.hpp"
#include "elements/motor.hpp"
#include "gear/ratio.hpp"

namespace hjt
{
namespace
{
constexpr double DAMPING = 0.02;    // damping of the torsional oscillation over the critical damping [-]
constexpr double DEVIATIONS = 3.0;  // half width of a band, in standard deviations [-]
// Standard deviations of the state at the start.
constexpr double FIRST_TORSION = 1.0e-4;        // standard deviation of the torsion [rad]
constexpr double FIRST_SPEED = 1.0;             // standard deviation of the speed of the joint [rad/s]
constexpr double FIRST_DISTURBANCE_TIME = 1.0;  // time in which noise makes a disturbance as large as the first one [s]

using Vector = ObserverPiece::Vector;
using Matrix = ObserverPiece::Matrix;
}  // namespace

ObserverPiece makeObserverPiece(const Eigen::Vector2d& inertia, double ratio, double stiffness, double step,
                                const ObserverParameters& noise)
{
  ObserverPiece piece;
  piece.stiffness = stiffness;
  // Damping coefficient of the torsional oscillation of motor and output, seen from the output [N.m.s/rad].
  const double reduced = 1.0 / (1.0 / (inertia[0] * ratio * ratio) + 1.0 / inertia[1]);
  const double damping = 2.0 * DAMPING * std::sqrt(stiffness * reduced);

  Eigen::Matrix<double, 7, 7> rates = Eigen::Matrix<double, 7, 7>::Zero();
  const Eigen::Matrix<double, 1, 4> torsion(1.0 / ratio, 0.0, -1.0, 0.0);
  const Eigen::Matrix<double, 1, 4> torsion_rate(0.0, 1.0 / ratio, 0.0, -1.0);
  const Eigen::Matrix<double, 1, 4> torque = stiffness * torsion + damping * torsion_rate;
  rates(0, 1) = 1.0;
  rates(2, 3) = 1.0;
  rates.block<1, 4>(1, 0) = -torque / (ratio * inertia[0]);
  rates.block<1, 4>(3, 0) = torque / inertia[1];
  rates(1, 4) = rates(1, 5) = 1.0 / inertia[0];
  rates(3, 6) = 1.0 / inertia[1];
  rates *= step;
  const Eigen::Matrix<double, 7, 7> whole = rates.exp();
  piece.transition = whole.block<5, 5>(0, 0);
  piece.input = whole.block<5, 2>(0, 5);

  const Eigen::Vector2d power(std::pow(noise.torque_noise, 2) / step, std::pow(noise.load_noise, 2) / step);
  piece.process = piece.input * power.asDiagonal() * piece.input.transpose();
  piece.process(4, 4) += std::pow(noise.disturbance_growth, 2) * step;
  return piece;
}

Vector takeAngle(Matrix& covariance, ObserverPiece::State angle, double noise) noexcept
{
  const double power = noise * noise;
  const Vector gain = covariance.col(angle) / (covariance(angle, angle) + power);
  Matrix left = Matrix::Identity();
  left.col(angle) -= gain;
  covariance = (left * covariance * left.transpose() + power * gain * gain.transpose()).eval();
  return gain;
}

Observer::Observer(const Parameters& parameters)
  : friction_(parameters)
  , load_(parameters.output)
  , noise_(parameters.observer)
  , ratio_(nominalRatio(parameters.gear))
  , temperature_(parameters.input.temperature)
  , presliding_angle_(parameters.motor.presliding_angle)
  , curve_(parameters)
{
  const Eigen::Vector2d inertia(Motor(parameters.motor).inertia(), load_.inertia());
  for (const TorsionCurve::Piece& piece : curve_.pieces())
  {
    pieces_.push_back(makeObserverPiece(inertia, ratio_, piece.stiffness, STEP, noise_));
  }
}

/// Starts the filter at rest under the load. With the large covariance the first rows determine speeds and disturbance.
void Observer::start(const Measurement& measurement) noexcept
{
  const double load = measurement.load_torque - load_.gravityTorque(measurement.output_angle);
  const double motor_angle = ratio_ * (measurement.output_angle + curve_.torsion(load));
  motor_zero_ = measurement.motor_angle - motor_angle;
  state_ << motor_angle, 0.0, measurement.output_angle, 0.0, 0.0;
  Vector deviation;
  deviation << ratio_ * FIRST_TORSION, ratio_ * FIRST_SPEED, noise_.output_angle_noise, FIRST_SPEED,
      noise_.disturbance_growth * std::sqrt(FIRST_DISTURBANCE_TIME);
  covariance_ = deviation.cwiseAbs2().asDiagonal();
  mobilised_ = 0.0;
  now_ = measurement.time;
  started_ = true;
}

/// Advances the state and its covariance by one step of the filter.
void Observer::predict(double motor_torque, double load_torque, double temperature) noexcept
{
  const double torsion = state_[0] / ratio_ - state_[2];
  const double gear = curve_.torque(torsion);
  const ObserverPiece& piece = pieces_[curve_.pieceAt(torsion)];

  // Torque of the torsion curve - torque of the linear model (stiffness x torsion) [N.m].
  const double beyond = gear - piece.stiffness * torsion;
  const double output_torque = load_.gravityTorque(state_[2]) - load_torque;
  const Vector free =
      piece.transition * state_ + piece.input * Eigen::Vector2d(motor_torque - beyond / ratio_, output_torque + beyond);

  const double most = friction_.at(state_[1], gear, temperature).sum();
  const double by_friction = piece.input(1, 0);
  double taken = 1.0 / by_friction;  // holding friction over the speed without friction [N.m.s/rad]
  if (presliding_angle_ > 0.0)
  {
    taken = preslide(most, free[1], by_friction);
  }
  else
  {
    friction_now_ = std::clamp(free[1] / by_friction, -most, most);
    sticking_ = std::abs(friction_now_) < most;
  }
  state_ = free - piece.input.col(0) * friction_now_;

  Matrix transition = piece.transition;
  if (sticking_)
  {
    // The friction removes the speed that the motor would have without it, which is a linear map of the state too.
    Matrix held = Matrix::Identity();
    held.col(1) -= piece.input.col(0) * taken;
    transition = held * transition;
    covariance_ = (transition * covariance_ * transition.transpose() + held * piece.process * held.transpose()).eval();
  }
  else
  {
    covariance_ = (transition * covariance_ * transition.transpose() + piece.process).eval();
  }
  now_ += STEP;
}

/// Sets friction_now_ to the friction that has built up over the presliding angle at the end of a step. `most`: largest
/// friction [N.m]. `free`: motor speed at the end of the step without friction [rad/s]. `response`: speed that a
/// friction of 1 N.m removes in the step [rad/(N.m.s)]. Returns the slope of the friction over `free` [N.m.s/rad].
double Observer::preslide(double most, double free, double response) noexcept
{
  constexpr int BISECTIONS = 40;
  const auto turn = [&](double friction) { return 0.5 * STEP * (state_[1] + free - response * friction); };
  double low = -most;
  double high = most;
  for (int i = 0; i < BISECTIONS; ++i)
  {
    const double middle = 0.5 * (low + high);
    (middle < most * mobilised(mobilised_, turn(middle), presliding_angle_) ? low : high) = middle;
  }
  friction_now_ = 0.5 * (low + high);
  const double moved = turn(friction_now_);
  mobilised_ = mobilised(mobilised_, moved, presliding_angle_);
  sticking_ = std::abs(mobilised_) < SLIDING_SHARE;
  const double growth = 0.5 * STEP * most * (1.0 - std::copysign(mobilised_, mobilised_ * moved)) / presliding_angle_;
  return growth / (1.0 + response * growth);
}

/// Corrects the state by an angle with the standard deviation `noise` [rad]. Returns measured - expected angle [rad].
double Observer::correct(ObserverPiece::State angle, double measured, double noise) noexcept
{
  const double innovation = measured - state_[angle];
  angle_deviation_ = std::sqrt(covariance_(angle, angle) + noise * noise);
  state_ += takeAngle(covariance_, angle, noise) * innovation;
  return innovation;
}

Observation Observer::step(const Measurement& measurement) noexcept
{
  if (!started_ || measurement.restarted)
  {
    start(measurement);
    last_ = measurement;
  }
  const double motor_torque = 0.5 * (last_.motor_torque + measurement.motor_torque);
  const double load_torque = 0.5 * (last_.load_torque + measurement.load_torque);
  const double temperature = std::isfinite(measurement.temperature) ? measurement.temperature : temperature_;
  last_ = measurement;
  while (now_ + 0.5 * STEP < measurement.time)
  {
    predict(motor_torque, load_torque, temperature);
  }
  // The time of the measurement differs from that of the state by at most half a step.
  const double beside = measurement.time - now_;
  if (std::isfinite(measurement.motor_angle))
  {
    correct(ObserverPiece::MOTOR_ANGLE, measurement.motor_angle - motor_zero_ - state_[1] * beside,
            noise_.motor_angle_noise);
  }

  Observation now;
  now.innovation =
      correct(ObserverPiece::OUTPUT_ANGLE, measurement.output_angle - state_[3] * beside, noise_.output_angle_noise);
  now.innovation_band = DEVIATIONS * angle_deviation_;
  now.motor_angle = state_[0];
  now.motor_velocity = state_[1];
  now.output_angle = state_[2];
  now.output_velocity = state_[3];
  now.joint_torque = curve_.torque(state_[0] / ratio_ - state_[2]);
  now.friction_torque = friction_now_;
  now.residual_torque = state_[4];
  now.residual_band = DEVIATIONS * std::sqrt(covariance_(4, 4));
  now.sticking = sticking_;
  return now;
}
}  // namespace hjt
