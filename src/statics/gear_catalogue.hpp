// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

namespace hjt
{
/// One size of the catalogue. Stiffness and ratings: Harmonic Drive, CSF/HFUS; friction, ratio 100: Schaeffler TPI 275
/// (RT1-H-CS), which has no size 11 and no size 32. Size 11: from the catalogue as known, not checked.
struct CatalogueSize
{
  struct Rating
  {
    int ratio;
    double repeated_peak, average, rated, momentary_peak;  // [N.m]
  };
  double size;
  std::array<double, 2> breakpoints;       // [N.m]
  std::array<double, 3> stiffness_of_50;   // [N.m/rad]
  std::array<double, 3> stiffness;         // of ratio 80 and more [N.m/rad]
  double starting_torque, no_load_torque;  // [N.m]
  std::vector<Rating> ratings;
};

const std::vector<CatalogueSize>& catalogue();
}  // namespace hjt
