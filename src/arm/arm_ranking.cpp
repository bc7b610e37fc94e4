// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_ranking.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "arm/arm_load.hpp"
#include "arm/load_fit.hpp"
#include "arm/recording_fit.hpp"
#include "params/choices.hpp"
#include "tracking/motion_driven.hpp"

namespace hjt
{
namespace
{
/// The parameters of the joints, with `unit` as the unit of their efforts.
std::vector<Parameters> withUnit(std::vector<Parameters> joints, EffortUnit unit)
{
  for (Parameters& joint : joints)
  {
    joint.telemetry.effort = unit;
  }
  return joints;
}

/// Compares the currents in the rows of an arm with those of the twins of one candidate.
class ArmTrial
{
public:
  ArmTrial(const ArmCandidate& candidate, EffortUnit unit) : ArmTrial(candidate, withUnit(candidate.joints, unit)) {}

  /// Adds a sample without torques, with efforts in `current`. `counts`: whether the fit of the load uses the sample.
  void add(const ArmSample& sample, bool counts)
  {
    sample_ = sample;
    for (std::size_t i = 0; i < twins_.size(); ++i)
    {
      sample_.joints[i].current = sample_.own[i].current *= twins_[i].currentPerEffort();
    }
    torques_.addTo(sample_);
    fit_.update(sample_.joints, sample_.torques);
    for (std::size_t i = 0; i < twins_.size(); ++i)
    {
      twins_[i].move(sample_.own[i]);
      sample_.own[i].load = sample_.torques[i];
      if (counts)
      {
        twins_[i].bear(sample_.own[i]);
      }
    }
    if (counts)
    {
      load_fit_.add(sample_.own, [this](std::size_t i) -> const MotionDriven& { return twins_[i]; });
    }
  }

  ArmFit fit()
  {
    const LoadFit::Fit fit = load_fit_.explained(fit_.measured());
    return { name_, unit_, fit.size, fit.left, fit.cost + cost_ };
  }

  /// The unit of the efforts with which the load explains clearly more of the currents than with the configured unit;
  /// if there is no such unit, the configured unit.
  EffortUnit likeliestUnit() const
  {
    constexpr double CLEARLY = 0.5;
    EffortUnit best = unit_;
    for (const EffortUnit unit : { EffortUnit::CURRENT, EffortUnit::JOINT_TORQUE, EffortUnit::MOTOR_TORQUE })
    {
      best = fit_.loadRest(unit).share() < CLEARLY * fit_.loadRest(best).share() ? unit : best;
    }
    return best;
  }

private:
  ArmTrial(const ArmCandidate& candidate, const std::vector<Parameters>& joints)
    : name_(candidate.name)
    , unit_(joints.front().telemetry.effort)
    , cost_(candidate.cost)
    , torques_(candidate.arm)
    , fit_(joints)
    , load_fit_(candidate.arm, joints)
    , twins_(joints.begin(), joints.end())
  {
  }

  std::string name_;
  EffortUnit unit_;
  double cost_;
  LinkTorques torques_;
  RecordingFit fit_;
  LoadFit load_fit_;
  std::vector<MotionDriven> twins_;
  ArmSample sample_;
};

using Trials = std::vector<std::unique_ptr<ArmTrial>>;

/// Gives all rows to the trials. Computes the rates of the rows only once, because all trials need the same rates.
void play(const PlayArmRows& rows, const Trials& trials, std::size_t joints)
{
  ArmRates rates(joints);
  double last_time = -HUGE_VAL;  // time of the last sample that counted [s]
  const auto forward = [&](bool at_end)
  {
    while (const ArmSample* sample = rates.pop(at_end))
    {
      const double time = sample->own.front().time;
      const bool counts = time >= last_time + LoadFit::PERIOD;
      last_time = counts ? time : last_time;
      for (const auto& trial : trials)
      {
        trial->add(*sample, counts);
      }
    }
  };
  rows(
      [&](const std::vector<MotionRow>& of_one_time)
      {
        rates.push(of_one_time);
        forward(false);
      });
  forward(true);
}

bool mayBeOther(const Misfit& misfit)
{
  return !misfit.exists() || misfit.reason == Reason::LOAD_WRONG;
}
}  // namespace

std::vector<ArmFit> rankArms(const std::vector<ArmCandidate>& candidates, const PlayArmRows& rows, bool unit_is_given)
{
  Trials trials;
  for (const ArmCandidate& candidate : candidates)
  {
    trials.push_back(std::make_unique<ArmTrial>(candidate, candidate.joints.front().telemetry.effort));
  }
  play(rows, trials, candidates.front().joints.size());
  Trials others;  // trials of candidates whose likeliest unit is not the configured one
  for (std::size_t i = 0; i < candidates.size() && !unit_is_given; ++i)
  {
    const EffortUnit unit = trials[i]->likeliestUnit();
    if (unit != candidates[i].joints.front().telemetry.effort)
    {
      trials[i].reset();
      others.push_back(std::make_unique<ArmTrial>(candidates[i], unit));
    }
  }
  if (!others.empty())
  {
    play(rows, others, candidates.front().joints.size());
  }
  std::vector<ArmFit> fits;
  auto other = others.begin();
  for (const auto& trial : trials)
  {
    fits.push_back(trial ? trial->fit() : (*other++)->fit());
  }
  std::stable_sort(fits.begin(), fits.end());
  return fits;
}

std::string betterArm(const std::string& own, std::vector<std::string> names, const RankArms& rank)
{
  const auto others = std::remove(names.begin(), names.end(), own);
  if (others == names.begin() || others == names.end())
  {
    return {};
  }
  names.erase(others, names.end());
  const ArmFit given = rank({ own }).front();
  if (given.cost < LoadFit::leastCost() + ArmFit::CONTRADICTED)
  {
    return {};
  }
  const ArmFit best = rank(names).front();
  return best.isBetter(given, ArmFit::CONTRADICTED) ? best.arm : std::string();
}

std::string otherArmText(const std::string& other)
{
  return "the arm may be a " + other + ", which explains the currents clearly better than the given arm";
}

void nameOtherArm(const std::string& other, std::vector<Misfit>& misfits)
{
  std::replace_if(misfits.begin(), misfits.end(), mayBeOther, Misfit{ Reason::LOAD_WRONG, otherArmText(other) });
}

bool mayBeOtherArm(const std::vector<Misfit>& misfits)
{
  return std::any_of(misfits.begin(), misfits.end(), mayBeOther);
}
}  // namespace hjt
