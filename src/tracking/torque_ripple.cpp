// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/torque_ripple.hpp"

namespace hjt
{
TorqueRipple::TorqueRipple(const TelemetryParameters& p, double ratio)
  : orders_(orders(ratio))
  , values_{ p.ripple_circular_spline_2[0],
             p.ripple_circular_spline_2[1],
             p.ripple_flexspline_2[0],
             p.ripple_flexspline_2[1],
             p.ripple_circular_spline_4[0],
             p.ripple_circular_spline_4[1],
             p.ripple_flexspline_4[0],
             p.ripple_flexspline_4[1],
             p.ripple_resonance,
             p.ripple_damping,
             p.ripple_lag }
  , fastest_(p.ripple_fastest)
{
}
}  // namespace hjt
