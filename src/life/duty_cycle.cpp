// SPDX-License-Identifier: BSD-3-Clause
#include "life/duty_cycle.hpp"

#include <algorithm>
#include <cmath>

#include "base/number_text.hpp"

namespace hjt
{
namespace
{
constexpr double LOAD_STEPS = 16.0;         // number of steps of load up to the rated torque
constexpr double NO_LOAD = 64.0;            // index of the node without load
constexpr double TEMPERATURE_CLASS = 10.0;  // distance of the nodes in temperature [K]

/// The grid nodes below and above a value, with the share of the upper node. A value that equals a node within rounding
/// errors counts only for this node. NaN counts for the first node.
struct Share
{
  Share(double place, std::size_t nodes) noexcept
  {
    constexpr double ROUNDING = 1e-9;
    const double node = std::round(place);
    const double exact = std::abs(place - node) < ROUNDING ? node : place;
    const double within = std::fmin(std::fmax(exact, 0.0), static_cast<double>(nodes - 1));
    below = std::min(static_cast<std::size_t>(within), nodes - 2);
    above = within - static_cast<double>(below);
  }

  std::size_t below;
  double above;
};
}  // namespace

UsageHistory::UsageHistory(const LifeParameters& life) : load_step_(life.rated_torque / LOAD_STEPS) {}

UsageHistory::UsageHistory(const LifeParameters& life, const std::string& path) : UsageHistory(life)
{
  for (const DutyPhase& phase : DutyCycle::fromFile(path).phases)
  {
    add(phase);
  }
}

void UsageHistory::clear() noexcept
{
  nodes_ = {};
}

void UsageHistory::add(const DutyPhase& use) noexcept
{
  const Share load(use.load_torque / load_step_ + NO_LOAD, LOADS);
  const Share temperature((use.temperature - MIN_TEMPERATURE) / TEMPERATURE_CLASS, TEMPERATURES);
  const double travel = use.duration * use.motor_speed;
  for (std::size_t i = 0; i < 2; ++i)
  {
    for (std::size_t k = 0; k < 2; ++k)
    {
      const double share =
          (i == 0 ? 1.0 - load.above : load.above) * (k == 0 ? 1.0 - temperature.above : temperature.above);
      Node& node = nodes_[load.below + i][temperature.below + k];
      node.time += share * use.duration;
      node.travel += share * travel;
    }
  }
}

void UsageHistory::add(const UsageHistory& other) noexcept
{
  for (std::size_t i = 0; i < LOADS; ++i)
  {
    for (std::size_t k = 0; k < TEMPERATURES; ++k)
    {
      nodes_[i][k].time += other.nodes_[i][k].time;
      nodes_[i][k].travel += other.nodes_[i][k].travel;
    }
  }
}

double UsageHistory::hours() const noexcept
{
  double time = 0.0;
  for (const auto& row : nodes_)
  {
    for (const Node& node : row)
    {
      time += node.time;
    }
  }
  return time / 3600.0;
}

double UsageHistory::turns() const noexcept
{
  double travel = 0.0;
  for (const auto& row : nodes_)
  {
    for (const Node& node : row)
    {
      travel += node.travel;
    }
  }
  return travel / TWO_PI;
}

DutyCycle UsageHistory::duty() const
{
  DutyCycle duty;
  for (std::size_t i = 0; i < LOADS; ++i)
  {
    for (std::size_t k = 0; k < TEMPERATURES; ++k)
    {
      const Node& node = nodes_[i][k];
      if (node.time > 0.0)
      {
        duty.phases.push_back({ node.time, node.travel / node.time, (static_cast<double>(i) - NO_LOAD) * load_step_,
                                MIN_TEMPERATURE + static_cast<double>(k) * TEMPERATURE_CLASS });
      }
    }
  }
  return duty;
}

std::string UsageHistory::text() const
{
  std::string text = "duration,motor_speed,load_torque,temperature\n";
  for (const DutyPhase& phase : duty().phases)
  {
    text += numberText(phase.duration) + ',' + numberText(phase.motor_speed) + ',' + numberText(phase.load_torque) +
            ',' + numberText(phase.temperature) + '\n';
  }
  return text;
}
}  // namespace hjt
