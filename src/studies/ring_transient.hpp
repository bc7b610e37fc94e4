// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "studies/ring_method.hpp"

namespace hjt
{
/// Insertion of the wave generator as motion (thesis ch. 6): the wave's amplitude grows at constant speed from 0 to w0,
/// then stays; circular spline left out, wave generator held.
struct TransientSetup
{
  RingMethod method{ RingMethod::ESDIRK4 };
  double step{ 5e-6 };           ///< [s]
  double duration{ 0.05 };       ///< [s]
  double growth_time{ 5e-3 };    ///< in which the amplitude grows [s]
  double window_start{ 0.03 };   ///< from here to the end the largest force is summed up [s]
  double sample_period{ 5e-5 };  ///< of the rows [s]
  double tolerance{};  ///< of a tooth's position by one step, which is then at most `step`; 0: every step is it [m]
};

/// Largest force of the wave generator on a tooth, and where the energy is.
struct TransientRow
{
  double time{};          ///< [s]
  double force_max{};     ///< on any tooth at this instant [N]
  double force_lowest{};  ///< of it since the row before [N]
  double force_highest{};
  double radius_major_axis{};  ///< of tooth 0 [m]
  double stored{};             ///< since the start [J]
  double kinetic{};            ///< [J]
  double supplied{};           ///< by the wave generator's growth [J]
  double dissipated{};         ///< by the dashpots [J]
};

struct TransientResult
{
  bool finished{};
  double stopped_at{};  ///< [s]
  std::vector<TransientRow> rows;
  double window_lowest{};   ///< of the largest force, over all steps of the window [N]
  double window_highest{};  ///< [N]
  double window_mean{};     ///< [N]
  StepCounts counts;
  double solve_time{};          ///< [s]
  std::vector<double> tooth_x;  ///< at the end, per tooth [m]
  std::vector<double> tooth_y;
};

/// `progress` is called with the part done, 0 ... 1.
TransientResult analyseTransient(const Parameters& parameters, const TransientSetup& setup,
                                 const std::function<void(double)>& progress);
}  // namespace hjt
