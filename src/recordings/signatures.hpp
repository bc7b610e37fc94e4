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
/// @throws InputError if signatures cannot be made of the runs of this plan. Each run must be recorded as a bag and
/// have no fault or one, which exists from the start on.
void checkSignaturePlan(const Plan& plan);

/// Changes of the health indicators by faults, from the runs of plans. A change is the last window of a run with one
/// fault, less that of the sound run under the same conditions. The mean over the conditions counts, for each motion
/// and severity. Severities between those that were run lie on straight lines, which begin with no change at 0.
class SignatureRuns
{
public:
  /// `notice` gets a text for each run that is left out because it failed.
  explicit SignatureRuns(std::function<void(const std::string&)> notice) : notice_(std::move(notice)) {}

  /// Adds the runs of a plan, which must be finished. @throws InputError if a run has no window, or no sound run under
  /// the same conditions.
  void add(const Plan& plan, const SweepDirectory& directory);

  /// Text of a file of signatures. Errors and `carried` are those of `basis`, because they take many gears to find.
  /// Sound values are those of the first motion. `rated_torque` is that at the output [N.m].
  std::string text(const std::string& gear, const SignatureSet& basis, double rated_torque) const;

private:
  using Changes = std::array<double, SIGNATURE_SIZE>;

  /// Sum of the changes over the conditions.
  struct Mean
  {
    Changes sum{};
    int count{};
  };

  /// A motion of a plan.
  struct Motion
  {
    std::string name;
    std::map<std::string, SignalIndicators> sound;        // sound windows by the conditions of the run
    std::map<std::pair<FaultKind, double>, Mean> faulty;  // changes by kind and severity of the fault
  };

  static void addFaulty(const Plan& plan, const RunSpec& spec, const SignalIndicators& window, Motion& motion);
  static std::vector<Signature> rows(FaultKind kind, const Motion& motion);

  const std::function<void(const std::string&)> notice_;
  std::vector<Motion> motions_;
};
}  // namespace hjt
