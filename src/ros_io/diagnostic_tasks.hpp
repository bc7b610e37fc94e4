// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <ros/publisher.h>
#include <ros/time.h>

namespace hjt
{
/// Level and text of one diagnostic task.
struct DiagnosticVerdict
{
  std::uint8_t level{};
  std::string text;
};

/// Tasks of /diagnostics, each with a verdict and values: reported every `~diagnostic_period`, 1 s if that is not set,
/// by the wall clock, since a simulated one may stand, and at once when a level changes. diagnostic_updater::Updater
/// cannot serve: it adds to the time of the clock, and throws where that is near the last one.
class DiagnosticTasks
{
public:
  static constexpr double LOOK_PERIOD = 0.05;  ///< between two calls of `look` [s]

  explicit DiagnosticTasks(const std::string& hardware_id);

  void add(const std::string& name, std::function<DiagnosticVerdict()> judge,
           std::function<void(diagnostic_updater::DiagnosticStatusWrapper&)> report);

  /// Judges every task, and reports if it is time.
  void look();

private:
  struct Task
  {
    std::string name;
    std::function<DiagnosticVerdict()> judge;
    std::function<void(diagnostic_updater::DiagnosticStatusWrapper&)> report;
    DiagnosticVerdict verdict;
  };
  void report() const;

  const std::string hardware_id_;
  double period_;  // [s]
  std::vector<Task> tasks_;
  ros::WallTime last_report_;
  ros::Publisher publisher_;
};
}  // namespace hjt
