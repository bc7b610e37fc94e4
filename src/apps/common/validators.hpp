// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace hjt
{
/// Of the node when nothing else is said.
constexpr const char* DEFAULT_NAMESPACE = "/joint_twin";

// Checks of the command line; what they refuse is a wrong usage.
extern const CLI::Validator FINITE;
extern const CLI::Validator BAG;
extern const CLI::Validator BAG_OR_CSV;

void addNamespaceOption(CLI::App& command, std::string& joint_namespace);
}  // namespace hjt
