// SPDX-License-Identifier: BSD-3-Clause
#include "identification/ripple_fit.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <ceres/ceres.h>
#include <Eigen/Cholesky>

#include "identification/regression.hpp"

namespace hjt
{
namespace
{
constexpr double WIDEST = 0.5;  // half width of an interval over the amplitude
constexpr std::size_t RESONANCE = TorqueRipple::RESONANCE;
constexpr std::size_t DAMPING = RESONANCE + 1;
constexpr std::size_t LAG = RESONANCE + 2;
constexpr std::array<double, 2> RESONANCES{ 2.0, 100.0 };  // [Hz]
constexpr std::array<double, 2> DAMPINGS{ 0.05, 1.0 };     // [-]
constexpr std::array<double, 2> LAGS{ -0.02, 0.02 };       // [s]

/// Residual of one row; each value is a parameter block.
struct Residual
{
  const TorqueRipple::Orders& orders;
  const RippleRow& row;

  template <class T>
  bool operator()(T const* const* values, T* residual) const
  {
    std::array<T, TorqueRipple::VALUES> all;
    for (std::size_t i = 0; i < all.size(); ++i)
    {
      all[i] = *values[i];
    }
    residual[0] = TorqueRipple::torque(orders, row.position, row.velocity, all.data()) - row.torque;
    return true;
  }
};
}  // namespace

RippleFit::RippleFit(std::vector<RippleRow> rows, double period, const TelemetryParameters& start, double ratio,
                     const std::function<void()>& look)
  : orders_(TorqueRipple::orders(ratio)), fastest_(start.ripple_fastest)
{
  std::vector<double> speeds;
  std::transform(rows.begin(), rows.end(), std::back_inserter(speeds),
                 [](const RippleRow& row) { return std::abs(row.velocity); });
  if (!speeds.empty())
  {
    const auto fast = speeds.begin() + static_cast<std::ptrdiff_t>(KNOWN * static_cast<double>(speeds.size() - 1));
    std::nth_element(speeds.begin(), fast, speeds.end());
    fastest_ = std::min(*fast, M_PI / (period * orders_[1]) * (1.0 - 1e-12));
    rows.erase(std::remove_if(rows.begin(), rows.end(),
                              [&](const RippleRow& row) { return std::abs(row.velocity) > fastest_; }),
               rows.end());
  }
  for (std::size_t i = 0; i < TorqueRipple::LINES; ++i)
  {
    present_[i] = orders_[i] * fastest_ * period <= M_PI;
    refusal_[i] = present_[i] ? "" : "the rows are too far apart for it";
  }
  values_[RESONANCE] = start.ripple_resonance;
  values_[DAMPING] = start.ripple_damping;
  values_[LAG] = start.ripple_lag;
  const Values configured = values_;
  chooseResonance(rows, look);
  while (anyLine())
  {
    look();
    solve(rows);
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

/// The start: the best of a coarse grid, cos and sin of the lines fitted to each by one linear solve.
void RippleFit::chooseResonance(const std::vector<RippleRow>& rows, const std::function<void()>& look)
{
  using Lines = Eigen::Matrix<double, RESONANCE, 1>;
  const auto fitted = [&](Values values, double& gain)
  {
    Eigen::Matrix<double, RESONANCE, RESONANCE> normal = Eigen::Matrix<double, RESONANCE, RESONANCE>::Identity() * 1e-9;
    Lines right = Lines::Zero();
    for (const RippleRow& row : rows)
    {
      Lines columns;
      for (std::size_t i = 0; i < RESONANCE; ++i)
      {
        std::fill(values.begin(), values.begin() + RESONANCE, 0.0);
        values[i] = present_[i / 2] ? 1.0 : 0.0;
        columns[static_cast<Eigen::Index>(i)] =
            TorqueRipple::torque(orders_, row.position, row.velocity, values.data());
      }
      normal += columns * columns.transpose();
      right += columns * row.torque;
    }
    const Lines lines = normal.ldlt().solve(right);
    gain = lines.dot(right);
    std::copy(lines.data(), lines.data() + RESONANCE, values.begin());
    return values;
  };
  double most = -1.0;
  Values best = values_;
  for (const double resonance : { 5.0, 8.0, 12.0, 16.0, 20.0, 25.0, 32.0, 45.0 })
  {
    for (const double damping : { 0.1, 0.3, 0.6 })
    {
      look();
      for (const double lag : { -0.004, 0.0, 0.004, 0.008, 0.012 })
      {
        values_[RESONANCE] = resonance;
        values_[DAMPING] = damping;
        values_[LAG] = lag;
        double gain{};
        const Values trial = fitted(values_, gain);
        if (gain > most)
        {
          most = gain;
          best = trial;
        }
      }
    }
  }
  values_ = best;
}

void RippleFit::solve(const std::vector<RippleRow>& rows)
{
  ceres::Problem problem;
  std::vector<double*> all;
  std::vector<double*> asked;
  for (std::size_t i = 0; i < values_.size(); ++i)
  {
    all.push_back(&values_[i]);
    problem.AddParameterBlock(all.back(), 1);
    if (i < RESONANCE && !present_[i / 2])
    {
      problem.SetParameterBlockConstant(all.back());
    }
    else
    {
      asked.push_back(all.back());
    }
  }
  const auto bound = [&](std::size_t i, const std::array<double, 2>& range)
  {
    problem.SetParameterLowerBound(all[i], 0, range[0]);
    problem.SetParameterUpperBound(all[i], 0, range[1]);
    values_[i] = std::clamp(values_[i], range[0], range[1]);
  };
  bound(RESONANCE, RESONANCES);
  bound(DAMPING, DAMPINGS);
  bound(LAG, LAGS);
  double squares = 0.0;
  for (const RippleRow& row : rows)
  {
    squares += row.torque * row.torque;
  }
  const double outlier = 2.0 * std::sqrt(squares / static_cast<double>(rows.size())) + 1e-9;
  for (const RippleRow& row : rows)
  {
    auto* cost = new ceres::DynamicAutoDiffCostFunction<Residual, TorqueRipple::VALUES>(new Residual{ orders_, row });
    std::for_each(all.begin(), all.end(), [&](double* /*value*/) { cost->AddParameterBlock(1); });
    cost->SetNumResiduals(1);
    problem.AddResidualBlock(cost, new ceres::HuberLoss(outlier), all);
  }
  constexpr int MAX_ITERATIONS = 60;
  const Eigen::VectorXd half_widths = hjt::solve(problem, asked, MAX_ITERATIONS);
  for (std::size_t k = 0; k < asked.size(); ++k)
  {
    half_width_[asked[k] - values_.data()] = half_widths[static_cast<Eigen::Index>(k)];
  }
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
  std::fill_n(values_.begin() + static_cast<std::ptrdiff_t>(2 * line), 2, 0.0);
  std::fill_n(half_width_.begin() + static_cast<std::ptrdiff_t>(2 * line), 2, 0.0);
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
  std::size_t at = 0;
  for (auto* line :
       { &p.ripple_circular_spline_2, &p.ripple_flexspline_2, &p.ripple_circular_spline_4, &p.ripple_flexspline_4 })
  {
    *line = { values_[at], values_[at + 1] };
    at += 2;
  }
  p.ripple_resonance = values_[RESONANCE];
  p.ripple_damping = values_[DAMPING];
  p.ripple_lag = values_[LAG];
  p.ripple_fastest = fastest_;
}
}  // namespace hjt
