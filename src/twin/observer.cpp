// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/twin/observer.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <unsupported/Eigen/MatrixFunctions>

#include "harmonic_joint_twin/elements/motor.hpp"
#include "harmonic_joint_twin/gear/ratio.hpp"
#include "harmonic_joint_twin/params/number_text.hpp"
#include "harmonic_joint_twin/params/parameter_error.hpp"
#include "harmonic_joint_twin/twin/static_analysis.hpp"

namespace hjt
{
namespace
{
constexpr double DAMPING = 0.02;  // of the torsional swing, of critical [-]
constexpr std::array<double, 9> CURVE{ 0.0, 5.0, 14.0, 25.0, 48.0, 75.0, 110.0, 150.0, 200.0 };  // [N.m]

using Matrix = ObserverDesign::Matrix;
using Outputs = Eigen::Matrix<double, 2, 5>;

Outputs measured()
{
  Outputs outputs = Outputs::Zero();
  outputs(0, 0) = 1.0;
  outputs(1, 2) = 1.0;
  return outputs;
}

/// Covariance before a measurement, in the steady state: the Riccati equation by doubling.
Matrix steadyCovariance(const Matrix& transition, const Matrix& process, const Matrix& information)
{
  constexpr int MOST = 60;
  constexpr double ENOUGH = 1e-14;
  Matrix a = transition.transpose();
  Matrix g = information;
  Matrix h = process;
  for (int i = 0; i < MOST; ++i)
  {
    const Matrix inverse = (Matrix::Identity() + g * h).inverse();
    const Matrix next_a = a * inverse * a;
    const Matrix next_g = g + a * inverse * g * a.transpose();
    const Matrix next_h = h + a.transpose() * h * inverse * a;
    const double change = (next_h - h).norm();
    a = next_a;
    g = next_g;
    h = next_h;
    if (change <= ENOUGH * h.norm())
    {
      break;
    }
  }
  return h;
}
}  // namespace

ObserverDesign designObserver(const Eigen::Vector2d& inertia, double ratio, double stiffness, double period,
                              const ObserverNoise& noise)
{
  ObserverDesign design;
  design.stiffness = stiffness;
  // Damping of the swing of both bodies against each other, seen from the output.
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
  rates *= period;
  const Eigen::Matrix<double, 7, 7> whole = rates.exp();
  design.transition = whole.block<5, 5>(0, 0);
  design.input = whole.block<5, 2>(0, 5);

  const Outputs outputs = measured();
  const Eigen::Matrix2d noise_power =
      Eigen::Vector2d(std::pow(noise.motor_angle, 2), std::pow(noise.output_angle, 2)).asDiagonal();
  Matrix process = design.input.col(1) * design.input.col(1).transpose() * std::pow(noise.load_noise, 2);
  process(4, 4) += std::pow(noise.disturbance_growth, 2) * period;
  // In units of their own noise the states are of like size, which the doubling needs.
  ObserverDesign::Vector unit;
  unit << noise.motor_angle, noise.motor_angle / period, noise.output_angle, noise.output_angle / period,
      inertia[0] * noise.motor_angle / (period * period);
  const Matrix to = unit.cwiseInverse().asDiagonal();
  const Matrix from = unit.asDiagonal();
  const Matrix information = from * outputs.transpose() * noise_power.inverse() * outputs * from;
  const Matrix before = from * steadyCovariance(to * design.transition * from, to * process * to, information) * from;

  design.gain = before * outputs.transpose() * (outputs * before * outputs.transpose() + noise_power).inverse();
  const Matrix left = Matrix::Identity() - design.gain * outputs;
  design.disturbance_deviation = std::sqrt(std::max(0.0, (left * before)(4, 4)));
  design.spectral_radius = (to * left * design.transition * from).eigenvalues().cwiseAbs().maxCoeff();
  return design;
}

Observer::Observer(const Parameters& parameters, const ObserverNoise& noise, double period)
  : friction_(parameters)
  , load_(parameters.output)
  , ratio_(nominalRatio(parameters.gear))
  , temperature_(parameters.input.temperature)
{
  const std::vector<StiffnessRow> rows =
      analyseStiffness(parameters, 0.0, std::vector<double>(CURVE.begin(), CURVE.end()));
  const Eigen::Vector2d inertia(Motor(parameters.motor).inertia(), load_.inertia());
  for (const StiffnessRow& row : rows)
  {
    if (!row.converged)
    {
      throw ParameterError("the ring finds no equilibrium under a load of " + numberText(row.torque) +
                           " N.m at the output");
    }
    curve_.push_back({ -row.output_angle, row.torque });
    if (curve_.size() > 1)
    {
      const CurvePoint& last = curve_[curve_.size() - 2];
      const double slope = (curve_.back().torque - last.torque) / (curve_.back().torsion - last.torsion);
      designs_.push_back(designObserver(inertia, ratio_, slope, period, noise));
    }
  }
  reset(0.0, 0.0);
}

void Observer::reset(double motor_angle, double output_angle) noexcept
{
  state_ << motor_angle, 0.0, output_angle, 0.0, 0.0;
}

double Observer::torque(double torsion, double& slope) const noexcept
{
  const double size = std::abs(torsion);
  std::size_t above = 1;
  while (above + 1 < curve_.size() && curve_[above].torsion < size)
  {
    ++above;
  }
  const CurvePoint& low = curve_[above - 1];
  slope = designs_[above - 1].stiffness;
  return std::copysign(low.torque + slope * (size - low.torsion), torsion);
}

const ObserverDesign& Observer::nearest(double slope) const noexcept
{
  return *std::min_element(designs_.begin(), designs_.end(),
                           [slope](const ObserverDesign& a, const ObserverDesign& b)
                           { return std::abs(a.stiffness - slope) < std::abs(b.stiffness - slope); });
}

Observation Observer::step(double motor_torque, double load_torque, double motor_angle, double output_angle) noexcept
{
  double slope{};
  const double torsion = state_[0] / ratio_ - state_[2];
  const double gear = torque(torsion, slope);
  const ObserverDesign& design = nearest(slope);

  // The curve's own torque where the linear piece gives stiffness times torsion.
  const double beyond = gear - design.stiffness * torsion;
  const double output_torque = load_.gravityTorque(state_[2]) - load_torque;
  const ObserverDesign::Vector free =
      design.transition * state_ +
      design.input * Eigen::Vector2d(motor_torque - beyond / ratio_, output_torque + beyond);

  const double most = friction_.at(state_[1], gear, temperature_).sum();
  const double by_friction = design.input(1, 0);
  const double friction = std::clamp(free[1] / by_friction, -most, most);
  state_ = free - design.input.col(0) * friction;

  const Eigen::Vector2d innovation(motor_angle - state_[0], output_angle - state_[2]);
  state_ += design.gain * innovation;

  Observation now;
  now.motor_angle = state_[0];
  now.motor_velocity = state_[1];
  now.output_angle = state_[2];
  now.output_velocity = state_[3];
  now.joint_torque = torque(state_[0] / ratio_ - state_[2], slope);
  now.friction_torque = friction;
  now.residual_torque = state_[4];
  now.residual_band = 3.0 * design.disturbance_deviation;
  now.sticking = std::abs(friction) < most;
  return now;
}
}  // namespace hjt
