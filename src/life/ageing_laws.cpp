// SPDX-License-Identifier: BSD-3-Clause
#include "life/ageing_laws.hpp"

#include <cmath>

#include "gear/angle.hpp"

namespace hjt
{
double greaseAgeing(const LifeParameters& parameters, double temperature)
{
  return std::exp2((temperature - parameters.grease_temperature) / parameters.grease_halving) / parameters.grease_turns;
}

double stressIntensityRange(const LifeParameters& parameters, double stress_range, double depth)
{
  constexpr double EDGE_FLAW = 1.12;  // through an edge, small against the section
  return EDGE_FLAW * parameters.stress_concentration * stress_range * std::sqrt(0.5 * TWO_PI * depth);
}

double crackGrowth(const LifeParameters& parameters, double stress_range, double depth)
{
  constexpr double CYCLES_A_TURN = 2.0;
  constexpr double PA_IN_MPA = 1e-6;
  const double range = PA_IN_MPA * stressIntensityRange(parameters, stress_range, depth);
  return range > parameters.crack_threshold ?
             CYCLES_A_TURN * parameters.crack_coefficient * std::pow(range, parameters.crack_exponent) :
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
