// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/ros_io/output_schedule.hpp"

#include <cmath>
#include <sstream>

#include "harmonic_joint_twin/params/parameter_error.hpp"

namespace hjt
{
namespace
{
/// Rounding that a quotient of two exactly representable rates may carry [-].
constexpr double RATIO_TOLERANCE = 1e-9;

Stamp makePeriod(const char* key, double publish_rate, double solver_rate)
{
  const double steps = solver_rate / publish_rate;
  const double whole_steps = std::round(steps);
  if (!(whole_steps >= 1.0) || std::abs(steps - whole_steps) > RATIO_TOLERANCE * steps)
  {
    std::ostringstream text;
    text << key << ": " << publish_rate << " [Hz] must divide solver.rate, " << solver_rate << " [Hz], evenly";
    throw ParameterError(text.str());
  }
  const auto step_length = static_cast<Stamp>(std::llround(1e9 / solver_rate));
  return static_cast<Stamp>(whole_steps) * step_length;
}
}  // namespace

OutputSchedule::OutputSchedule(const Parameters& parameters)
  : periods_{ makePeriod("publish.joint_states_rate", parameters.publish.joint_states_rate, parameters.solver.rate),
              makePeriod("publish.encoders_rate", parameters.publish.encoders_rate, parameters.solver.rate),
              makePeriod("publish.contact_forces_rate", parameters.publish.contact_forces_rate, parameters.solver.rate),
              makePeriod("publish.health_rate", parameters.publish.health_rate, parameters.solver.rate),
              makePeriod("publish.indicators_rate", parameters.publish.indicators_rate, parameters.solver.rate),
              makePeriod("publish.indicators_rate", parameters.publish.indicators_rate, parameters.solver.rate) }
{
}
}  // namespace hjt
