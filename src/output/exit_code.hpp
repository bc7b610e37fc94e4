// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hjt
{
/// The process' answer to the shell.
enum ExitCode : int
{
  EXIT_DONE = 0,
  EXIT_FAILED = 1,
  EXIT_USAGE = 2,
  EXIT_DEPARTS = 3,     ///< a verdict is as bad as the user asked to be told
  EXIT_NOT_JUDGED = 4,  ///< nothing could be judged, and the user asked for a verdict
  EXIT_STOPPED = 5,     ///< the arm stopped by itself
  EXIT_BY_SIGNAL = 128  ///< plus the signal's number
};
}  // namespace hjt
