// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "identification/controller_fit.hpp"
#include "output/report.hpp"
#include "recordings/recording_options.hpp"

namespace hjt
{
/// The controller of a joint.
struct IdentifiedController
{
  std::string name;  ///< short
  ControllerFit fit;
  bool is_limited{};  ///< the gain of the speed, to what the twin's loop bears
};

/// Gains of the controller of all joints of an arm (fitController) from a table with a controller's columns target_q_0,
/// target_qd_0, target_current_0, target_moment_0, actual_q_0, actual_qd_0, actual_current_0 ...; written into the
/// directory `out` if it is not empty, as GAINS_FILE. @throws ParameterError, InputError: unreadable, a column that is
/// missing, a file that cannot be written.
std::vector<IdentifiedController> identifyController(const RecordingOptions& options, const std::string& out);

Report reportOf(const std::vector<IdentifiedController>& joints);
}  // namespace hjt
