// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/presliding.hpp"

#include <cmath>

namespace hjt
{
namespace
{
double dahl(double share, double step, double angle) noexcept
{
  const double end = std::copysign(1.0, step);
  return end + (share - end) * std::exp(-std::abs(step) / angle);
}
}  // namespace

Presliding::Presliding(const TelemetryParameters& parameters)
  : angle_(parameters.presliding_angle), lasting_share_(parameters.lasting_share)
{
}

void Presliding::move(double motor_step, double duration) noexcept
{
  contacts_ = dahl(contacts_ * std::exp(-duration / RELAXATION), motor_step, angle_);
  lasting_ = dahl(lasting_, motor_step, LASTING_ANGLE);
}
}  // namespace hjt
