// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/time.h>

namespace hjt
{
/// Level and text of one diagnostic task.
struct DiagnosticVerdict
{
  std::uint8_t level{};
  std::string text;
};

/// Tasks of /diagnostics, each with a verdict and values: reported about once a second by the wall clock, since a simulated
/// one may stand, and at once when a level changes.
class DiagnosticTasks
{
public:
  static constexpr double LOOK_PERIOD = 0.05;  ///< between two calls of `look` [s]

  explicit DiagnosticTasks(const std::string& hardware_id) { updater_.setHardwareID(hardware_id); }

  void add(const std::string& name, std::function<DiagnosticVerdict()> judge,
           const std::function<void(diagnostic_updater::DiagnosticStatusWrapper&)>& report);

  /// Judges every task, and reports if it is time.
  void look();

private:
  struct Task
  {
    std::function<DiagnosticVerdict()> judge;
    DiagnosticVerdict verdict;
  };

  std::list<Task> tasks_;  // which the updater's callbacks refer to
  ros::WallTime last_report_;
  diagnostic_updater::Updater updater_;
};
}  // namespace hjt
