// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/output_schedule.hpp"

#include <cmath>

namespace hjt
{
namespace
{
/// Both rates in Hz.
Stamp makePeriod(double publish_rate, double solver_rate)
{
  const Stamp step_length = std::llround(1e9 / solver_rate);
  return std::llround(solver_rate / publish_rate) * step_length;
}
}  // namespace

OutputSchedule::OutputSchedule(const Parameters& parameters)
  : periods_{ makePeriod(parameters.publish.joint_states_rate, parameters.solver.rate),
              makePeriod(parameters.publish.encoders_rate, parameters.solver.rate),
              makePeriod(parameters.publish.contact_forces_rate, parameters.solver.rate),
              makePeriod(parameters.publish.health_rate, parameters.solver.rate),
              makePeriod(parameters.publish.indicators_rate, parameters.solver.rate),
              makePeriod(parameters.publish.indicators_rate, parameters.solver.rate) }
{
}
}  // namespace hjt
