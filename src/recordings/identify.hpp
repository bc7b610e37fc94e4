// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "output/report.hpp"
#include "recordings/recording_options.hpp"

#include "arm/load_fit.hpp"
#include "identification/identification.hpp"

namespace hjt
{
struct IdentifyOptions : RecordingOptions
{
  std::string out;            ///< overlay to write, for an arm a directory; empty: none
  std::optional<Span> train;  ///< part to identify on; none: the first third, for an arm all
  std::optional<Span> judge;  ///< part to test on; none: the rest, for an arm all
  int folds{};                ///< number of pieces that are predicted from the others, 2 to 100; 0: none, for an arm 5
};

void addOptions(OptionTable& table, IdentifyOptions& options);

/// Identified parameters of a joint, and the parts of the recording for training and judging.
struct IdentifiedJoint
{
  std::string name;  ///< short name
  Span train;
  Span judge;
  Identification found;
  JudgedErrors left_out;  ///< errors on pieces left out; empty without folds
  std::string refusal;    ///< why the joint stays as configured; empty if it was identified
};

struct Identified
{
  bool is_arm{};
  std::string load;  ///< load of an arm's joints: LOAD_OF_ARM or LOAD_RECORDED
  MotionFindings found;
  std::vector<IdentifiedJoint> joints;       ///< joints from the base on; none if stopped
  std::optional<IdentifiedPayload> payload;  ///< payload of an arm
  bool any{};                                ///< whether something was identified
};

/// Identifies gain, friction, inertia and ripple of a joint, or of all joints of an arm, from a recording. Writes
/// overlays if the options name a file.
/// @throws ParameterError, InputError if a file cannot be read or written, or a single joint hardly moves.
Identified identify(const IdentifyOptions& options);

/// Report of an identification. The lines `errors` are a block of their own for people. `refused` has a line for each
/// value that is not identifiable.
struct IdentifyReport
{
  Report values;
  std::vector<ReportLine> errors;
  std::vector<std::string> refused;

  Report whole() const;
};

IdentifyReport reportOf(const Identified& identified);
}  // namespace hjt
