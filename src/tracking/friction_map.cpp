// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/friction_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "base/number_text.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "harmonic_joint_twin/statics/loss_analysis.hpp"
#include "params/variants.hpp"

namespace hjt
{
namespace
{
constexpr int POSITIONS = 8;  // number of positions within a tooth pitch over which the table averages
// Speeds of the motor in the table. Each speed is six times the speed before.
constexpr std::array<double, 7> SPEEDS{ 0.01, 0.06, 0.36, 2.16, 12.96, 77.76, 466.56 };  // [rad/s]
// Loads of the table over the table's largest load [-].
constexpr std::array<double, 11> LOADS{ 0.0, 0.02, 0.05, 0.08, 0.12, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0 };

/// Largest load that the motor can hold; output.load_torque_limit if motor.torque_limit is 0 [N.m].
double largestLoad(const Parameters& parameters)
{
  const double largest = parameters.motor.torque_limit > 0.0 ?
                             parameters.motor.torque_limit * nominalRatio(parameters.gear) :
                             parameters.output.load_torque_limit;
  if (!(largest > 0.0))
  {
    throw ParameterError(
        "motor.torque_limit and output.load_torque_limit are both 0, so the table of the friction has "
        "no range of loads");
  }
  return largest;
}

/// Losses of a drive without errors of manufacture. Keeps the tables, because joints of an arm can have equal drives.
const std::vector<LossRow>& lossesOf(Parameters parameters, const std::vector<double>& loads)
{
  parameters.joint = {};
  parameters.telemetry = {};  // the telemetry has no effect on the friction
  parameters.comparison = {};
  constexpr std::size_t MOST = 64;  // largest number of kept tables; a fit tries many drives
  thread_local std::map<std::uint64_t, std::vector<LossRow>> known;
  if (known.size() >= MOST)
  {
    known.clear();
  }
  std::vector<LossRow>& rows = known[parametersHash(parameters)];
  if (rows.empty())
  {
    rows = analyseLosses(parameters, { SPEEDS.begin(), SPEEDS.end() }, loads, POSITIONS, {});
  }
  return rows;
}
}  // namespace

FrictionMap::FrictionMap(const Parameters& parameters)
  : bearing_(parameters.bearing)
  , motor_(parameters.motor)
  , race_preload_(parameters.bearing.race_preload)
  , viscous_(parameters.motor.viscous_friction +
             parameters.output.viscous_friction / std::pow(nominalRatio(parameters.gear), 2))
  , preload_torque_(bearing_.torque(0.0, 0.0, parameters.input.temperature) -
                    bearing_.torque(0.0, -race_preload_, parameters.input.temperature))
{
  static_assert(SPEEDS == hjt::SPEEDS.size());
  const double largest = largestLoad(parameters);
  std::vector<double> loads;
  for (const double share : LOADS)
  {
    loads.push_back(share * largest);
  }
  const std::vector<LossRow>& rows = lossesOf(withoutErrors(parameters), loads);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    const LossRow& row = rows[i];
    if (!row.status.ok() && row.load_torque > parameters.output.load_torque_limit && lines_.size() > 2)
    {
      lines_.resize(i / SPEEDS);
      break;  // the gear cannot bear this load, although the motor can hold it
    }
    if (!row.status.ok())
    {
      throw ParameterError("the ring finds no equilibrium under a load of " + numberText(row.load_torque) +
                           " N.m at the output: " + explanationOf(row.status));
    }
    if (i % SPEEDS == 0)
    {
      const double grease = bearing_.torque(row.motor_speed, -race_preload_, parameters.input.temperature);
      lines_.push_back({ row.load_torque,
                         row.loss.bearing - grease - preload_torque_ + row.loss.interface + row.loss.cup +
                             row.loss.flexing + row.loss.output + parameters.motor.coulomb_torque,
                         {} });
    }
    lines_.back().flanks[i % SPEEDS] = row.loss.mesh;
  }
}

FrictionShares FrictionMap::atViscosity(double motor_speed, double load, double viscosity) const noexcept
{
  const double speed = std::abs(motor_speed);
  const double size = std::clamp(std::abs(load), 0.0, lines_.back().load);
  const auto above =
      std::find_if(lines_.begin() + 1, lines_.end() - 1, [&](const Line& line) { return line.load >= size; });
  const Line& high = *above;
  const Line& low = *(above - 1);
  const double v = (size - low.load) / (high.load - low.load);

  const double step = std::log(hjt::SPEEDS[1] / hjt::SPEEDS[0]);
  const double at = std::clamp(std::log(std::max(speed, hjt::SPEEDS[0]) / hjt::SPEEDS[0]) / step, 0.0, SPEEDS - 1.0);
  const std::size_t k = std::min(static_cast<std::size_t>(at), SPEEDS - 2);
  const double u = at - static_cast<double>(k);
  const auto flanks = [&](const Line& line) { return (1.0 - u) * line.flanks[k] + u * line.flanks[k + 1]; };

  FrictionShares shares;
  shares.preload = preload_torque_;
  shares.grease = bearing_.torqueAtViscosity(speed, -race_preload_, viscosity);
  shares.flanks = (1.0 - v) * flanks(low) + v * flanks(high);
  shares.rest = (1.0 - v) * low.rest + v * high.rest;
  shares.stribeck = motor_.stribeckTorque(speed);
  shares.viscous = viscous_ * speed;
  return shares;
}
}  // namespace hjt
