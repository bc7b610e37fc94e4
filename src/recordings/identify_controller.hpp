// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "identification/controller_fit.hpp"
#include "output/report.hpp"
#include "recordings/recording_options.hpp"

namespace hjt
{
struct IdentifiedController
{
  std::string name;  ///< short name of the joint
  ControllerFit fit;
  bool is_limited{};  ///< whether the speed gain was limited, because the twin's loop would otherwise be unstable
};

/// Identifies the gains of the controller for all joints of an arm (fitController). The recording is a table with the
/// columns target_q_N, target_qd_N, target_current_N, target_moment_N, actual_q_N, actual_qd_N and actual_current_N of
/// each joint N. The gains are written as GAINS_FILE into the directory `out`, unless `out` is empty.
/// @throws ParameterError, InputError if a file cannot be read or written, or a column is missing.
std::vector<IdentifiedController> identifyController(const RecordingOptions& options, const std::string& out);

Report reportOf(const std::vector<IdentifiedController>& joints);
}  // namespace hjt
