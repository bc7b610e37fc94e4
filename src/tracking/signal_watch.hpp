// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "harmonic_joint_twin/health/assessment.hpp"
#include "health/signal_monitor.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// Health of a measured joint from its own signals, live and offline alike. Nothing allocates or throws after
/// construction.
class SignalWatch
{
public:
  explicit SignalWatch(const Parameters& parameters);

  /// The reference to hold the joint against; none: it is learned from the first windows.
  void setReference(std::vector<ReferenceBin> bins) { assessor_.setReference(std::move(bins)); }

  /// `sample`: its load holds weight and inertia too. True: a window is complete, and what follows is of it.
  bool update(const MotionSample& sample) noexcept;

  void reset() noexcept;

  const SignalIndicators& indicators() const noexcept { return monitor_.indicators(); }
  const Assessor& assessor() const noexcept { return assessor_; }

private:
  TelemetryParameters telemetry_;
  double ratio_;
  double temperature_;  // configured; telemetry has none [degC]
  SignalMonitor monitor_;
  Assessor assessor_;
};
}  // namespace hjt
