// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "tracking/friction_map.hpp"
#include "tracking/motion_differentiator.hpp"
#include "tracking/motion_driven.hpp"

namespace hjt
{
/// 1 + 2 sum of the correlations until they first turn negative: rows that tell as much as one. Takes as long as a
/// Fourier transform of the rows.
double correlationRows(const Eigen::VectorXd& residuals);

/// A cost near some values: that of the model which is linear there, its slopes and its curvature.
struct NormalEquations
{
  double cost{};
  Eigen::VectorXd gradient;
  Eigen::MatrixXd normal;
};

/// Of errors that are linear in some columns, those beyond `outlier` counting by their size alone (Huber).
/// `products`: transposed columns times columns.
NormalEquations huberEquations(const Eigen::VectorXd& errors, const Eigen::MatrixXd& columns, Eigen::MatrixXd products,
                               double outlier);

/// Values of least cost between bounds, from these on (Levenberg and Marquardt). Equal bounds hold a value.
Eigen::VectorXd leastCost(const Eigen::VectorXd& start, const Eigen::VectorXd& lowest, const Eigen::VectorXd& highest,
                          const std::function<NormalEquations(const Eigen::VectorXd& values)>& equations);

/// Half widths of the 95 % intervals of what the columns belong to, widened by the errors' correlation; rows in the
/// order of time. 0 of a column that is zero.
Eigen::VectorXd halfWidths(const Eigen::VectorXd& errors, const Eigen::MatrixXd& columns);

/// Gain, offset, inertia and friction of a joint from the rows that move: the most probable values after what is known
/// before (maximum a posteriori).
///
///   current = (load + J n^2 a + s (rest + P preload + G grease + F flanks + V n |w|)) / gain + offset
/// with the shares of FrictionMap, w the motor's speed, s its sign. Each row of the fit is the mean over BLOCK, in
/// which the ripple of the teeth cancels out; it counts by the deviation of the rows, outliers less (Huber), and by the
/// correlation of their residual. Known before is each value as configured, normally distributed with the deviation of
/// `known`: what a motion hardly shows stays near it, and others do not run away in its place. No friction can be
/// negative. A quantity whose deviation the motion does not halve is refused and stays as configured; the others are
/// fitted again; last with a Stribeck term, S n exp(-(w/v)^2), v motor.stribeck_velocity, which stays if its interval
/// does not hold zero.
class FrictionFit
{
public:
  enum Quantity
  {
    GAIN,      ///< its inverse [A/(N.m)]
    OFFSET,    ///< [A]
    INERTIA,   ///< of the motor, less what the load holds [kg.m^2]
    PRELOAD,   ///< [N]
    GREASE,    ///< of the configured [-]
    FLANKS,    ///< of the configured [-]
    VISCOUS,   ///< at the motor [N.m.s/rad]
    STRIBECK,  ///< at the motor [N.m]
    QUANTITIES
  };
  using Values = Eigen::Matrix<double, QUANTITIES, 1>;

  static constexpr double MOVING = 0.01;  ///< joint speed from which a row counts as moving [rad/s]
  static constexpr double BLOCK = 0.1;    ///< [s]

  /// `look` as in identify. @throws InputError if the samples hardly move.
  FrictionFit(const Parameters& parameters, const FrictionMap& friction, const std::vector<MotionSample>& samples,
              const std::function<void()>& look);

  double value(Quantity quantity) const { return values_[quantity]; }
  double halfWidth(Quantity quantity) const { return half_width_[quantity]; }  ///< of the 95 % interval; 0 if refused
  const std::string& refusal(Quantity quantity) const { return refusal_[quantity]; }  ///< empty: identified

private:
  /// Of a block: the torque at the joint by each quantity, at GAIN the known one [N.m], at OFFSET 1, and the current
  /// [A]. Times `factors` it is the residual.
  using Row = Eigen::Matrix<double, QUANTITIES + 1, 1>;

  static Row factors(const Values& values);
  static Eigen::Matrix<double, QUANTITIES + 1, QUANTITIES> slopes(const Values& values);
  void addBlocks(const Parameters& parameters, const FrictionMap& friction, const std::vector<MotionSample>& samples);
  void setKnown(const Parameters& parameters, const FrictionMap& friction);
  void solve(const std::function<void()>& look);
  void solveOnce(double deviation, double correlation_rows);
  double share(std::size_t quantity) const;

  Eigen::MatrixXd blocks_;    // a row each
  Eigen::MatrixXd products_;  // transposed times blocks
  Values values_ = Values::Zero();
  Values start_ = Values::Zero();       // as configured
  Values known_ = Values::Zero();       // its deviation
  Values half_width_ = Values::Zero();  // of the 95 % interval
  std::array<bool, QUANTITIES> asked_{};
  std::array<std::string, QUANTITIES> refusal_;
};

/// Motor torque less load, inertia and friction, at one instant.
struct RippleRow
{
  double position;  ///< of the joint [rad]
  double velocity;  ///< [rad/s]
  double torque;    ///< at the joint [N.m]
};

/// The lines of TorqueRipple in that torque, by least squares, outliers less (Huber), with the resonance of what the
/// joint carries. A line that is lost in the residual is refused, and zero. Rows count up to the speed of KNOWN of
/// them, and to that at which a wave of two a turn of the motor still has two rows. Four a turn are refused if they
/// have fewer there.
class RippleFit
{
public:
  static constexpr double KNOWN = 0.95;  ///< of the rows

  /// `rows`: rows that move, every `period` [s] where no row is lost. `start`: what is configured, which the resonance
  /// falls back to without a line. `look` as in identify.
  RippleFit(std::vector<RippleRow> rows, double period, const TelemetryParameters& start, double ratio,
            const std::function<void()>& look);

  const TorqueRipple::Orders& orders() const { return orders_; }
  std::array<double, 2> line(std::size_t line) const { return { values_[2 * line], values_[2 * line + 1] }; }
  double amplitude(std::size_t line) const;  ///< [N.m at the joint]
  double halfWidth(std::size_t line) const;  ///< of its 95 % interval [N.m]
  double phase(std::size_t line) const;      ///< of the cosine at joint angle 0 [rad]
  const std::string& refusal(std::size_t line) const { return refusal_[line]; }

  void store(TelemetryParameters& parameters) const;  ///< writes the lines and their resonance

private:
  static constexpr std::size_t RESONANCE = 2 * TorqueRipple::LINES;  // where the response stands behind the lines
  static constexpr std::size_t VALUES = RESONANCE + 3;
  using Values = Eigen::Matrix<double, VALUES, 1>;

  bool anyLine() const;
  Eigen::MatrixXd waves(const double* response) const;
  Eigen::MatrixXd slopes(const Values& values) const;
  void chooseResonance(const std::function<void()>& look);
  void solve();
  bool refuseWorst();

  std::vector<RippleRow> rows_;
  Eigen::VectorXd torque_;  // of the rows
  TorqueRipple::Orders orders_;
  double fastest_;  // [rad/s]
  Values values_ = Values::Zero();
  Values half_width_ = Values::Zero();
  std::array<bool, TorqueRipple::LINES> present_{};
  std::array<std::string, TorqueRipple::LINES> refusal_;
};
}  // namespace hjt
