// SPDX-License-Identifier: BSD-3-Clause
#include "health/order_tracker.hpp"

#include <cmath>

#include "gear/angle.hpp"

namespace hjt
{
namespace
{
constexpr double MAX_INFLATION = 4.0;  // of a line's variance by its neighbours [-]
constexpr double USED_BAND = 0.8;      // of half the samples a turn [-]
}  // namespace

double LineFit::amplitude() const noexcept
{
  return std::hypot(cosine, sine);
}

OrderTracker::OrderTracker(const LineOrders& orders)
  : orders_(orders), row_(Eigen::VectorXd::Zero(COLUMNS)), targets_(0.0, 0.0), regression_(COLUMNS, LINE_SIGNALS)
{
}

void OrderTracker::reset() noexcept
{
  regression_.reset();
}

void OrderTracker::add(const LineSample& sample) noexcept
{
  row_.head<NUISANCES>() << 1.0, sample.direction, sample.speed, std::cos(sample.output_angle),
      std::sin(sample.output_angle), sample.load, sample.load * std::abs(sample.load),
      sample.load * sample.load * sample.load;
  for (std::size_t line = 0; line < LINE_COUNT; ++line)
  {
    const auto column = static_cast<Eigen::Index>(NUISANCES + 2 * line);
    const double angle = orders_[line] * sample.motor_angle;
    row_[column] = std::cos(angle);
    row_[column + 1] = std::sin(angle);
  }
  targets_ = { sample.kinematic_error, sample.motor_torque };
  regression_.add(row_, targets_);
}

bool OrderTracker::fit(double angle_step) noexcept
{
  // The tooth pass stands last, so that what the samples cannot show is the tail of the columns.
  std::size_t visible = index(Line::TOOTH_PASS);
  if (orders_[index(Line::TOOTH_PASS_ABOVE)] * angle_step < USED_BAND * 0.5 * TWO_PI)
  {
    visible = LINE_COUNT;
  }
  const int used = NUISANCES + 2 * static_cast<int>(visible);
  angle_step_ = angle_step;
  const bool fitted = regression_.fit(used);
  used_ = fitted ? used : 0;
  return fitted;
}

LineFit OrderTracker::line(LineSignal signal, std::size_t line) const noexcept
{
  const int column = NUISANCES + 2 * static_cast<int>(line);
  if (column >= used_ || orders_[line] * angle_step_ >= USED_BAND * 0.5 * TWO_PI ||
      regression_.inflation(column) > MAX_INFLATION || regression_.inflation(column + 1) > MAX_INFLATION)
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

double OrderTracker::residual() const noexcept
{
  return targets_[0] - row_.dot(regression_.coefficients(0));
}
}  // namespace hjt
