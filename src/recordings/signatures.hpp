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
/// @throws InputError if signatures cannot be made from the runs of this plan. Each run must be recorded as a bag and
/// have at most one fault, which exists from the start.
void checkSignaturePlan(const Plan& plan);

/// Changes of the indicators by faults, computed from the runs of plans. A change is the last window of a run with one
/// fault minus that of the sound run of the same conditions. For each motion and severity, the changes are averaged
/// over the conditions. Between the simulated severities, they are interpolated linearly, from 0 at severity 0.
class SignatureRuns
{
public:
  /// `notice` is called with a text for each run that is skipped because it failed.
  explicit SignatureRuns(std::function<void(const std::string&)> notice) : notice_(std::move(notice)) {}

  /// Adds the runs of a finished plan. @throws InputError if a run lacks a window or a sound run of its conditions.
  void add(const Plan& plan, const SweepDirectory& directory);

  /// Text of a file of signatures. Errors and `carried` are copied from `basis`, because many gears are needed to find
  /// them. Sound values are those of the first motion. `rated_torque` is the rated torque at the output [N.m].
  std::string text(const std::string& gear, const SignatureSet& basis, double rated_torque) const;

private:
  using Changes = std::array<double, SIGNATURE_SIZE>;

  /// Sum of the changes over the conditions, and the number of conditions.
  struct Mean
  {
    Changes sum{};
    int count{};
  };

  /// Windows and changes of one motion of a plan.
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
