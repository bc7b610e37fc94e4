// SPDX-License-Identifier: BSD-3-Clause
#include "health/order_tracker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <functional>

#include "gear/angle.hpp"

namespace hjt
{
/// A line whose order at a slip s is `order` + `by_slip` s.
struct BearingSlip::BearingLine
{
  std::size_t line{};
  double order{};
  double by_slip{};
};

namespace
{
using Complex = std::complex<double>;

constexpr double BIN = TWO_PI / 8.0;  // range of motor angle in which slip hardly changes a line's phase [rad]
constexpr std::array SEARCHED{ LineSignal::MOTOR_RIPPLE, LineSignal::KINEMATIC_ERROR };
constexpr double NOISE_FROM = -BearingSlip::MOST;
constexpr double NOISE_TO = 2.0 * BearingSlip::MOST;

/// Standard deviation of the speed's magnitude over its mean [-].
double speedSpread(const std::vector<LineSample>& samples)
{
  double sum = 0.0;
  double squares = 0.0;
  for (const LineSample& sample : samples)
  {
    sum += std::abs(sample.speed);
    squares += sample.speed * sample.speed;
  }
  return std::sqrt(std::max(0.0, squares * static_cast<double>(samples.size()) / (sum * sum) - 1.0));
}

/// |F_k|^2 / n_k of BearingSlip for each slip. `sums`: Fourier sums of line k at slip 0, one for each BIN of the angle.
std::vector<double> powersOf(const std::vector<Complex>& sums, double by_slip, double step, std::size_t steps)
{
  std::vector<Complex> turned(sums.size());
  std::vector<Complex> turns(sums.size());
  for (std::size_t bin = 0; bin < sums.size(); ++bin)
  {
    const double angle = BIN * static_cast<double>(bin);
    turned[bin] = sums[bin] * std::polar(1.0, -by_slip * NOISE_FROM * angle);
    turns[bin] = std::polar(1.0, -by_slip * step * angle);
  }
  std::vector<double> powers(steps);
  for (double& power : powers)
  {
    Complex sum;
    for (std::size_t bin = 0; bin < sums.size(); ++bin)
    {
      sum += turned[bin];
      turned[bin] *= turns[bin];
    }
    power = std::norm(sum);
  }
  std::vector<double> sorted = powers;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(steps / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double noise = *middle / std::log(2.0);
  for (double& power : powers)
  {
    power = noise > 0.0 ? power / noise : 0.0;
  }
  return powers;
}
}  // namespace

BearingSlip::BearingSlip(const Parameters& parameters)
  : gear_(parameters.gear), bearing_(parameters.bearing), rated_torque_(parameters.life.rated_torque)
{
}

/// Lines whose order changes with slip by so much that the search also shows the noise near the line.
std::vector<BearingSlip::BearingLine> BearingSlip::linesOf(const OrderTracker& fitted) const
{
  constexpr double MOVES = 5.0;  // least change of the order for a slip of 1 [1/turn]
  const LineOrders without = trackedOrders(gear_, bearing_);
  const LineOrders with = trackedOrders(gear_, bearing_, MOST);
  std::vector<BearingLine> lines;
  for (std::size_t line = 0; line < FIRST_LOADED; ++line)
  {
    const double by_slip = (with[line] - without[line]) / MOST;
    if (std::abs(by_slip) > MOVES && fitted.line(LineSignal::MOTOR_RIPPLE, line).valid)
    {
      lines.push_back({ line, without[line], by_slip });
    }
  }
  return lines;
}

double BearingSlip::find(const OrderTracker& fitted) const
{
  constexpr double CLEARLY = 25.0;       // least difference of L between two slips that counts [-]
  constexpr double FEWEST_TURNS = 10.0;  // least number of turns that separates a line with slip from one without
  // Largest number of turns, because time and memory grow with the turns and a damaged angle may have any number.
  constexpr double MOST_TURNS = 500.0;
  constexpr double EVEN = 0.1;   // speedSpread below which folded lines are sharp [-]
  constexpr double FINE = 0.25;  // step of the slip, as a share of the resolution of the fastest line [-]
  const std::vector<BearingLine> lines = linesOf(fitted);
  const auto [least, most] =
      std::minmax_element(samples_.begin(), samples_.end(),
                          [](const LineSample& a, const LineSample& b) { return a.motor_angle < b.motor_angle; });
  const double range = samples_.empty() ? 0.0 : most->motor_angle - least->motor_angle;
  const bool is_searched = range > FEWEST_TURNS * TWO_PI && range < MOST_TURNS * TWO_PI;
  if (lines.empty() || samples_.size() > MOST_SAMPLES || !is_searched || speedSpread(samples_) < EVEN)
  {
    return 0.0;
  }
  std::array<bool, FIRST_LOADED> kept{};
  double fastest = 0.0;
  for (const BearingLine& line : lines)
  {
    kept[line.line] = true;
    fastest = std::max(fastest, std::abs(line.by_slip));
  }
  const double start = least->motor_angle;
  const std::vector<Complex> none(static_cast<std::size_t>(range / BIN) + 1);
  std::array<std::vector<std::vector<Complex>>, SEARCHED.size()> sums;
  sums.fill(std::vector<std::vector<Complex>>(lines.size(), none));
  for (const LineSample& sample : samples_)
  {
    const double angle = sample.motor_angle - start;
    const auto bin = static_cast<std::size_t>(angle / BIN);
    const Eigen::Vector3d rest = sample.weight * fitted.beside(sample, kept);
    for (std::size_t k = 0; k < lines.size(); ++k)
    {
      const Complex turned = std::polar(1.0, -lines[k].order * angle);
      for (std::size_t i = 0; i < SEARCHED.size(); ++i)
      {
        sums[i][k][bin] += turned * rest[static_cast<Eigen::Index>(SEARCHED[i])];
      }
    }
  }
  const double zero_steps = std::ceil(-NOISE_FROM * fastest * range / (FINE * TWO_PI));
  const double step = -NOISE_FROM / zero_steps;
  const auto zero = static_cast<std::size_t>(zero_steps);
  std::array<std::vector<double>, SEARCHED.size()> all;  // L of BearingSlip by signal and slip
  for (std::size_t i = 0; i < SEARCHED.size(); ++i)
  {
    all[i].resize(static_cast<std::size_t>((NOISE_TO - NOISE_FROM) / step) + 1);
    for (std::size_t k = 0; k < lines.size(); ++k)
    {
      const std::vector<double> powers = powersOf(sums[i][k], lines[k].by_slip, step, all[i].size());
      std::transform(all[i].begin(), all[i].end(), powers.begin(), all[i].begin(), std::plus<>());
    }
  }
  const auto& [ripple, error] = all;
  const auto first = ripple.begin() + static_cast<std::ptrdiff_t>(zero);
  const auto best = std::max_element(first, first + static_cast<std::ptrdiff_t>(MOST / step) + 1);
  const auto place = static_cast<std::size_t>(best - ripple.begin());
  const bool is_found = *best > *first + CLEARLY && error[zero] < error[place] + CLEARLY;
  return is_found ? step * static_cast<double>(best - first) : 0.0;
}

OrderTracker BearingSlip::refit(double slip, double angle_step) const
{
  OrderTracker tracker(trackedOrders(gear_, bearing_, slip), rated_torque_);
  for (const LineSample& sample : samples_)
  {
    tracker.add(sample);
  }
  tracker.fit(angle_step);
  return tracker;
}
}  // namespace hjt
