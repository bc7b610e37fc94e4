// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include "test/support/allocation_count.hpp"
#include "test/support/temporary_folder.hpp"
#include "test_parameters.hpp"

#include "gear/angle.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "life/drive_ageing.hpp"
#include "life/life_estimate.hpp"
#include "life/revolution_load_map.hpp"
#include "studies/life_trials.hpp"

namespace hjt
{
constexpr int POSITIONS = 4;

inline LifeParameters shippedLife()
{
  return shippedParameters().life;
}

inline DutyCycle ratedDuty(double temperature)
{
  const LifeParameters life = shippedLife();
  DutyCycle duty;
  duty.phases.push_back({ 10.0, life.rated_speed, life.rated_torque, temperature });
  return duty;
}

/// The rated duty on the tooth model, measured once for all tests.
struct RatedUse
{
  RatedUse()
    : parameters(shippedParameters())
    , duty(ratedDuty(parameters.life.grease_temperature))
    , load_map(parameters, POSITIONS)
    , ageing(parameters, duty, load_map)
  {
    load_map.cover(duty, {});
  }

  Parameters parameters;
  DutyCycle duty;
  RevolutionLoadMap load_map;
  DriveAgeing ageing;
};

inline const RatedUse& ratedUse()
{
  static const RatedUse USE;
  return USE;
}

/// A drive whose flanks are worn by some length of a use that only wears them, and assessments of it.
struct FlankUse
{
  FlankUse() : parameters(shippedParameters())
  {
    parameters.life.bearing_l10 *= 1e3;  // leave the bearing out
    parameters.life.bearing_l50 *= 1e3;
    hourly = 1e-3 * parameters.life.flank_wear_limit;
    for (int i = 0; i < 200; ++i)
    {
      ahead.usage.push_back(until(i * ahead.step));
    }
  }

  Usage until(double hours) const { return { hourly * hours, hourly * hours, 0.0, 0.0 }; }

  RemainingHours after(double hours, const Assessment* assessment) const
  {
    return RemainingLife(parameters).remaining(until(hours), ahead, assessment, {});
  }

  Parameters parameters;
  double hourly;
  FutureLoad ahead{ 100.0, {} };
};

inline Assessment foundWear(double severity, double deviation)
{
  Assessment assessment;
  assessment.state = AssessmentState::ASSESSED;
  assessment.level = HealthLevel::WARN;
  assessment.cause = causeOf(FaultKind::TOOTH_WEAR);
  assessment.confidence = 1.0;
  assessment.severity = severity;
  assessment.severity_deviation = deviation;
  return assessment;
}

inline double width(const RemainingHours& remaining)
{
  return remaining.quantile[3] - remaining.quantile[1];
}
}  // namespace hjt
