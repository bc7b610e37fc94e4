// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/health/signal_indicators.hpp"
#include "harmonic_joint_twin/health/tracked_lines.hpp"
#include "health/angle_multiples.hpp"
#include "health/running_regression.hpp"

namespace hjt
{
/// One sample as the tracker takes it.
struct LineSample
{
  double motor_angle{};      ///< [rad]
  double output_angle{};     ///< [rad]
  double direction{};        ///< +1 or -1
  double speed{};            ///< mean over about a turn, signed [rad/s]
  double load{};             ///< at the joint, 0: not known [N.m]
  double kinematic_error{};  ///< motor angle / ratio - output angle [rad]
  double motor_torque{};     ///< [N.m]
  double ripple{};           ///< of the motor angle, see RippleFilter [rad]
};

struct LineFit
{
  bool valid{};
  double cosine{};  ///< [rad] or [N.m]
  double sine{};
  double error{};  ///< standard error of the amplitude

  double amplitude() const noexcept { return std::hypot(cosine, sine); }
};

/// Amplitude and phase of lines at known orders, in all LineSignals at once.
///
/// Law:   y(t) = b . n(t) + sum_k ( a_k cos(o_k theta(t)) + b_k sin(o_k theta(t)) ),  least squares over one window
/// where  theta  motor angle of the very sample [rad];  o_k  order [1/turn]
///        n      what is no line: 1, direction, speed, cos and sin of the output angle (weight, runout), load T, T |T|,
///               T^3 (the torsion is no straight line over the load)
/// Nothing is resampled and no speed need be constant: the line is a function of the angle, whichever way and however
/// fast it is passed, and the motion may go back and forth. Lines fitted at once do not leak into each other.
///
/// Not valid, and not fitted: a line above 0.8 of half the samples a turn. Not valid either: one that the travel cannot
/// tell from another (variance inflated more than fourfold: orders o1, o2 need about 0.3 / |o1 - o2| turns in all, 15
/// for 1.98 beside 2).
class OrderTracker
{
public:
  explicit OrderTracker(const LineOrders& orders)
    : orders_(sorted(orders))
    , places_(placesOf(orders))
    , rotations_(orders_)
    , row_(Eigen::VectorXd::Zero(COLUMNS))
    , targets_(Eigen::Vector3d::Zero())
    , regression_(COLUMNS, LINE_SIGNALS)
  {
  }

  /// forgets the window, not the last fit
  void reset() noexcept { regression_.reset(); }

  void add(const LineSample& sample) noexcept
  {
    row_.head<NUISANCES>() << 1.0, sample.direction, sample.speed, std::cos(sample.output_angle),
        std::sin(sample.output_angle), sample.load, sample.load * std::abs(sample.load),
        sample.load * sample.load * sample.load;
    rotations_.at(sample.motor_angle, row_.data() + NUISANCES);
    targets_ = { sample.kinematic_error, sample.motor_torque, sample.ripple };
    regression_.add(row_, targets_);
  }

  /// `angle_step`: mean travel between two samples [rad]. False: too little came.
  bool fit(double angle_step) noexcept
  {
    const double highest = USED_BAND * 0.5 * TWO_PI / angle_step;
    const auto seen = std::lower_bound(orders_.begin(), orders_.end(), highest) - orders_.begin();
    const int used = NUISANCES + 2 * static_cast<int>(seen);
    const bool fitted = regression_.fit(used);
    used_ = fitted ? used : 0;
    return fitted;
  }

  LineFit line(LineSignal signal, std::size_t line) const noexcept
  {
    const int column = NUISANCES + 2 * static_cast<int>(places_[line]);
    if (column >= used_ || regression_.inflation(column) > MAX_INFLATION ||
        regression_.inflation(column + 1) > MAX_INFLATION)
    {
      return {};
    }
    const auto target = static_cast<int>(signal);
    LineFit fit;
    fit.valid = true;
    fit.cosine = regression_.coefficient(column, target);
    fit.sine = regression_.coefficient(column + 1, target);
    fit.error = std::sqrt(0.5) *
                std::hypot(regression_.standardError(column, target), regression_.standardError(column + 1, target));
    return fit;
  }

  /// Whether the last fit determined every line. One that it did not determine can take any value outside the window.
  bool complete() const noexcept
  {
    bool determined = used_ > NUISANCES;
    for (int column = NUISANCES; column < used_; ++column)
    {
      determined = determined && !(regression_.inflation(column) > MAX_INFLATION);
    }
    return determined;
  }

  /// Kinematic error of the last added sample less what the last fit makes of it [rad].
  double residual() const noexcept { return targets_[0] - row_.dot(regression_.coefficients(0)); }

private:
  static constexpr double MAX_INFLATION = 4.0;  // of a line's variance by its neighbours [-]
  static constexpr double USED_BAND = 0.8;      // of half the samples a turn [-]

  static constexpr int NUISANCES = 8;
  static constexpr int COLUMNS = NUISANCES + 2 * static_cast<int>(LINE_COUNT);

  using Places = std::array<std::size_t, LINE_COUNT>;

  static LineOrders sorted(LineOrders orders)
  {
    std::sort(orders.begin(), orders.end());
    return orders;
  }

  static Places placesOf(const LineOrders& orders)
  {
    Places places{};
    for (std::size_t line = 0; line < LINE_COUNT; ++line)
    {
      places[line] = static_cast<std::size_t>(
          std::count_if(orders.begin(), orders.end(), [&](double other) { return other < orders[line]; }));
    }
    return places;
  }

  LineOrders orders_;  // the highest stand last, so that what the samples cannot show is the tail of the columns
  Places places_;      // of the lines among them
  AngleMultiples<LINE_COUNT> rotations_;
  Eigen::VectorXd row_;
  Eigen::Vector3d targets_;
  RunningRegression regression_;
  int used_{};  // columns of the last fit
};
}  // namespace hjt
