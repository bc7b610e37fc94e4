// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <list>
#include <stdexcept>
#include <string>
#include <vector>

#include "twin/option_table.hpp"

namespace hjt
{
/// A command as it is declared.
struct CommandNode
{
  std::string name;  ///< behind those of the commands that it belongs to: "joint_twin life age"
  std::string help;
  std::string heading{};  ///< where the command that it belongs to lists it
  std::string version{};
  OptionTable table{};
  std::list<CommandNode> subcommands{};
  std::function<int()> run{};
};

/// Wrong usage; the text is what the user reads.
struct UsageError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// Request of a command line.
struct Request
{
  const CommandNode* command;
  std::string text;  ///< to print instead of running the command: help or version
};

/// Fills the fields of the command that the words behind the program's name choose. @throws UsageError.
Request parseWords(CommandNode& command, const std::vector<std::string>& words);

std::string helpText(const CommandNode& command);
}  // namespace hjt
