// SPDX-License-Identifier: BSD-3-Clause
#include "elements/bearing_friction.hpp"

#include <algorithm>
#include <cmath>

#include "gear/angle.hpp"

namespace hjt
{
void BearingFriction::reducePreload(double loss, double least) noexcept
{
  preload_ = std::max(preload_ - loss, std::min(least, preload_));
}

double BearingFriction::torqueAtViscosity(double speed, double load, double viscosity) const noexcept
{
  constexpr double LOW_SPEED = 2000.0;  // mm^2/s rpm
  const double product = 1e6 * viscosity * std::abs(speed) * 60.0 / TWO_PI;
  const double diameter = 1e3 * parameters_.pitch_diameter;
  const double root = std::cbrt(std::max(product, LOW_SPEED));
  const double rolling = product < LOW_SPEED ? 160.0 : root * root;
  const double speed_part = parameters_.lubricant_factor * rolling * diameter * diameter * diameter * 1e-7;
  const double load_part = parameters_.load_factor * (load + preload_) * diameter;
  return 1e-3 * (speed_part + load_part);
}

double BearingFriction::viscosity(double temperature) const noexcept
{
  constexpr double ZERO_CELSIUS = 273.15;  // K
  constexpr double OFFSET = 0.7;           // mm^2/s
  const double known = std::log10(1e6 * parameters_.viscosity + OFFSET);
  const double ratio = (temperature + ZERO_CELSIUS) / (parameters_.viscosity_temperature + ZERO_CELSIUS);
  return viscosity_factor_ * 1e-6 * (std::pow(10.0, known * std::pow(ratio, -parameters_.viscosity_slope)) - OFFSET);
}
}  // namespace hjt
