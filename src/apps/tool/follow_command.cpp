// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/library_command.hpp"
#include "recordings/follow.hpp"

namespace hjt
{
namespace
{
using PrintedFollow = Printed<FollowOptions>;

int printFollowed(const PrintedFollow& options, const Followed& followed)
{
  if (!followed.joints.empty())
  {
    const Report report = reportOf(followed);
    printReport(options.json, report.lines, report.tables);
  }
  return EXIT_DONE;
}

const Subcommand FOLLOW{ Subject::RECORDING, "follow",
                         "runs a healthy joint on a recording: measured and predicted motion and current",
                         declarePrinted<FollowOptions>, runWatched<follow, printFollowed, true, PrintedFollow> };
}  // namespace
}  // namespace hjt
