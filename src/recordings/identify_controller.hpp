// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "identification/controller_fit.hpp"
#include "output/report.hpp"
#include "recordings/recording_options.hpp"

namespace hjt
{
/// The identified controller of a joint.
struct IdentifiedController
{
  std::string name;  ///< short name
  ControllerFit fit;
  bool is_limited{};  ///< whether the speed gain was limited to what the twin's loop bears
};

/// Identifies the gains of the controller of all joints of an arm (fitController). The recording is a table with the
/// columns target_q_0, target_qd_0, target_current_0, target_moment_0, actual_q_0, actual_qd_0, actual_current_0 and so
/// on. The gains are written as GAINS_FILE into the directory `out`, unless that is empty. @throws ParameterError,
/// InputError if a file cannot be read or written, or a column is missing.
std::vector<IdentifiedController> identifyController(const RecordingOptions& options, const std::string& out);

Report reportOf(const std::vector<IdentifiedController>& joints);
}  // namespace hjt
