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
  std::string out;            ///< overlay to write, of an arm a directory; empty: none
  std::optional<Span> train;  ///< to identify on; none: the first third, of an arm all
  std::optional<Span> judge;  ///< to test on; none: the rest, of an arm all
  int folds{};                ///< pieces to predict each from the others, 2 ... 100; 0: none, of an arm 5
};

void addOptions(OptionTable& table, IdentifyOptions& options);

/// Identified parameters of a joint, and the parts of the recording for training and judging.
struct IdentifiedJoint
{
  std::string name;  ///< short
  Span train;
  Span judge;
  Identification found;
  JudgedErrors left_out;  ///< empty without folds
  std::string refusal;    ///< why the joint stays as configured; empty: it does not
};

struct Identified
{
  bool is_arm{};
  std::string load;  ///< of an arm's joints: LOAD_OF_ARM or LOAD_RECORDED
  MotionFindings found;
  std::vector<IdentifiedJoint> joints;       ///< from the base on; none: stopped
  std::optional<IdentifiedPayload> payload;  ///< of an arm
  bool any{};                                ///< something was identified
};

/// Gain, friction, inertia and ripple of a joint, or of all joints of an arm, from a recording; writes overlays if
/// asked for.
/// @throws ParameterError, InputError: unreadable, one joint that hardly moves, a file that cannot be written.
Identified identify(const IdentifyOptions& options);

/// As lines; `errors` are a block of their own for people. `refused`: what is not identifiable, a line each.
struct IdentifyReport
{
  Report values;
  std::vector<ReportLine> errors;
  std::vector<std::string> refused;

  Report whole() const;
};

IdentifyReport reportOf(const Identified& identified);
}  // namespace hjt
