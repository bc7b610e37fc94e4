// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/library_command.hpp"
#include "datasets/check_up_file.hpp"
#include "output/run_summary.hpp"

namespace hjt
{
namespace
{
int checkup(const Printed<CheckUpOptions>& options)
{
  printReport(options.json, reportOf(writeCheckUp(options)).lines);
  return reportWritten(options.out, options.json);
}

const Subcommand CHECKUP{ Subject::JOINT, "checkup",
                          "motion of an arm in which faults are seen best, within its limits of speed and torque",
                          declarePrinted<CheckUpOptions>, checkup };
}  // namespace
}  // namespace hjt
