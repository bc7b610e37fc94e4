// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/recorded_ranking.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "arm/arm_configuration.hpp"

namespace hjt
{
namespace
{
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
}  // namespace

std::vector<ArmFit> rankArms(const RecordingOptions& options, const std::vector<std::string>& names)
{
  RecordingOptions own = options;
  own.load = LOAD_OF_ARM;
  if (own.rows)
  {
    own.assignments.emplace_back("telemetry.effort=current");  // as such rows are
  }
  std::vector<ArmCandidate> candidates;
  std::unique_ptr<const ArmRecording> first;  // has the rows of all candidates
  std::vector<std::string> others;            // whose joints have other names: they are of other rows
  for (const std::string& name : names)
  {
    own.arm = name;
    auto recording = std::make_unique<const ArmRecording>(own);
    if (!candidates.empty() && jointNames(recording->arm()) != jointNames(candidates.front().arm))
    {
      others.push_back(name);
      continue;
    }
    candidates.push_back({ name, recording->arm(), recording->parameters(), costOfGains(*recording, own) });
    if (!first)
    {
      first = std::move(recording);
    }
  }
  ParameterMap given;
  addOverlays(own, given);
  const auto play = [&](const VisitArmRows& visit) { first->readEfforts(visit, ArmFit::ENOUGH); };
  std::vector<ArmFit> fits = rankArms(candidates, play, given.count("telemetry.effort") > 0);
  if (!others.empty())
  {
    const std::vector<ArmFit> more = rankArms(options, others);
    fits.insert(fits.end(), more.begin(), more.end());
    std::stable_sort(fits.begin(), fits.end());
  }
  return fits;
}

std::string betterArm(const ArmRecording& recording)
{
  const RecordingOptions& options = recording.options();
  const std::vector<std::string> names = armsLike(recording.arm(), configDirectory(options));
  const std::string name = mainName(options.arm, configDirectory(options));
  return betterArm(name, names, [&](const std::vector<std::string>& of) { return rankArms(options, of); });
}
}  // namespace hjt
