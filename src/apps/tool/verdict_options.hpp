// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "apps/common/motion_options.hpp"
#include "recordings/compare.hpp"

namespace hjt
{
/// Options of a function that judges.
template <class Options>
struct Judging : Printed<Options>
{
  std::string fail_on;  ///< warn or error; empty: the exit code is no verdict
};

/// `--reference` and `--fail-on`.
void addVerdictOptions(Command& command, ComparisonOptions& options, std::string& fail_on);

/// What the process answers to a verdict.
int exitCodeOf(const std::string& fail_on, HealthLevel health, bool is_judged);
}  // namespace hjt
