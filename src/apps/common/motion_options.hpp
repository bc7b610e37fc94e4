// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "apps/common/configuration.hpp"

#include "recordings/recording_options.hpp"

namespace hjt
{
/// Options of a function on recordings, on the command line.
template <class Options>
struct Printed : Options
{
  bool json{};  ///< the result is printed as one document
};

using ArmOptions = Printed<RecordingOptions>;

/// Progress and notices on stderr, of a command that writes no file: a signal ends its process at once.
Watch readingWatch();
/// As `readingWatch`; signals that end the process otherwise stop the function, as long as it is kept.
Watch consoleWatch();

/// Options but the joint: the recording itself, then how it is read.
void addRecording(Command& command, RecordingOptions& options);
void addReadingOptions(Command& command, RecordingOptions& options, bool& json);

/// `--arm` alone.
void addArmOption(Command& command, RecordingOptions& options);

/// `--joint` or `--arm`, and what goes with them.
void addJointOptions(Command& command, RecordingOptions& options, bool& json);

/// The same, and the recording.
void addArmOptions(Command& command, RecordingOptions& options, bool& json);
}  // namespace hjt
