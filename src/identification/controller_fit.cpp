// SPDX-License-Identifier: BSD-3-Clause
#include "identification/controller_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

#include "base/number_text.hpp"

namespace hjt
{
namespace
{
constexpr int COLUMNS = 6;
constexpr int PIECES = 10;  // number of pieces of the recording; for the intervals, the fit omits one piece at a time
constexpr double QUANTILE = 2.26;      // 97.5 % quantile of Student's distribution for PIECES pieces
constexpr double LONGEST_LAG = 0.016;  // longest lag of the current behind the errors that the fit tries [s]
constexpr double LAG_STEP = 0.001;     // step from one lag to the next [s]
constexpr double SLOWEST = 1.0;        // width of the moving mean that is subtracted from each column of the fit [s]
constexpr double AT_REST = 0.01;       // speed of the smooth sign tanh(speed / AT_REST); faster is motion [rad/s]
constexpr double LEAST_MOTION = 5.0;   // least time in motion for a fit [s]
constexpr double LEAST_EXPLAINED = 1.0 / 3.0;
constexpr double WIDEST_RATIO = 0.5;  // largest half width of angle_current / speed_current over this ratio [-]
// Least jump of the set point's speed from row to row, beyond the changes of the neighbouring rows [rad/s].
constexpr double JUMP = 0.1;
constexpr double AT_LIMIT = 0.95;   // share of the limit above which a current counts as limited [-]
constexpr double TRANSIENT = 0.25;  // time before and after a jump or a limited current that the fit excludes [s]

using Column = Eigen::VectorXd;

/// The values minus their moving mean over `width` rows.
Column withoutSlow(const Column& values, Eigen::Index width)
{
  Column sums(values.size() + 1);
  sums[0] = 0.0;
  for (Eigen::Index i = 0; i < values.size(); ++i)
  {
    sums[i + 1] = sums[i] + values[i];
  }
  Column fast(values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i)
  {
    const Eigen::Index begin = std::max<Eigen::Index>(i - width / 2, 0);
    const Eigen::Index end = std::min(i + width / 2 + 1, values.size());
    fast[i] = values[i] - (sums[end] - sums[begin]) / static_cast<double>(end - begin);
  }
  return fast;
}

/// The values delayed by a number of `rows`, which may be a fraction, by linear interpolation.
Column delayed(const Column& values, double rows)
{
  Column before(values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i)
  {
    const double place = std::max(static_cast<double>(i) - rows, 0.0);
    const auto whole = static_cast<Eigen::Index>(place);
    const double share = place - static_cast<double>(whole);
    before[i] = share > 0.0 ? values[whole] + share * (values[whole + 1] - values[whole]) : values[whole];
  }
  return before;
}

struct Record
{
  Record(const std::vector<ControllerRow>& rows, double period)
    : angle_error(rows.size()), speed_error(rows.size()), others(rows.size(), COLUMNS - 2), current(rows.size())
  {
    double integral = 0.0;
    for (std::size_t k = 0; k < rows.size(); ++k)
    {
      const auto i = static_cast<Eigen::Index>(k);
      integral += period * rows[k].angle_error;
      angle_error[i] = rows[k].angle_error;
      speed_error[i] = rows[k].speed_error;
      others.row(i) << integral, std::tanh(rows[k].speed / AT_REST), rows[k].speed, rows[k].rigid_current;
      current[i] = rows[k].current - rows[k].rigid_current;
    }
  }

  Eigen::MatrixXd columns(double lag_rows, Eigen::Index width) const
  {
    Eigen::MatrixXd columns(current.size(), COLUMNS);
    columns.col(0) = withoutSlow(delayed(angle_error, lag_rows), width);
    columns.col(1) = withoutSlow(delayed(speed_error, lag_rows), width);
    for (Eigen::Index k = 2; k < COLUMNS; ++k)
    {
      columns.col(k) = withoutSlow(others.col(k - 2), width);
    }
    return columns;
  }

  Column angle_error;
  Column speed_error;
  Eigen::MatrixXd others;
  Column current;
};

/// 1 for rows in which the control is linear, else 0. `limit`: largest actual minus target current; 0: no limit [A].
Column linearRows(const std::vector<ControllerRow>& rows, double period, double limit)
{
  const auto count = static_cast<Eigen::Index>(rows.size());
  const auto reach = static_cast<Eigen::Index>(TRANSIENT / period);
  const auto step = [&](std::size_t k) { return rows[k].speed - rows[k - 1].speed; };
  Column linear = Column::Ones(count);
  for (std::size_t k = 2; k + 1 < rows.size(); ++k)
  {
    const bool jumps = std::abs(step(k) - 0.5 * (step(k - 1) + step(k + 1))) > JUMP;
    const bool stands = limit > 0.0 && std::abs(rows[k].current - rows[k].target_current) > AT_LIMIT * limit;
    if (jumps || stands)
    {
      const Eigen::Index begin = std::max<Eigen::Index>(static_cast<Eigen::Index>(k) - reach, 0);
      const Eigen::Index end = std::min<Eigen::Index>(static_cast<Eigen::Index>(k) + reach + 1, count);
      linear.segment(begin, end - begin).setZero();
    }
  }
  return linear;
}

/// Half widths of the first two coefficients and of their ratio, from fits that each omit one piece (jackknife).
Eigen::Vector3d halfWidths(const Eigen::MatrixXd& columns, const Column& values)
{
  Eigen::Matrix<double, 3, PIECES> found;
  const Eigen::Index rows = values.size();
  for (Eigen::Index piece = 0; piece < PIECES; ++piece)
  {
    const Eigen::Index begin = piece * rows / PIECES;
    const Eigen::Index end = (piece + 1) * rows / PIECES;
    Eigen::MatrixXd rest(rows - (end - begin), COLUMNS);
    Column of_rest(rest.rows());
    rest << columns.topRows(begin), columns.bottomRows(rows - end);
    of_rest << values.head(begin), values.tail(rows - end);
    const Column solved = rest.colPivHouseholderQr().solve(of_rest);
    found.col(piece) << solved[0], solved[1], solved[0] / solved[1];
  }
  const Eigen::Vector3d mean = found.rowwise().mean();
  return QUANTILE *
         ((PIECES - 1.0) / PIECES * (found.colwise() - mean).rowwise().squaredNorm()).array().sqrt().matrix();
}

/// Friction in the target current: its constant part [A], and its part per speed [A.s/rad].
Eigen::Vector2d fedForward(const std::vector<ControllerRow>& rows)
{
  Eigen::MatrixXd columns(rows.size(), 4);
  Column values(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k)
  {
    const auto i = static_cast<Eigen::Index>(k);
    columns.row(i) << std::tanh(rows[k].speed / AT_REST), rows[k].speed, rows[k].rigid_current, 1.0;
    values[i] = rows[k].target_current - rows[k].rigid_current;
  }
  return columns.colPivHouseholderQr().solve(values).head<2>();
}
}  // namespace

ControllerFit fitController(const std::vector<ControllerRow>& rows, double period, double torque_per_current,
                            const JointGains& usual, double feedback_limit)
{
  ControllerFit fit;
  fit.gains = usual;
  const auto moving =
      std::count_if(rows.begin(), rows.end(), [](const ControllerRow& row) { return std::abs(row.speed) > AT_REST; });
  if (static_cast<double>(moving) * period < LEAST_MOTION)
  {
    fit.refusal = "the joint moves for less than 5 s";
    return fit;
  }
  const Record record(rows, period);
  const auto width = static_cast<Eigen::Index>(SLOWEST / period);
  const Column linear = linearRows(rows, period, feedback_limit / torque_per_current);
  const Column values = linear.cwiseProduct(withoutSlow(record.current, width));
  const auto columns_at = [&](double lag) -> Eigen::MatrixXd
  { return linear.asDiagonal() * record.columns(lag / period, width); };
  double least = HUGE_VAL;
  for (double lag = 0.0; lag <= LONGEST_LAG; lag += LAG_STEP)
  {
    const Eigen::MatrixXd columns = columns_at(lag);
    const Column found = columns.colPivHouseholderQr().solve(values);
    const double left = (values - columns * found).squaredNorm();
    if (left < least)
    {
      least = left;
      fit.lag = lag;
      fit.angle_current = found[0];
      fit.speed_current = found[1];
    }
  }
  const Eigen::Vector3d half_widths = halfWidths(columns_at(fit.lag), values);
  fit.angle_half_width = half_widths[0];
  fit.speed_half_width = half_widths[1];
  fit.position_half_width = half_widths[2];
  fit.explained = 1.0 - least / values.squaredNorm();
  // The negated comparison also rejects NaN.
  if (!(fit.angle_half_width < fit.angle_current && fit.speed_half_width < fit.speed_current))
  {
    fit.refusal = "the interval of a gain contains zero";
  }
  else if (!(fit.explained > LEAST_EXPLAINED))
  {
    fit.refusal = "the errors of angle and speed explain less than a third of the current";
  }
  else if (const double sum = fit.angle_current / fit.speed_current;
           !(fit.position_half_width < std::min(WIDEST_RATIO * sum, sum - 1.0 / usual.integral_time)))
  {
    fit.refusal = "the recording does not determine the position gain: position gain + 1 / integral time is " +
                  roundedText(sum, 3) + " +- " + roundedText(fit.position_half_width, 3) +
                  " 1/s, and 1 / integral time alone is " + roundedText(1.0 / usual.integral_time, 3) + " 1/s";
  }
  else
  {
    const double by_integral = std::min(1.0 / usual.integral_time, 0.5 * sum);
    const Eigen::Vector2d friction = torque_per_current * fedForward(rows);
    fit.gains = { sum - by_integral, torque_per_current * fit.speed_current, 1.0 / by_integral, friction[0],
                  friction[1] };
  }
  return fit;
}
}  // namespace hjt
