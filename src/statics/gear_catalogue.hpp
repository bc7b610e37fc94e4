// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace hjt
{
/// One size of the catalogue. Stiffness and ratings: Harmonic Drive, CSF/HFUS; friction, ratio 100: Schaeffler TPI 275
/// (RT1-H-CS), which has no size 11 and no size 32. Size 11: from the catalogue as known, not checked.
struct CatalogueSize
{
  double size;
  std::array<double, 2> breakpoints;       // [N.m]
  std::array<double, 3> stiffness_of_50;   // [N.m/rad]
  std::array<double, 3> stiffness;         // of ratio 80 and more [N.m/rad]
  double starting_torque, no_load_torque;  // [N.m]
};

struct CatalogueRating
{
  double size;
  int ratio;
  double repeated_peak, average, rated, momentary_peak;  // [N.m]
};

inline constexpr std::array<CatalogueSize, 6> CATALOGUE_SIZES{ {
    { 11.0, { 0.8, 2.0 }, { 2.2e3, 3.0e3, 3.2e3 }, { 2.7e3, 3.4e3, 4.4e3 }, 0.0, 0.0 },
    { 14.0, { 2.0, 6.9 }, { 3.4e3, 4.7e3, 5.7e3 }, { 4.7e3, 6.1e3, 7.1e3 }, 0.021, 0.035 },
    { 17.0, { 3.9, 12.0 }, { 8.1e3, 11e3, 13e3 }, { 10e3, 14e3, 16e3 }, 0.029, 0.051 },
    { 20.0, { 7.0, 25.0 }, { 13e3, 18e3, 23e3 }, { 16e3, 25e3, 29e3 }, 0.037, 0.105 },
    { 25.0, { 14.0, 48.0 }, { 25e3, 34e3, 44e3 }, { 31e3, 50e3, 57e3 }, 0.069, 0.195 },
    { 32.0, { 29.0, 108.0 }, { 54e3, 78e3, 98e3 }, { 67e3, 110e3, 120e3 }, 0.0, 0.0 },
} };

inline constexpr std::array<CatalogueRating, 24> CATALOGUE_RATINGS{ {
    { 11.0, 50, 8.3, 5.5, 3.5, 17.0 },         { 11.0, 100, 11.0, 8.9, 5.0, 25.0 },
    { 14.0, 50, 18.0, 6.9, 5.4, 35.0 },        { 14.0, 80, 23.0, 11.0, 7.8, 47.0 },
    { 14.0, 100, 28.0, 11.0, 7.8, 54.0 },      { 17.0, 50, 34.0, 26.0, 16.0, 70.0 },
    { 17.0, 80, 43.0, 27.0, 22.0, 87.0 },      { 17.0, 100, 54.0, 39.0, 24.0, 110.0 },
    { 17.0, 120, 54.0, 39.0, 24.0, 86.0 },     { 20.0, 50, 56.0, 34.0, 25.0, 98.0 },
    { 20.0, 80, 74.0, 47.0, 34.0, 127.0 },     { 20.0, 100, 82.0, 49.0, 40.0, 147.0 },
    { 20.0, 120, 87.0, 49.0, 40.0, 147.0 },    { 20.0, 160, 92.0, 49.0, 40.0, 147.0 },
    { 25.0, 50, 98.0, 55.0, 39.0, 186.0 },     { 25.0, 80, 137.0, 87.0, 63.0, 255.0 },
    { 25.0, 100, 157.0, 108.0, 67.0, 284.0 },  { 25.0, 120, 167.0, 108.0, 67.0, 304.0 },
    { 25.0, 160, 176.0, 108.0, 67.0, 314.0 },  { 32.0, 50, 216.0, 108.0, 76.0, 382.0 },
    { 32.0, 80, 304.0, 167.0, 118.0, 568.0 },  { 32.0, 100, 333.0, 216.0, 137.0, 647.0 },
    { 32.0, 120, 353.0, 216.0, 137.0, 686.0 }, { 32.0, 160, 372.0, 216.0, 137.0, 686.0 },
} };
}  // namespace hjt
