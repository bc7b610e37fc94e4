// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/arm_ranking.hpp"

#include <algorithm>
#include <cmath>

#include "arm/arm_configuration.hpp"
#include "recordings/load_collector.hpp"
#include "recordings/recorded_arms.hpp"
#include "tracking/effort.hpp"
#include "tracking/motion_driven.hpp"

namespace hjt
{
namespace
{
constexpr double ENOUGH = 120.0;  // [s]
constexpr double PERIOD = 0.02;   // of the rows that count, at least [s]

/// Rows of all joints as they are read, and the currents of the arm's twins.
class ArmTrial
{
public:
  explicit ArmTrial(const ArmRecording& recording) : load_(recording)
  {
    for (const Parameters& parameters : recording.parameters())
    {
      twins_.emplace_back(parameters);
    }
  }

  void add(const std::vector<ArmJointRow>& rows)
  {
    const bool counts = rows.front().row.time >= last_time_ + PERIOD;
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      const MotionSample& sample = rows[i].row;
      const double predicted = twins_[i].step(sample).current;
      if (counts)
      {
        load_.add(i, sample, predicted);
      }
    }
    last_time_ = counts ? rows.front().row.time : last_time_;
  }

  /// `fit`: of the same rows.
  LoadProblem::Fit explained(const RecordingFit& fit)
  {
    std::vector<bool> measured;
    for (std::size_t i = 0; i < twins_.size(); ++i)
    {
      measured.push_back(fit.isMeasured(i));
    }
    return load_.fit().explained(measured);
  }

private:
  LoadCollector load_;
  std::vector<MotionDriven> twins_;
  double last_time_{ -HUGE_VAL };  // that counted [s]
};

/// Stated gains are exact, those of a type too where they are known: a few that agree tell the arm.
double costOfGains(const ArmRecording& recording, const RecordingOptions& options)
{
  constexpr double KNOWN = 0.01;  // deviation of the logarithm
  constexpr double MOST = 10.0;   // of one joint: where the type's is not known any may be
  double cost = 0.0;
  for (std::size_t i = 0; i < recording.joints().size(); ++i)
  {
    const double stated = recording.statedGains()[i];
    if (std::isfinite(stated))
    {
      const double type = parseParameters(armJointParameters(recording.joints()[i], configDirectory(options), ""))
                              .telemetry.torque_per_current;
      cost += std::min(0.5 * std::pow(std::log(std::abs(stated) / type) / KNOWN, 2), MOST);
    }
  }
  return cost;
}

/// The unit of the efforts that leaves clearly less than the configured one.
EffortUnit unitOf(const RecordingFit& fit, EffortUnit configured)
{
  constexpr double CLEARLY = 0.5;
  EffortUnit best = configured;
  for (const EffortUnit unit : { EffortUnit::CURRENT, EffortUnit::JOINT_TORQUE, EffortUnit::MOTOR_TORQUE })
  {
    best = fit.loadRest(unit).share() < CLEARLY * fit.loadRest(best).share() ? unit : best;
  }
  return best;
}

ArmFit fitOf(const RecordingOptions& options, bool unit_is_given)
{
  const ArmRecording recording(options);
  RecordingFit fit(recording.parameters());
  ArmTrial trial(recording);
  recording.read([&](const std::vector<ArmJointRow>& rows) { trial.add(rows); }, fit, ENOUGH);
  const EffortUnit configured = recording.parameters(0).telemetry.effort;
  const EffortUnit unit = unit_is_given ? configured : unitOf(fit, configured);
  if (unit != configured)
  {
    RecordingOptions other = options;
    other.assignments.push_back(std::string("telemetry.effort=") + effortKeyword(unit));
    return fitOf(other, true);
  }
  const LoadProblem::Fit explained = trial.explained(fit);
  return { options.arm, unit, explained.left, explained.cost + costOfGains(recording, options) };
}
}  // namespace

std::vector<ArmFit> rankArms(const RecordingOptions& options, const std::vector<std::string>& names)
{
  const bool unit_is_given = std::any_of(options.assignments.begin(), options.assignments.end(),
                                         [](const auto& text) { return text.find("telemetry.effort") == 0; });
  RecordingOptions own = options;
  own.load = LOAD_OF_ARM;
  std::vector<ArmFit> fits;
  for (const std::string& name : names)
  {
    own.arm = name;
    fits.push_back(fitOf(own, unit_is_given));
  }
  std::stable_sort(fits.begin(), fits.end(), [](const ArmFit& a, const ArmFit& b) { return a.cost < b.cost; });
  return fits;
}

std::string betterArm(const ArmRecording& recording)
{
  const RecordingOptions& options = recording.options();
  const std::vector<std::string> names = armsLike(recording.arm(), options);
  if (std::find(names.begin(), names.end(), options.arm) == names.end())
  {
    return {};
  }
  const std::vector<ArmFit> fits = rankArms(options, names);
  const auto own = std::find_if(fits.begin(), fits.end(), [&](const ArmFit& fit) { return fit.arm == options.arm; });
  return fits.front().isBetter(*own, ArmFit::CONTRADICTED) ? fits.front().arm : std::string();
}
}  // namespace hjt
