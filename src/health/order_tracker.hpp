// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/health/signal_indicators.hpp"
#include "health/running_regression.hpp"

namespace hjt
{
/// Cosine and sine of many multiples of one angle. If a multiple is the sum or the difference of two earlier multiples,
/// the class multiplies the rotations by these two multiples, and calls neither sine nor cosine.
template <std::size_t COUNT>
class AngleMultiples
{
public:
  explicit AngleMultiples(const std::array<double, COUNT>& multiples)
  {
    for (std::size_t k = 0; k < COUNT; ++k)
    {
      rules_[k] = rule(multiples, k);
    }
  }

  /// Writes cosine and sine of each multiple, one after the other, into `rotations`.
  void at(double angle, double* rotations) const noexcept
  {
    for (std::size_t k = 0; k < COUNT; ++k)
    {
      const Rule& rule = rules_[k];
      const double* a = rotations + 2 * rule.first;
      const double* b = rotations + 2 * rule.second;
      double* to = rotations + 2 * k;
      if (rule.sign == 0.0)
      {
        to[0] = std::cos(rule.multiple * angle);
        to[1] = std::sin(rule.multiple * angle);
        continue;
      }
      const double sine = rule.sign * b[1];
      to[0] = a[0] * b[0] - a[1] * sine;
      to[1] = a[1] * b[0] + a[0] * sine;
    }
  }

private:
  struct Rule
  {
    double multiple{};
    std::size_t first{};
    std::size_t second{};
    double sign{};  // sign of the second multiple; 0: the multiple is neither sum nor difference of two others
  };

  static Rule rule(const std::array<double, COUNT>& multiples, std::size_t k)
  {
    constexpr double ROUNDING = 1e-14;
    const double multiple = multiples[k];
    for (std::size_t i = 0; i < k; ++i)
    {
      for (std::size_t j = 0; j < k; ++j)
      {
        for (const double sign : { 1.0, -1.0 })
        {
          if (std::abs(multiples[i] + sign * multiples[j] - multiple) <= ROUNDING * std::abs(multiple))
          {
            return { multiple, i, j, sign };
          }
        }
      }
    }
    return { multiple, 0, 0, 0.0 };
  }

  std::array<Rule, COUNT> rules_;
};

/// A sample of the signals that OrderTracker fits lines to.
struct LineSample
{
  double motor_angle{};      ///< [rad]
  double output_angle{};     ///< [rad]
  double direction{};        ///< direction of motion, +1 or -1
  double speed{};            ///< mean speed over about a turn of the motor, signed [rad/s]
  double load{};             ///< load at the joint; 0 if unknown [N.m]
  double kinematic_error{};  ///< motor angle / ratio - output angle [rad]
  double motor_torque{};     ///< [N.m]
  double ripple{};           ///< ripple of the motor angle (RippleFilter) [rad]
  double weight{ 1.0 };      ///< inverse of the noise's variance, relative to that of a calm motion [-]
};

struct LineFit
{
  bool valid{};
  double cosine{};  ///< cosine part of the line [rad] or [N.m]
  double sine{};    ///< sine part of the line [rad] or [N.m]
  double error{};   ///< standard error of the amplitude [rad] or [N.m]

  double amplitude() const noexcept { return std::hypot(cosine, sine); }
};

/// Estimates amplitude and phase of lines at known orders, in all LineSignals together.
///
/// Law:   y(t) = c . n(t) + sum_k m_k(t) ( a_k cos(o_k theta(t)) + b_k sin(o_k theta(t)) ),  weighted least
///        squares over the samples of a window
/// where  y      a LineSignal;  a, b, c  coefficients;  theta  motor angle [rad];  o_k  order [1/turn]
///        m      T / T_r minus its mean for a line in proportion to the load, d T / T_r minus its mean for a part of
///               this line that lags, and 1 for all other lines, which therefore are the lines at the mean load
///        T, d   load [N.m], direction;  T_r  rated torque [N.m]
///        n      regressors that are no lines: 1, d, speed, cos and sin of the output angle (weight, runout), and T,
///               T |T|, T^3 (because the torsion is not linear in the load)
/// The tracker does not resample. Speed and direction may change, because a line is a function of the angle. A common
/// fit of all lines keeps one line from leaking into another.
///
/// The tracker does not fit a line whose order is above 0.8 times half the number of samples per turn. A line is not
/// valid if the travel of the motor does not separate the line from another line (MAX_INFLATION). Orders o1 and o2 need
/// about 0.3 / |o1 - o2| turns, for example 15 turns for 1.98 and 2. Lines in proportion to the load need a load that
/// varies. Lines that lag also need motion in both directions.
class OrderTracker
{
public:
  /// `rated_torque` [N.m].
  OrderTracker(const LineOrders& orders, double rated_torque)
    : rated_torque_(rated_torque)
    , orders_(sorted(orders))
    , places_(placesOf(orders, orders_))
    , rotations_(orders_)
    , row_(Row::Zero())
    , targets_(Eigen::Vector3d::Zero())
    , regression_(COLUMNS, LINE_SIGNALS)
  {
  }

  /// Removes the samples of the window. The results of the last fit stay.
  void reset() noexcept { regression_.reset(); }

  void add(const LineSample& sample) noexcept
  {
    fill(sample, row_);
    targets_ = targetsOf(sample);
    regression_.add(row_, targets_, sample.weight);
  }

  /// Fits the lines. `angle_step`: mean motor travel between two samples [rad]. Returns false if samples are too few.
  bool fit(double angle_step) noexcept
  {
    const double highest = USED_BAND * 0.5 * TWO_PI / angle_step;
    const auto seen = std::lower_bound(orders_.begin(), orders_.end(), highest) - orders_.begin();
    const int used = FIRST_LINE + 2 * static_cast<int>(seen);
    prepareLoaded(used);
    const bool fitted = regression_.fit(used);
    used_ = fitted ? used : 0;
    return fitted;
  }

  LineFit line(LineSignal signal, std::size_t line) const noexcept
  {
    const bool loaded = line >= FIRST_LOADED;
    const int column = loaded ? NUISANCES + 2 * static_cast<int>(line - FIRST_LOADED) :
                                FIRST_LINE + 2 * static_cast<int>(places_[line]);
    if (column >= used_ || (loaded && !loaded_[line - FIRST_LOADED]) || regression_.inflation(column) > MAX_INFLATION ||
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

  /// Whether the last fit separated all its lines. Only then the fit can predict signals outside its window.
  bool complete() const noexcept
  {
    bool determined = used_ > FIRST_LINE;
    for (int column = FIRST_LINE; column < used_; ++column)
    {
      determined = determined && !(regression_.inflation(column) > MAX_INFLATION);
    }
    return determined;
  }

  /// Kinematic error of the last added sample minus the kinematic error by the last fit [rad].
  double residual() const noexcept { return targets_[0] - row_.dot(regression_.coefficients(0)); }

  /// Signals of a sample, by LineSignal, minus the values that the last fit predicts without the lines `without`.
  Eigen::Vector3d beside(const LineSample& sample, const std::array<bool, FIRST_LOADED>& without) const noexcept
  {
    Row row;
    fill(sample, row);
    for (std::size_t line = 0; line < FIRST_LOADED; ++line)
    {
      if (without[line])
      {
        row.segment<2>(FIRST_LINE + 2 * static_cast<int>(places_[line])).setZero();
      }
    }
    Eigen::Vector3d beside = targetsOf(sample);
    for (int target = 0; target < beside.size(); ++target)
    {
      beside[target] -= row.dot(regression_.coefficients(target));
    }
    return beside;
  }

private:
  static constexpr double MAX_INFLATION = 4.0;  // largest factor by which other lines may inflate a line's variance [-]
  static constexpr double USED_BAND = 0.8;      // highest order of a line, as a share of half the samples in a turn [-]
  static constexpr double LEAST_LOAD = 0.05;    // least spread of the load, as a share of the rated torque [-]
  static constexpr double ONE_WAY = 0.9;        // least |mean direction| of a motion that counts as one-way [-]

  // Columns of the regression: regressors that are no lines, lines in proportion to the load, other lines by order.
  static constexpr int DIRECTION = 1;
  static constexpr int LOAD = 5;
  static constexpr int NUISANCES = 8;
  static constexpr int LOADED_COLUMNS = 2 * static_cast<int>(LOADED_COUNT);
  static constexpr int FIRST_LINE = NUISANCES + LOADED_COLUMNS;
  static constexpr int COLUMNS = FIRST_LINE + 2 * static_cast<int>(FIRST_LOADED);

  using Row = Eigen::Matrix<double, COLUMNS, 1>;
  using Places = std::array<std::size_t, LINE_COUNT>;
  using PlainOrders = std::array<double, FIRST_LOADED>;

  static PlainOrders sorted(const LineOrders& orders)
  {
    PlainOrders plain{};
    std::copy_n(orders.begin(), plain.size(), plain.begin());
    std::sort(plain.begin(), plain.end());
    return plain;
  }

  static Places placesOf(const LineOrders& orders, const PlainOrders& sorted)
  {
    Places places{};
    std::transform(
        orders.begin(), orders.end(), places.begin(),
        [&](double order)
        { return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), order) - sorted.begin()); });
    return places;
  }

  static Eigen::Vector3d targetsOf(const LineSample& sample) noexcept
  {
    return { sample.kinematic_error, sample.motor_torque, sample.ripple };
  }

  void fill(const LineSample& sample, Row& row) const noexcept
  {
    row.head<NUISANCES>() << 1.0, sample.direction, sample.speed, std::cos(sample.output_angle),
        std::sin(sample.output_angle), sample.load, sample.load * std::abs(sample.load),
        sample.load * sample.load * sample.load;
    rotations_.at(sample.motor_angle, row.data() + FIRST_LINE);
    const double load = sample.load / rated_torque_;
    const std::array factors{ load - mean_load_, sample.direction * load - mean_lagging_load_ };
    for (int i = 0; i < LOADED_COLUMNS; ++i)
    {
      row[NUISANCES + i] = factors[i < LOADED_COLUMNS / 2 ? 0 : 1] * row[baseOf(i)];
    }
  }

  /// Column of the line that has the order of column `i` of the lines in proportion to the load, but is at mean load.
  int baseOf(int i) const noexcept
  {
    return FIRST_LINE + 2 * static_cast<int>(places_[FIRST_LOADED + static_cast<std::size_t>(i) / 2]) + i % 2;
  }

  /// Subtracts the mean of m from the columns of the lines in proportion to the load, or drops an undetermined line.
  void prepareLoaded(int used) noexcept
  {
    const double weighted_load = regression_.mean(LOAD, 0) / rated_torque_;
    const double lagging = regression_.mean(LOAD, DIRECTION) / rated_torque_;
    const double square = regression_.mean(LOAD, LOAD) / (rated_torque_ * rated_torque_);
    const bool varies = square - weighted_load * weighted_load > LEAST_LOAD * LEAST_LOAD;
    const bool both_ways = std::abs(regression_.mean(DIRECTION, 0)) < ONE_WAY;
    const std::array shares{ weighted_load - mean_load_, lagging - mean_lagging_load_ };
    for (int i = 0; i < LOADED_COLUMNS; ++i)
    {
      const bool lags = i >= LOADED_COLUMNS / 2;
      bool& fitted = loaded_[static_cast<std::size_t>(i) / 2];
      fitted = varies && (both_ways || !lags) && baseOf(i) < used;
      if (fitted)
      {
        regression_.subtract(NUISANCES + i, baseOf(i), shares[lags ? 1 : 0]);
      }
      else
      {
        regression_.drop(NUISANCES + i);
      }
    }
    mean_load_ = weighted_load;
    mean_lagging_load_ = lagging;
  }

  const double rated_torque_;   // [N.m]
  double mean_load_{};          // mean load in the previous window, over the rated torque [-]
  double mean_lagging_load_{};  // mean of load times direction in the previous window, over the rated torque [-]
  std::array<bool, LOADED_COUNT> loaded_{};  // lines in proportion to the load that the last fit has
  PlainOrders orders_;                       // ascending, so that lines too fast for the samples are the last columns
  Places places_;                            // index of each line's order in orders_
  AngleMultiples<FIRST_LOADED> rotations_;
  Row row_;
  Eigen::Vector3d targets_;
  RunningRegression regression_;
  int used_{};  // number of columns of the last fit
};

/// Estimates the slip of the wave generator's bearing over a window from the lines of races and balls in the ripple of
/// the motor.
///
/// Law:   L(s) = sum_k |F_k(s)|^2 / n_k,   F_k(s) = sum w r exp(-j o_k(s) theta),   s* = argmax L(s), 0 <= s <= MOST
/// where  k       index of a line of the bearing; the second sum is over the samples;  w  weight of a sample
///        r       ripple minus its value by the fit of the window without the bearing's lines [rad]
///        theta   motor angle [rad];  o_k(s)  order of line k with slip s (trackedOrders)
///        n_k     noise near line k: median of |F_k|^2 over slips from -MOST to 2 MOST, divided by ln 2
/// The slip is 0 unless L(s*) of the ripple exceeds L(0) by CLEARLY. Noise alone exceeds this limit in less than one
/// window in 1000. The slip is also 0 if L(0) of the kinematic error exceeds L(s*) of the kinematic error by CLEARLY.
/// Source: bearings slip by 1 to 2 % (Randall and Antoni, Mech. Syst. Signal Process. 25, 2011, 485-520).
///
/// The class searches for no slip at an even speed, because sampling then folds the lines of the teeth to sharp lines,
/// two orders apart like the lines of a race. The class keeps every sample of a window, so it is for recordings and
/// data sets, not for a real-time loop. It searches for no slip in windows of more than a million samples or 500 turns.
class BearingSlip
{
public:
  static constexpr double MOST = 0.03;  ///< largest slip that the class searches for [-]

  explicit BearingSlip(const Parameters& parameters);

  void reset() noexcept { samples_.clear(); }
  void add(const LineSample& sample)
  {
    if (samples_.size() <= MOST_SAMPLES)
    {
      samples_.push_back(sample);
    }
  }

  /// Slip of the window [-]; 0: no slip found. `fitted`: fit of the lines without slip to the samples.
  double find(const OrderTracker& fitted) const;
  /// Fit of all lines to the samples, at the orders of a bearing with the slip `slip`. `angle_step`: see `fit`.
  OrderTracker refit(double slip, double angle_step) const;

private:
  static constexpr std::size_t MOST_SAMPLES = 1000000;

  struct BearingLine;
  std::vector<BearingLine> linesOf(const OrderTracker& fitted) const;

  GearParameters gear_;
  BearingParameters bearing_;
  double rated_torque_;  // [N.m]
  std::vector<LineSample> samples_;
};
}  // namespace hjt
