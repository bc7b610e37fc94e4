// SPDX-License-Identifier: BSD-3-Clause
#include "studies/runge_kutta_tableau.hpp"

#include <cmath>

namespace hjt
{
const RungeKuttaTableau& implicitEuler()
{
  static const RungeKuttaTableau TABLEAU{ 1, 1.0, false, { {} }, { 1.0 }, {}, 0 };
  return TABLEAU;
}

const RungeKuttaTableau& trBdf2()
{
  static const RungeKuttaTableau TABLEAU = []
  {
    const double g = 1.0 - std::sqrt(0.5);
    const double w = 0.25 * std::sqrt(2.0);
    // Weights of the step less those of the embedded method of order 3.
    const std::vector<double> error{ w - (1.0 - w) / 3.0, w - (3.0 * w + 1.0) / 3.0, g - g / 3.0 };
    return RungeKuttaTableau{ 2, g, true, { {}, { g }, { w, w } }, { 0.0, 2.0 * g, 1.0 }, error, 3 };
  }();
  return TABLEAU;
}

const RungeKuttaTableau& esdirk4()
{
  static const RungeKuttaTableau TABLEAU = []
  {
    const std::vector<double> last{ 82889.0 / 524892.0, 0.0, 15625.0 / 83664.0, 69875.0 / 102672.0, -2260.0 / 8211.0 };
    const std::vector<double> embedded{ 4586570599.0 / 29645900160.0, 0.0,
                                        178811875.0 / 945068544.0,    814220225.0 / 1159782912.0,
                                        -3700637.0 / 11593932.0,      61727.0 / 225920.0 };
    std::vector<double> error(6);
    for (std::size_t i = 0; i < 6; ++i)
    {
      error[i] = (i < 5 ? last[i] : 0.25) - embedded[i];
    }
    return RungeKuttaTableau{ 4,
                              0.25,
                              true,
                              { {},
                                { 0.25 },
                                { 8611.0 / 62500.0, -1743.0 / 31250.0 },
                                { 5012029.0 / 34652500.0, -654441.0 / 2922500.0, 174375.0 / 388108.0 },
                                { 15267082809.0 / 155376265600.0, -71443401.0 / 120774400.0, 730878875.0 / 902184768.0,
                                  2285395.0 / 8070912.0 },
                                last },
                              { 0.0, 0.5, 83.0 / 250.0, 31.0 / 50.0, 17.0 / 20.0, 1.0 },
                              error,
                              4 };
  }();
  return TABLEAU;
}
}  // namespace hjt
