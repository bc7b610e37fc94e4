// SPDX-License-Identifier: BSD-3-Clause
#include "life/ageing_laws.hpp"

#include <algorithm>
#include <cmath>

#include "gear/angle.hpp"
#include "statics/flexspline_stress.hpp"

namespace hjt
{
double greaseAgeing(const LifeParameters& parameters, double temperature)
{
  return std::exp2((temperature - parameters.grease_temperature) / parameters.grease_halving) / parameters.grease_turns;
}

double stressIntensityRange(const AgeingParameters& parameters, const RevolutionLoad& revolution_load, double depth)
{
  constexpr double POISSON = 0.3;
  constexpr double DEEPEST = 0.95;  // largest depth over the rim's thickness; the factors of the strip diverge at 1
  constexpr double NOTCH = 4.5;
  constexpr auto TOOTH_SPACE = static_cast<std::size_t>(StressPlace::TOOTH_SPACE);
  const GearParameters& gear = parameters.gear;
  const double x = std::min(depth / gear.rim_thickness, DEEPEST);
  const double angle = 0.5 * PI * x;
  const double lean = 1.0 - std::sin(angle);
  const double edge = (x > 0.0 ? std::sqrt(std::tan(angle) / angle) : 1.0) / std::cos(angle);
  const double by_bending = edge * (0.923 + 0.199 * std::pow(lean, 4));
  const double by_tension = edge * (0.752 + 2.02 * x + 0.37 * std::pow(lean, 3));
  // Rotation of the section by the crack over the rotation without a crack. The moment decreases as this ratio grows.
  const double opening = std::pow(x / (1.0 - x), 2) * (5.93 + x * (-19.69 + x * (37.14 + x * (-35.84 + x * 13.12))));
  const double bending_left = 1.0 / (1.0 + 2.0 * (1.0 - POISSON * POISSON) * gear.rim_thickness /
                                               toothSpace(gear, parameters.stress) * opening);
  const double notch = std::max(1.0, parameters.stress.concentration[TOOTH_SPACE] /
                                         std::sqrt(1.0 + NOTCH * depth / parameters.stress.notch_radius[TOOTH_SPACE]));
  return notch * std::sqrt(PI * depth) *
         (by_bending * bending_left * revolution_load.bending_range + by_tension * revolution_load.tension_range);
}

double crackGrowth(const AgeingParameters& parameters, const RevolutionLoad& revolution_load, double depth)
{
  constexpr double CYCLES_A_TURN = 2.0;
  constexpr double PA_IN_MPA = 1e-6;
  const LifeParameters& life = parameters.life;
  const double range = PA_IN_MPA * stressIntensityRange(parameters, revolution_load, depth);
  return range > life.crack_threshold ? CYCLES_A_TURN * life.crack_coefficient * std::pow(range, life.crack_exponent) :
                                        0.0;
}

double bearingWear(const LifeParameters& parameters, double load_torque)
{
  const double relative = std::abs(load_torque) / parameters.rated_torque;
  return relative * relative * relative;
}

BearingLife::BearingLife(const LifeParameters& parameters)
  : shape(std::log(std::log(0.5) / std::log(0.9)) / std::log(parameters.bearing_l50 / parameters.bearing_l10))
  , scale(parameters.bearing_l50 * parameters.rated_speed * 3600.0 / TWO_PI / std::pow(std::log(2.0), 1.0 / shape))
{
}

double BearingLife::quantile(double failed) const
{
  return scale * std::pow(-std::log1p(-failed), 1.0 / shape);
}

double BearingLife::failedBy(double turns) const
{
  return -std::expm1(-std::pow(turns / scale, shape));
}
}  // namespace hjt
