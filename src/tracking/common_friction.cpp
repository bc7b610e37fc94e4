// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/common_friction.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/statistics.hpp"

namespace hjt
{
namespace
{
/// Group of the joints from `begin` to before `end`, with the median of their friction ratios over `factors`.
JointGroup groupOf(const std::vector<MeasuredFriction>& joints, const std::vector<double>& factors, double tolerance,
                   std::size_t begin, std::size_t end)
{
  JointGroup group{ begin, end, 1.0, false };
  std::vector<double> left;
  for (std::size_t i = begin; i < end; ++i)
  {
    if (joints[i].ratio)
    {
      left.push_back(*joints[i].ratio / factors[i]);
    }
  }
  if (left.size() >= MIN_WITNESSES)
  {
    const double median = medianOf(left);
    const auto agree = static_cast<std::size_t>(std::count_if(
        left.begin(), left.end(), [&](double ratio) { return std::abs(ratio / median - 1.0) <= tolerance; }));
    group.is_known = median > 0.0 && 2 * agree > left.size();
    group.median = group.is_known ? median : 1.0;
  }
  return group;
}

/// Temperature at which the median over the joints of (measured friction / twin's friction) is 1 [degC]. None if a
/// temperature was received, or if the median is 1 at no temperature from COLDEST to WARMEST.
std::optional<double> temperatureOf(const std::vector<MeasuredFriction>& joints)
{
  constexpr double COLDEST = 0.0;  // lowest possible temperature of the drives [degC]
  constexpr double WARMEST = 60.0;
  constexpr int HALVINGS = 20;
  double low = COLDEST;
  double high = WARMEST;
  const auto is_colder = [&](double temperature)
  {
    std::vector<double> left;
    for (const MeasuredFriction& joint : joints)
    {
      if (joint.ratio)
      {
        left.push_back(*joint.ratio * joint.at(joint.temperature) / joint.at(temperature));
      }
    }
    return medianOf(left) > 1.0;
  };
  if (std::any_of(joints.begin(), joints.end(), [](const auto& joint) { return joint.temperature_received; }) ||
      is_colder(low) || !is_colder(high))
  {
    return std::nullopt;
  }
  for (int i = 0; i < HALVINGS; ++i)  // the twins' friction falls as the temperature rises
  {
    const double middle = 0.5 * (low + high);
    (is_colder(middle) ? high : low) = middle;
  }
  return low;
}

ArmFriction ofWholeArm(const std::vector<MeasuredFriction>& joints, double tolerance)
{
  ArmFriction arm;
  arm.factors.assign(joints.size(), 1.0);
  arm.deviations.assign(joints.size(), UNWITNESSED);
  const auto known = std::count_if(joints.begin(), joints.end(), [](const auto& joint) { return joint.ratio; });
  arm.is_known = static_cast<std::size_t>(known) >= MIN_WITNESSES;
  const JointGroup all = groupOf(joints, arm.factors, tolerance, 0, joints.size());
  if (all.is_known && std::abs(all.median - 1.0) > tolerance)
  {
    arm.factors.assign(joints.size(), all.median);
    arm.median = all.median;
    arm.temperature = temperatureOf(joints);
  }
  return arm;
}

/// Standard deviation of the logarithm of the mean factor of the group's joints without `joint`, by the part of their
/// scatter that exceeds the scatter of sound joints from one recording to the next [-].
double scatterBeside(std::size_t joint, const JointGroup& group, const std::vector<MeasuredFriction>& joints,
                     const std::vector<double>& factors)
{
  double count = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = group.begin; i < group.end; ++i)
  {
    if (i != joint && joints[i].ratio && *joints[i].ratio > 0.0)
    {
      const double logarithm = std::log(*joints[i].ratio / factors[i]);
      count += 1.0;
      sum += logarithm;
      squares += logarithm * logarithm;
    }
  }
  const double variance = count > 1.0 ? (squares - sum * sum / count) / (count - 1.0) : 0.0;
  return count > 1.0 ? std::sqrt(std::max(0.0, variance - UNWITNESSED * UNWITNESSED) / count) : 0.0;
}

/// Multiplies the factors in `arm` of the group's joints by the common factor of the group, and sets their deviations.
void take(const JointGroup& group, const std::vector<MeasuredFriction>& joints, ArmFriction& arm)
{
  const auto begin = joints.begin() + static_cast<std::ptrdiff_t>(group.begin);
  const auto end = joints.begin() + static_cast<std::ptrdiff_t>(group.end);
  const bool are_own = std::all_of(begin, end, [](const MeasuredFriction& joint) { return joint.is_to_own; });
  const double beyond = std::max(0.0, std::abs(group.median - 1.0) - (are_own ? 0.0 : NO_WITNESS));
  const double common = 1.0 + std::copysign(beyond, group.median - 1.0);
  const std::vector<double> of_arm = arm.factors;
  for (std::size_t i = group.begin; i < group.end && group.is_known; ++i)
  {
    const double left = joints[i].ratio ? *joints[i].ratio / of_arm[i] : common;
    arm.factors[i] *= common > 1.0 ? std::min(common, std::max(left, 1.0)) : common;
    arm.deviations[i] = std::hypot(joints[i].is_to_own && !are_own ? NO_WITNESS : 0.0,
                                   common < 1.0 ? scatterBeside(i, group, joints, of_arm) : 0.0);
  }
}

/// Whether a joint has more than FAR_MORE times the friction expected with `factors`, as a larger joint would.
bool hasFarMore(const std::vector<MeasuredFriction>& joints, const std::vector<double>& factors)
{
  constexpr double FAR_MORE = 2.0;  // multiple of the expected friction [-]
  bool has_one = false;
  for (std::size_t i = 0; i < joints.size(); ++i)
  {
    has_one = has_one || (joints[i].ratio && *joints[i].ratio > FAR_MORE * factors[i]);
  }
  return has_one;
}
}  // namespace

ArmFriction commonFriction(const std::vector<MeasuredFriction>& joints, double tolerance)
{
  constexpr std::ptrdiff_t SEVERAL = 2;
  ArmFriction arm = ofWholeArm(joints, tolerance);
  const bool is_other = hasFarMore(joints, arm.factors);
  const std::size_t half = jointsToElbow(joints.size());
  arm.groups = { groupOf(joints, arm.factors, tolerance, 0, half),
                 groupOf(joints, arm.factors, tolerance, half, joints.size()) };
  for (const JointGroup& group : arm.groups)
  {
    take(group, joints, arm);
  }
  const auto number = [&](bool MeasuredFriction::*flag)
  { return std::count_if(joints.begin(), joints.end(), [&](const MeasuredFriction& joint) { return joint.*flag; }); };
  if (number(&MeasuredFriction::is_against) >= SEVERAL)
  {
    arm.misfit = { Reason::EFFORT_NOT_CURRENT,
                   "the efforts of several joints have the opposite sign of the currents that their motion needs: the "
                   "sign of the efforts or of the angles is wrong" };
  }
  else if (number(&MeasuredFriction::is_none) >= SEVERAL &&
           number(&MeasuredFriction::is_none) == number(&MeasuredFriction::is_below_faults))
  {
    arm.misfit = { Reason::NO_FRICTION,
                   "the efforts of several joints show no friction: the efforts are modelled or commanded torques, not "
                   "measured torques" };
  }
  else if (number(&MeasuredFriction::is_below_faults) >= SEVERAL)
  {
    arm.misfit = { Reason::LESS_THAN_FAULTS,
                   "several joints show less than half of the expected friction, which no fault causes. Possible "
                   "reasons: somebody moves the arm by hand, or a gain, ratio or sign is not as configured" };
  }
  else if (number(&MeasuredFriction::is_load_wrong) + number(&MeasuredFriction::is_below_faults) >= SEVERAL)
  {
    arm.misfit = {
      Reason::LOAD_WRONG,
      "the currents of several joints fit no load of this arm. Possible reasons are another arm, gain, payload or "
      "mounting than configured, a payload picked up or put down, joints in another order, angles with another zero "
      "or sign, and disturbed currents"
    };
  }
  else if (number(&MeasuredFriction::is_below_faults) > 0 && is_other)
  {
    arm.misfit = {
      Reason::LESS_THAN_FAULTS,
      "one joint shows less than half of the expected friction, and another joint more than twice the expected "
      "friction: the joints are in another order, or gains, ratios or signs are not as configured"
    };
  }
  return arm;
}
}  // namespace hjt
