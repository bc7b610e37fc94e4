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
  std::string out;            ///< overlay to write; for an arm, a directory of overlays; empty: no file
  std::optional<Span> train;  ///< part to identify from; none: the first third, or the whole recording of an arm
  std::optional<Span> judge;  ///< part to test on; none: the last two thirds, or the whole recording of an arm
  int folds{};  ///< number of pieces, 2 to 100, each predicted by a fit to the others; 0: none, or 5 for an arm
};

void addOptions(OptionTable& table, IdentifyOptions& options);

/// Identified parameters of a joint, and the parts of the recording that they are identified from and tested on.
struct IdentifiedJoint
{
  std::string name;  ///< short name of the joint
  Span train;
  Span judge;
  Identification found;
  JudgedErrors left_out;  ///< errors on the pieces, each predicted by a fit to the other pieces; empty without pieces
  std::string refusal;    ///< why the joint keeps its configured parameters; empty if it was identified
};

struct Identified
{
  bool is_arm{};
  std::string load;  ///< load of an arm's joints: LOAD_OF_ARM or LOAD_RECORDED
  MotionFindings found;
  std::vector<IdentifiedJoint> joints;       ///< joints from the base on; none if the program was stopped
  std::optional<IdentifiedPayload> payload;  ///< payload that the currents show; none for a single joint
  bool any{};                                ///< whether at least one parameter of a joint was identified
};

/// Identifies gain, friction, inertia and ripple of a joint, or of all joints of an arm, from a recording. Writes
/// overlays if options.out is set. @throws ParameterError, InputError if a file cannot be read or written, or if a
/// single joint hardly moves.
Identified identify(const IdentifyOptions& options);

/// Report of an identification. `errors`: lines on the errors, printed as a separate block. `refused`: one line for
/// each value that is not identifiable.
struct IdentifyReport
{
  Report values;
  std::vector<ReportLine> errors;
  std::vector<std::string> refused;

  Report whole() const;
};

IdentifyReport reportOf(const Identified& identified);
}  // namespace hjt
