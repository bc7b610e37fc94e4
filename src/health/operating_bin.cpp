// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "harmonic_joint_twin/health/baseline.hpp"

namespace hjt
{
namespace
{
constexpr double LOAD_STEP = 0.375;           // share of the rated torque
constexpr double TEMPERATURE_STEP = 10.0;     // [K]
constexpr double ONE_WAY = 0.5;               // share of travel one way less the other that counts as one direction
constexpr double REACH = 0.25;                // share of a step beyond the edge of a class
constexpr double INERTIA_ACCELERATION = 5.0;  // [rad/s^2]

int stepOf(double value, double step) noexcept
{
  constexpr double FARTHEST = 1e6;  // damaged recordings hold numbers that no int does
  return std::isfinite(value) ? static_cast<int>(std::clamp(std::floor(value / step), -FARTHEST, FARTHEST)) : 0;
}

bool isNear(double value, double step, int known) noexcept
{
  return std::isfinite(value) ? std::abs(value / step - known - 0.5) <= 0.5 + REACH : known == 0;
}
}  // namespace

double loadStep(const Parameters& parameters) noexcept
{
  return LOAD_STEP * parameters.life.rated_torque;
}

OperatingBin binOf(const OperatingPoint& point, double load_step) noexcept
{
  OperatingBin bin;
  bin.speed = point.speed > 0.0 ? stepOf(std::log2(point.speed), 1.0) : -100;
  bin.direction = point.direction > ONE_WAY ? 1 : point.direction < -ONE_WAY ? -1 : 0;
  bin.load = stepOf(point.load, load_step);
  bin.temperature = stepOf(point.temperature, TEMPERATURE_STEP);
  return bin;
}

bool isInReach(const OperatingBin& bin, const OperatingPoint& point, double load_step) noexcept
{
  const OperatingBin own = binOf(point, load_step);
  const bool is_speed_near =
      point.speed > 0.0 ? isNear(std::log2(point.speed), 1.0, bin.speed) : own.speed == bin.speed;
  return is_speed_near && own.direction == bin.direction && isNear(point.load, load_step, bin.load) &&
         isNear(point.temperature, TEMPERATURE_STEP, bin.temperature);
}

Place placeIn(const OperatingBin& bin, const OperatingPoint& point, double load_step) noexcept
{
  const auto place = [](double value, int step, double size, double farthest)
  { return std::isfinite(value) ? std::clamp(2.0 * (value / size - step) - 1.0, -farthest, farthest) : 0.0; };
  const double temperature = place(point.temperature, bin.temperature, TEMPERATURE_STEP, 1.0 + 2.0 * REACH);
  constexpr double FARTHEST = 100.0;
  return { temperature,
           temperature * temperature,
           place(point.load, bin.load, load_step, 1.0 + 2.0 * REACH),
           place(point.load_constant, 0, load_step, FARTHEST),
           place(point.load_sine, 0, load_step, FARTHEST),
           place(point.load_cosine, 0, load_step, FARTHEST),
           place(INERTIA_ACCELERATION * point.inertia, 0, load_step, FARTHEST) };
}
}  // namespace hjt
