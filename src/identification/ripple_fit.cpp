// SPDX-License-Identifier: BSD-3-Clause
#include "identification/ripple_fit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>
#include <utility>

#include <Eigen/Cholesky>

#include "identification/regression.hpp"

namespace hjt
{
namespace
{
constexpr double WIDEST = 0.5;  // half width of an interval over the amplitude
// Resonance [Hz], damping [-] and lag [s].
const Eigen::Vector3d LOWEST(2.0, 0.05, -0.02);
const Eigen::Vector3d HIGHEST(100.0, 1.0, 0.02);
}  // namespace

RippleFit::RippleFit(std::vector<RippleRow> rows, double period, const TelemetryParameters& start, double ratio,
                     const std::function<void()>& look)
  : rows_(std::move(rows)), orders_(TorqueRipple::orders(ratio)), fastest_(start.ripple_fastest)
{
  std::vector<double> speeds;
  std::transform(rows_.begin(), rows_.end(), std::back_inserter(speeds),
                 [](const RippleRow& row) { return std::abs(row.velocity); });
  if (!speeds.empty())
  {
    const auto fast = speeds.begin() + static_cast<std::ptrdiff_t>(KNOWN * static_cast<double>(speeds.size() - 1));
    std::nth_element(speeds.begin(), fast, speeds.end());
    fastest_ = std::min(*fast, M_PI / (period * orders_[1]) * (1.0 - 1e-12));
    rows_.erase(std::remove_if(rows_.begin(), rows_.end(),
                               [&](const RippleRow& row) { return std::abs(row.velocity) > fastest_; }),
                rows_.end());
  }
  torque_.resize(static_cast<Eigen::Index>(rows_.size()));
  std::transform(rows_.begin(), rows_.end(), torque_.data(), [](const RippleRow& row) { return row.torque; });
  for (std::size_t i = 0; i < TorqueRipple::LINES; ++i)
  {
    present_[i] = orders_[i] * fastest_ * period <= M_PI;
    refusal_[i] = present_[i] ? "" : "the rows are too far apart for it";
  }
  values_.tail<3>() << start.ripple_resonance, start.ripple_damping, start.ripple_lag;
  const Values configured = values_;
  chooseResonance(look);
  while (anyLine())
  {
    look();
    solve();
    if (!refuseWorst())
    {
      break;
    }
  }
  if (!anyLine())
  {
    values_ = configured;
  }
}

bool RippleFit::anyLine() const
{
  return std::any_of(present_.begin(), present_.end(), [](bool present) { return present; });
}

/// Of each row, as TorqueRipple has them, real and imaginary part of each line; 0 where it is not present.
Eigen::MatrixXd RippleFit::waves(const double* response) const
{
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(torque_.size(), RESONANCE);
  for (Eigen::Index i = 0; i < torque_.size(); ++i)
  {
    const RippleRow& row = rows_[i];
    const TorqueRipple::Waves felt = TorqueRipple::waves(orders_, row.position, row.velocity, response);
    for (std::size_t k = 0; k < felt.size(); ++k)
    {
      columns(i, 2 * k) = present_[k] ? felt[k].real() : 0.0;
      columns(i, 2 * k + 1) = present_[k] ? felt[k].imag() : 0.0;
    }
  }
  return columns;
}

/// Of the torque of each row in each value.
Eigen::MatrixXd RippleFit::slopes(const Values& values) const
{
  const double* response = values.data() + RESONANCE;
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(torque_.size(), VALUES);
  slopes.leftCols(RESONANCE) = waves(response);
  for (Eigen::Index i = 0; i < torque_.size(); ++i)
  {
    for (std::size_t k = 0; k < orders_.size(); ++k)
    {
      const double w = orders_[k] * rows_[i].velocity;
      const std::complex<double> torque = std::complex<double>(values[2 * k], -values[2 * k + 1]) *
                                          std::complex<double>(slopes(i, 2 * k), slopes(i, 2 * k + 1));
      const std::complex<double> in_stiffness = -torque / TorqueRipple::stiffness(w, response);
      const double natural = TWO_PI * response[0];
      slopes(i, RESONANCE) +=
          TWO_PI * (in_stiffness * std::complex<double>(2.0 * natural, 2.0 * response[1] * w)).real();
      slopes(i, RESONANCE + 1) -= 2.0 * natural * w * in_stiffness.imag();
      slopes(i, RESONANCE + 2) += w * torque.imag();
    }
  }
  return slopes;
}

/// The start: the best of a coarse grid, cos and sin of the lines fitted to each by one linear solve.
void RippleFit::chooseResonance(const std::function<void()>& look)
{
  double most = -1.0;
  for (const double resonance : { 5.0, 8.0, 12.0, 16.0, 20.0, 25.0, 32.0, 45.0 })
  {
    for (const double damping : { 0.1, 0.3, 0.6 })
    {
      look();
      for (const double lag : { -0.004, 0.0, 0.004, 0.008, 0.012 })
      {
        const Eigen::Vector3d response(resonance, damping, lag);
        const Eigen::MatrixXd columns = waves(response.data());
        const Eigen::VectorXd right = columns.transpose() * torque_;
        Eigen::MatrixXd normal = columns.transpose() * columns;
        normal.diagonal().array() += 1e-9;
        const Eigen::VectorXd lines = normal.ldlt().solve(right);
        if (lines.dot(right) > most)
        {
          most = lines.dot(right);
          values_ << lines, response;
        }
      }
    }
  }
}

void RippleFit::solve()
{
  Values lowest = Values::Constant(-HUGE_VAL);
  Values highest = Values::Constant(HUGE_VAL);
  lowest.tail<3>() = LOWEST;
  highest.tail<3>() = HIGHEST;
  const double outlier = 2.0 * torque_.norm() / std::sqrt(static_cast<double>(torque_.size())) + 1e-9;
  const auto errors = [&](const Eigen::MatrixXd& columns, const Values& values) -> Eigen::VectorXd
  { return columns.leftCols(RESONANCE) * values.head<RESONANCE>() - torque_; };
  values_ = leastCost(values_, lowest, highest,
                      [&](const Values& values)
                      {
                        const Eigen::MatrixXd columns = slopes(values);
                        return huberEquations(errors(columns, values), columns, columns.transpose() * columns, outlier);
                      });
  const Eigen::MatrixXd columns = slopes(values_);
  half_width_ = halfWidths(errors(columns, values_), columns);
}

/// True if a line was dropped, so that the rest must be refitted.
bool RippleFit::refuseWorst()
{
  double worst = WIDEST;
  std::size_t line = TorqueRipple::LINES;
  for (std::size_t i = 0; i < TorqueRipple::LINES; ++i)
  {
    const double share = present_[i] ? halfWidth(i) / std::max(amplitude(i), 1e-12) : 0.0;
    if (share > worst)
    {
      worst = share;
      line = i;
    }
  }
  if (line == TorqueRipple::LINES)
  {
    return false;
  }
  refusal_[line] = "lost in the residual";
  present_[line] = false;
  values_.segment<2>(2 * line).setZero();
  half_width_.segment<2>(2 * line).setZero();
  return true;
}

double RippleFit::amplitude(std::size_t line) const
{
  return std::hypot(values_[2 * line], values_[2 * line + 1]);
}

double RippleFit::halfWidth(std::size_t line) const
{
  return std::max(half_width_[2 * line], half_width_[2 * line + 1]);
}

double RippleFit::phase(std::size_t line) const
{
  return std::atan2(-values_[2 * line + 1], values_[2 * line]);
}

void RippleFit::store(TelemetryParameters& p) const
{
  Eigen::Index at = 0;
  for (auto* line :
       { &p.ripple_circular_spline_2, &p.ripple_flexspline_2, &p.ripple_circular_spline_4, &p.ripple_flexspline_4 })
  {
    *line = { values_[at], values_[at + 1] };
    at += 2;
  }
  p.ripple_resonance = values_[RESONANCE];
  p.ripple_damping = values_[RESONANCE + 1];
  p.ripple_lag = values_[RESONANCE + 2];
  p.ripple_fastest = fastest_;
}
}  // namespace hjt
