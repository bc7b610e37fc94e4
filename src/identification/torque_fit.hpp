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
/// autocorrelations up to their first negative value. The computation takes as long as a Fourier transform of the rows.
double correlationRows(const Eigen::VectorXd& residuals);

/// Gradient of a cost function at some values, and its curvature `normal` for the linearised model.
struct NormalEquations
{
  double cost{};
  Eigen::VectorXd gradient;
  Eigen::MatrixXd normal;
};

/// Normal equations for errors that are linear in the coefficients of the columns. The cost of an error beyond
/// `outlier` rises linearly (Huber). `products`: transposed columns times columns.
NormalEquations huberEquations(const Eigen::VectorXd& errors, const Eigen::MatrixXd& columns, Eigen::MatrixXd products,
                               double outlier);

/// Finds the values of least cost between bounds, from a start (Levenberg and Marquardt). Equal bounds fix a value.
Eigen::VectorXd leastCost(const Eigen::VectorXd& start, const Eigen::VectorXd& lowest, const Eigen::VectorXd& highest,
                          const std::function<NormalEquations(const Eigen::VectorXd& values)>& equations);

/// Half widths of the 95 % intervals of the columns' coefficients, from rows in the order of time. Correlation of the
/// errors widens the intervals. The half width of a column of zeros is 0.
Eigen::VectorXd halfWidths(const Eigen::VectorXd& errors, const Eigen::MatrixXd& columns);

/// Gain, offset, inertia and friction of a joint, from moving rows: the most probable values with a prior (maximum a
/// posteriori).
///
///   current = (load + J n^2 a + s n (rest + P preload + G grease + F flanks + V |w|)) / gain + offset
/// with J, P, G, F and V the quantities INERTIA to VISCOUS; n the ratio; a the acceleration of the joint; w the speed
/// of the motor, s its sign; rest, grease and flanks the shares of FrictionMap at the motor; preload the friction per
/// preload. A row of the fit is a mean over up to BLOCK, in which the ripple of the teeth averages out. Rows are
/// weighted by standard deviation and correlation of their errors; outliers have less weight (Huber). The prior of each
/// value is normal, with the configured value as mean and `known_` as standard deviation. So a value that the motion
/// hardly shows stays near its configured value and does not distort other values. No friction can be negative. A
/// quantity is refused and keeps its configured value if the motion does not halve its standard deviation; then the
/// others are fitted again. A last fit adds a Stribeck term S exp(-(w/v)^2) to the bracket, with v =
/// motor.stribeck_velocity. The result contains S if its interval excludes zero.
class FrictionFit
{
public:
  enum Quantity
  {
    GAIN,      ///< inverse of the gain [A/(N.m)]
    OFFSET,    ///< offset of the current [A]
    INERTIA,   ///< inertia of the motor, without the part that the load contains [kg.m^2]
    PRELOAD,   ///< preload of the bearing [N]
    GREASE,    ///< friction of the grease over the configured one [-]
    FLANKS,    ///< friction of the flanks over the configured one [-]
    VISCOUS,   ///< viscous friction at the motor [N.m.s/rad]
    STRIBECK,  ///< Stribeck rise of the friction at the motor [N.m]
    QUANTITIES
  };
  using Values = Eigen::Matrix<double, QUANTITIES, 1>;

  static constexpr double MOVING = 0.01;  ///< least speed of the joint in a moving row [rad/s]
  /// Longest time over which successive rows are averaged to one row of the fit [s].
  static constexpr double BLOCK = 0.1;

  /// `look` is called regularly, as by `identify`. @throws InputError if the joint hardly moves.
  FrictionFit(const Parameters& parameters, const FrictionMap& friction, const std::vector<MotionSample>& samples,
              const std::function<void()>& look);

  double value(Quantity quantity) const { return values_[quantity]; }
  /// Half width of the 95 % interval, in the unit of the quantity; 0 if the quantity is refused.
  double halfWidth(Quantity quantity) const { return half_width_[quantity]; }
  /// Reason why the quantity is refused; empty if it is identified.
  const std::string& refusal(Quantity quantity) const { return refusal_[quantity]; }

private:
  /// A row of the fit: torque at the joint per unit of each quantity, in place of GAIN the known torque [N.m], in place
  /// of OFFSET 1, and the current [A]. The product of a row and `factors` is the error of the current.
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
  Values start_ = Values::Zero();       // values that the configuration gives
  Values known_ = Values::Zero();       // standard deviation of each value's prior
  Values half_width_ = Values::Zero();  // half width of each 95 % interval
  std::array<bool, QUANTITIES> asked_{};
  std::array<std::string, QUANTITIES> refusal_;
};

/// Torque at the joint that the model without ripple does not explain, at one instant.
struct RippleRow
{
  double position;  ///< angle of the joint [rad]
  double velocity;  ///< speed of the joint [rad/s]
  double torque;    ///< measured minus predicted torque at the joint [N.m]
};

/// Fits the lines of TorqueRipple and the resonance of the load to RippleRow::torque by least squares, with less weight
/// for outliers (Huber). A line whose interval is too wide is refused and zero. Faster rows than the lower of two
/// speeds are omitted: the speed that a share KNOWN of the rows does not exceed, and that at which a line of two cycles
/// per turn of the motor has two rows per cycle. A line of four cycles is refused if it has fewer rows per cycle there.
class RippleFit
{
public:
  static constexpr double KNOWN = 0.95;  ///< share of the rows, the slowest, that the fit uses [-]

  /// `rows`: moving rows with the sampling period `period` [s]. `start`: configured values, which the resonance keeps
  /// if no line is found. `look` is called as in `identify`.
  RippleFit(std::vector<RippleRow> rows, double period, const TelemetryParameters& start, double ratio,
            const std::function<void()>& look);

  const TorqueRipple::Orders& orders() const { return orders_; }
  std::array<double, 2> line(std::size_t line) const { return { values_[2 * line], values_[2 * line + 1] }; }
  double amplitude(std::size_t line) const;  ///< amplitude of a line [N.m at the joint]
  double halfWidth(std::size_t line) const;  ///< half width of the amplitude's 95 % interval [N.m]
  double phase(std::size_t line) const;      ///< phase of the line's cosine at joint angle 0 [rad]
  const std::string& refusal(std::size_t line) const { return refusal_[line]; }

  void store(TelemetryParameters& parameters) const;  ///< stores lines, resonance, damping and lag

private:
  static constexpr std::size_t RESONANCE = 2 * TorqueRipple::LINES;  // index of the resonance in Values
  static constexpr std::size_t VALUES = RESONANCE + 3;
  using Values = Eigen::Matrix<double, VALUES, 1>;

  bool anyLine() const;
  Eigen::MatrixXd waves(const double* response) const;
  Eigen::MatrixXd slopes(const Values& values) const;
  void chooseResonance(const std::function<void()>& look);
  void solve();
  bool refuseWorst();

  std::vector<RippleRow> rows_;
  Eigen::VectorXd torque_;  // torque of each row [N.m]
  TorqueRipple::Orders orders_;
  double fastest_;  // largest speed of the joint in the fit [rad/s]
  Values values_ = Values::Zero();
  Values half_width_ = Values::Zero();
  std::array<bool, TorqueRipple::LINES> present_{};
  std::array<std::string, TorqueRipple::LINES> refusal_;
};
}  // namespace hjt
