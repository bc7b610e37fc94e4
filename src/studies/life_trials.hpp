// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "life/drive_ageing.hpp"
#include "life/remaining_life.hpp"

namespace hjt
{
struct LifeTrialOptions
{
  int lives{ 100 };
  std::uint32_t seed{ 1 };
  double every{ 250.0 };  ///< hours of use between two assessments
  bool grease_changes{};
};

/// A forecast at one assessment, and the true life.
struct LifeForecast
{
  double hours{};      ///< of use when the forecast was made
  double remaining{};  ///< true remaining life [h]
  Assessment assessment;
  RemainingHours forecast;  ///< by it
  RemainingHours read;      ///< by what all check-ups so far read of wear
  RemainingHours prior;     ///< of who knows the use alone

  /// The interval from the 10 to the 90 % quantile of the readings' forecast holds the truth.
  bool held() const { return remaining >= read.quantile[1] && remaining <= read.quantile[3]; }
};

struct LifeTrial
{
  UnitVariation variation;
  DriveAgeing::Life life;
  std::vector<LifeForecast> forecasts;  ///< none if the life did not end
};

/// How often an interval that should hold 80 % of all outcomes did.
struct Coverage
{
  int forecasts{};
  int held{};

  double share() const { return forecasts > 0 ? static_cast<double>(held) / forecasts : 0.0; }
};

/// Over all forecasts from a share `from` of each life on.
Coverage coverage(const std::vector<LifeTrial>& trials, double from);

/// Drives drawn from the spread of the parameters, each worn by the laws until its end, and forecast by one who knows
/// its use and what assessments with their errors say of its wear, but neither its variation nor its wear.
/// `longest`: a life still going on then is left out [h].
std::vector<LifeTrial> runLifeTrials(const Parameters& parameters, const DriveAgeing& ageing,
                                     const LifeTrialOptions& options, double longest,
                                     const std::function<void(double)>& progress);
}  // namespace hjt
