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
  double every{ 250.0 };  ///< time of use between two assessments [h]
  bool grease_changes{};  ///< whether the grease is changed when due
};

/// Forecasts of the remaining life at the time of one assessment, with the true remaining life.
struct LifeForecast
{
  double hours{};      ///< hours of use at the forecast
  double remaining{};  ///< true remaining life [h]
  Assessment assessment;
  RemainingHours forecast;  ///< forecast from the use and the assessment
  RemainingHours read;      ///< forecast from the use and all wear readings so far
  RemainingHours prior;     ///< forecast from the use alone

  /// Whether the interval from the 10 % to the 90 % quantile of `read` contains the true remaining life.
  bool held() const { return remaining >= read.quantile[1] && remaining <= read.quantile[3]; }
};

struct LifeTrial
{
  UnitVariation variation;
  DriveAgeing::Life life;
  std::vector<LifeForecast> forecasts;  ///< forecasts during the life; empty if the life did not end
};

/// Number of forecasts, and number of forecasts whose 80 % interval contained the true remaining life.
struct Coverage
{
  int forecasts{};
  int held{};

  double share() const { return forecasts > 0 ? static_cast<double>(held) / forecasts : 0.0; }
};

/// Coverage over the forecasts that were made after the share `from` of each life.
Coverage coverage(const std::vector<LifeTrial>& trials, double from);

/// Draws drives at random, simulates each drive to the end of its life, and forecasts its remaining life. The forecasts
/// know the drive's use, and assessments and readings with errors, but neither its UnitVariation nor its true wear.
/// `longest`: duration above which a life has no forecasts [h].
std::vector<LifeTrial> runLifeTrials(const Parameters& parameters, const DriveAgeing& ageing,
                                     const LifeTrialOptions& options, double longest,
                                     const std::function<void(double)>& progress);
}  // namespace hjt
