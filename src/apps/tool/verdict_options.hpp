// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "apps/common/motion_options.hpp"
#include "recordings/compare.hpp"

namespace hjt
{
/// Options of a function that judges.
template <class Options>
struct Judging : Printed<Options>
{
  std::string fail_on;  ///< warn, error or not-judged; empty: the exit code is no verdict
};

/// `--reference` and `--fail-on`.
void addVerdictOptions(Command& command, ComparisonOptions& options, std::string& fail_on);

/// Exit code of the process for a verdict. `not_judged`: joints that are not judged.
int exitCodeOf(const std::string& fail_on, HealthLevel health, bool is_judged, std::size_t not_judged);

/// The level, and for how many joints it does not speak.
std::string headlineOf(const std::string& level, bool is_judged, std::size_t not_judged, std::size_t joints);
}  // namespace hjt
