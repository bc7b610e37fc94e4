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
/// Number of correlated rows that carry as much information as one independent row: 1 + 2 times the sum of the
/// autocorrelations up to their first negative value. Takes as long as a Fourier transform of the rows.
double correlationRows(const Eigen::VectorXd& residuals);

/// Normal equations of a cost near some values: slopes and curvature of the linearised model.
struct NormalEquations
{
  double cost{};
  Eigen::VectorXd gradient;
  Eigen::MatrixXd normal;
};

/// Normal equations for errors that are linear in the columns. Errors beyond `outlier` have linear weight (Huber).
/// `products`: transposed columns times columns.
NormalEquations huberEquations(const Eigen::VectorXd& errors, const Eigen::MatrixXd& columns, Eigen::MatrixXd products,
                               double outlier);

/// Values of least cost between bounds, from a start (Levenberg and Marquardt). Equal bounds fix a value.
Eigen::VectorXd leastCost(const Eigen::VectorXd& start, const Eigen::VectorXd& lowest, const Eigen::VectorXd& highest,
                          const std::function<NormalEquations(const Eigen::VectorXd& values)>& equations);

/// Half widths of the 95 % intervals of the columns' coefficients, widened by the correlation of the errors; rows
/// ordered by time. 0 for a column that is zero.
Eigen::VectorXd halfWidths(const Eigen::VectorXd& errors, const Eigen::MatrixXd& columns);

/// Gain, offset, inertia and friction of a joint from the moving rows: the most probable values with a prior (maximum a
/// posteriori).
///
///   current = (load + J n^2 a + s (rest + P preload + G grease + F flanks + V n |w|)) / gain + offset
/// with the shares of FrictionMap, w = motor speed, s = its sign. Each row of the fit is the mean over BLOCK, in which
/// the ripple of the teeth averages out. The rows are weighted by their deviation, with less weight for outliers
/// (Huber), and by the correlation of their residual. The prior of each value is normal about the configured one with
/// the deviation `known`: a value that the motion hardly shows stays near it and does not distort others. No friction
/// can be negative. A quantity whose deviation the motion does not halve is refused and keeps its configured value; the
/// others are fitted again. The last fit adds a Stribeck term, S n exp(-(w/v)^2) with v = motor.stribeck_velocity,
/// which stays if its interval does not contain zero.
class FrictionFit
{
public:
  enum Quantity
  {
    GAIN,      ///< inverse gain [A/(N.m)]
    OFFSET,    ///< [A]
    INERTIA,   ///< inertia of the motor, minus the part in the load [kg.m^2]
    PRELOAD,   ///< [N]
    GREASE,    ///< relative to the configured one [-]
    FLANKS,    ///< relative to the configured one [-]
    VISCOUS,   ///< at the motor [N.m.s/rad]
    STRIBECK,  ///< at the motor [N.m]
    QUANTITIES
  };
  using Values = Eigen::Matrix<double, QUANTITIES, 1>;

  static constexpr double MOVING = 0.01;  ///< joint speed from which a row counts as moving [rad/s]
  /// longest time over which successive rows are averaged to one row of the fit [s]
  static constexpr double BLOCK = 0.1;

  /// `look` as in identify. @throws InputError if the samples hardly move.
  FrictionFit(const Parameters& parameters, const FrictionMap& friction, const std::vector<MotionSample>& samples,
              const std::function<void()>& look);

  double value(Quantity quantity) const { return values_[quantity]; }
  /// half width of the 95 % interval; 0 if refused
  double halfWidth(Quantity quantity) const { return half_width_[quantity]; }
  /// reason of a refusal; empty: identified
  const std::string& refusal(Quantity quantity) const { return refusal_[quantity]; }

private:
  /// Row of a block: the torque at the joint per unit of each quantity, at GAIN the known torque [N.m], at OFFSET 1,
  /// and the current [A]. Its product with `factors` is the residual.
  using Row = Eigen::Matrix<double, QUANTITIES + 1, 1>;

  static Row factors(const Values& values);
  static Eigen::Matrix<double, QUANTITIES + 1, QUANTITIES> slopes(const Values& values);
  void addBlocks(const Parameters& parameters, const FrictionMap& friction, const std::vector<MotionSample>& samples);
  void setKnown(const Parameters& parameters, const FrictionMap& friction);
  void solve(const std::function<void()>& look);
  void solveOnce(double deviation, double correlation_rows);
  double share(std::size_t quantity) const;

  Eigen::MatrixXd blocks_;    // a row for each block
  Eigen::MatrixXd products_;  // transposed blocks times blocks
  Values values_ = Values::Zero();
  Values start_ = Values::Zero();       // configured values
  Values known_ = Values::Zero();       // prior deviation of each value
  Values half_width_ = Values::Zero();  // half width of each 95 % interval
  std::array<bool, QUANTITIES> asked_{};
  std::array<std::string, QUANTITIES> refusal_;
};

/// Motor torque minus load, inertia and friction at one instant.
struct RippleRow
{
  double position;  ///< angle of the joint [rad]
  double velocity;  ///< speed of the joint [rad/s]
  double torque;    ///< torque at the joint [N.m]
};

/// Fit of the lines of TorqueRipple, with the resonance of the load, to that torque by least squares with less weight
/// for outliers (Huber). A line below the residual is refused and zero. The fit uses rows up to the speed that a share
/// KNOWN of them does not exceed, and up to the speed at which a wave of two in a turn of the motor has two rows. Lines
/// of four in a turn are refused if they have fewer than two rows there.
class RippleFit
{
public:
  static constexpr double KNOWN = 0.95;  ///< share of the rows

  /// `rows`: moving rows with the sampling period `period` [s]. `start`: configured values, to which the resonance
  /// returns if there is no line. `look` as in identify.
  RippleFit(std::vector<RippleRow> rows, double period, const TelemetryParameters& start, double ratio,
            const std::function<void()>& look);

  const TorqueRipple::Orders& orders() const { return orders_; }
  std::array<double, 2> line(std::size_t line) const { return { values_[2 * line], values_[2 * line + 1] }; }
  double amplitude(std::size_t line) const;  ///< amplitude [N.m at the joint]
  double halfWidth(std::size_t line) const;  ///< half width of its 95 % interval [N.m]
  double phase(std::size_t line) const;      ///< phase of the cosine at joint angle 0 [rad]
  const std::string& refusal(std::size_t line) const { return refusal_[line]; }

  void store(TelemetryParameters& parameters) const;  ///< stores the lines and their resonance

private:
  static constexpr std::size_t RESONANCE = 2 * TorqueRipple::LINES;  // index of the resonance, after the lines
  static constexpr std::size_t VALUES = RESONANCE + 3;
  using Values = Eigen::Matrix<double, VALUES, 1>;

  bool anyLine() const;
  Eigen::MatrixXd waves(const double* response) const;
  Eigen::MatrixXd slopes(const Values& values) const;
  void chooseResonance(const std::function<void()>& look);
  void solve();
  bool refuseWorst();

  std::vector<RippleRow> rows_;
  Eigen::VectorXd torque_;  // torque of each row
  TorqueRipple::Orders orders_;
  double fastest_;  // speed limit of the fit [rad/s]
  Values values_ = Values::Zero();
  Values half_width_ = Values::Zero();
  std::array<bool, TorqueRipple::LINES> present_{};
  std::array<std::string, TorqueRipple::LINES> refusal_;
};
}  // namespace hjt
