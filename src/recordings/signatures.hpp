// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "datasets/sweep_directory.hpp"

#include "harmonic_joint_twin/health/fault_signatures.hpp"

namespace hjt
{
/// @throws InputError if signatures cannot be made of this plan's runs: each has no fault or one, there from the start
/// on, and is recorded as a bag.
void checkSignaturePlan(const Plan& plan);

/// Changes of the health indicators by faults, from the runs of plans: the last window of each run with one fault less
/// that of the sound run under the same conditions, the mean over the conditions, by motion and severity. Other
/// severities lie on straight lines between those that were run, from nothing at 0 on.
class SignatureRuns
{
public:
  /// `notice`: told of each run that is left out as it failed.
  explicit SignatureRuns(std::function<void(const std::string&)> notice) : notice_(std::move(notice)) {}

  /// The runs of a plan, all finished. @throws InputError if one has no window, or no sound one under its conditions.
  void add(const Plan& plan, const SweepDirectory& directory);

  /// A file of signatures. `basis`: its errors and `carried` are taken over, as they take many gears to find. Sound
  /// values are those of the first motion. `rated_torque`: at the output [N.m].
  std::string text(const std::string& gear, const SignatureSet& basis, double rated_torque) const;

private:
  using Changes = std::array<double, SIGNATURE_SIZE>;

  /// Over the conditions.
  struct Mean
  {
    Changes sum{};
    int count{};
  };

  /// A motion of a plan.
  struct Motion
  {
    std::string name;
    std::map<std::string, SignalIndicators> sound;        // by the run's conditions
    std::map<std::pair<FaultKind, double>, Mean> faulty;  // by kind and severity
  };

  static void addFaulty(const Plan& plan, const RunSpec& spec, const SignalIndicators& window, Motion& motion);
  static std::vector<Signature> rows(FaultKind kind, const Motion& motion);

  const std::function<void(const std::string&)> notice_;
  std::vector<Motion> motions_;
};
}  // namespace hjt
