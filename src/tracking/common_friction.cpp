// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/common_friction.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "tracking/tracker.hpp"

namespace hjt
{
namespace
{
constexpr std::size_t MIN_JOINTS = 3;  // that witness for each other

/// Of at least one value.
double medianOf(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}
}  // namespace

ArmFriction commonFriction(const std::vector<MeasuredFriction>& joints, double tolerance)
{
  constexpr double COLDEST = 0.0;  // [degC]
  constexpr double WARMEST = 60.0;
  constexpr int HALVINGS = 20;
  constexpr double TINY = 1e-3;        // of a ratio, which may be zero
  constexpr double MAX_MISFIT = 0.67;  // of a temperature, over that without: it makes one faulty joint fit a little
  ArmFriction arm{ std::vector<double>(joints.size(), 1.0), 1.0, std::nullopt };
  std::vector<std::size_t> known;
  bool is_received = false;
  for (std::size_t i = 0; i < joints.size(); ++i)
  {
    is_received = is_received || joints[i].temperature_received;
    if (joints[i].ratio)
    {
      known.push_back(i);
    }
  }
  if (known.size() < MIN_JOINTS)
  {
    return arm;
  }
  const auto left_over = [&](const std::vector<double>& factors)
  {
    std::vector<double> left;
    for (const std::size_t i : known)
    {
      left.push_back(*joints[i].ratio / factors[i]);
    }
    return left;
  };
  const auto agreeing = [&](const std::vector<double>& factors)
  {
    const std::vector<double> left = left_over(factors);
    return static_cast<std::size_t>(
        std::count_if(left.begin(), left.end(), [&](double ratio) { return std::abs(ratio - 1.0) <= tolerance; }));
  };
  const auto misfit = [&](const std::vector<double>& factors)
  {
    double sum = 0.0;
    for (const double ratio : left_over(factors))
    {
      sum += std::abs(std::log(std::max(ratio, TINY)));
    }
    return sum;
  };
  const auto factors_at = [&](double temperature)
  {
    std::vector<double> factors;
    for (const MeasuredFriction& joint : joints)
    {
      factors.push_back(joint.at(temperature) / joint.at(joint.temperature));
    }
    return factors;
  };

  const double median = medianOf(left_over(arm.factors));
  const std::vector<double> alike(joints.size(), median);
  double low = COLDEST;
  double high = WARMEST;
  const auto is_colder = [&](double temperature) { return medianOf(left_over(factors_at(temperature))) > 1.0; };
  const bool has_temperature = !is_received && !is_colder(low) && is_colder(high);
  for (int i = 0; has_temperature && i < HALVINGS; ++i)  // the twins' friction falls with the temperature
  {
    const double middle = 0.5 * (low + high);
    (is_colder(middle) ? high : low) = middle;
  }
  const std::vector<double> at_temperature = has_temperature ? factors_at(low) : arm.factors;

  const std::size_t most = known.size() / 2 + 1;
  const bool is_factor = std::abs(median - 1.0) > tolerance && agreeing(alike) >= most;
  const std::vector<double>& otherwise = is_factor ? alike : arm.factors;
  const std::size_t agree = agreeing(otherwise);
  if (has_temperature && agree < known.size() && agreeing(at_temperature) >= std::max(most, agree) &&
      misfit(at_temperature) <= MAX_MISFIT * misfit(otherwise))
  {
    arm = { at_temperature, median, low };
  }
  else if (is_factor)
  {
    arm = { alike, median, has_temperature ? std::make_optional(low) : std::nullopt };
  }
  return arm;
}

ArmFrictionWatch::ArmFrictionWatch(std::vector<Tracker*> joints, double tolerance)
  : joints_(std::move(joints)), tolerance_(tolerance)
{
}

void ArmFrictionWatch::reset()
{
  for (Tracker* joint : joints_)
  {
    joint->setTemperature(std::nullopt);
  }
  *this = ArmFrictionWatch(std::move(joints_), tolerance_);
}

bool ArmFrictionWatch::look(double time)
{
  if (time < next_look_ - 2.0 * PERIOD)  // a new recording
  {
    reset();
  }
  if (time < next_look_)
  {
    return false;
  }
  next_look_ = time + PERIOD;
  std::vector<MeasuredFriction> joints;
  std::size_t known = 0;
  for (const Tracker* joint : joints_)
  {
    joints.push_back(joint->friction());
    known += joints.back().ratio ? 1 : 0;
  }
  const ArmFriction found = commonFriction(joints, tolerance_);
  const bool differs = std::abs(found.median - found_.median) > CHANGE ||
                       found.temperature.has_value() != found_.temperature.has_value();
  steady_ = differs && known >= MIN_JOINTS ? steady_ + 1 : 0;
  if (steady_ < LOOKS)
  {
    return false;
  }
  steady_ = 0;
  found_ = found;
  for (Tracker* joint : joints_)
  {
    joint->setTemperature(found.temperature);
  }
  return true;
}
}  // namespace hjt
