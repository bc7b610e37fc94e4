// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <list>
#include <stdexcept>
#include <string>
#include <vector>

namespace hjt
{
/// An option or argument as it is declared, and what the command line gives for it.
struct DeclaredOption
{
  static constexpr std::size_t ANY = std::numeric_limits<std::size_t>::max();

  std::string name;  ///< begins with dashes, else it is an argument
  std::string help;
  std::string group;
  std::string short_name{};
  std::string type{};          ///< of a value, in the help
  std::string allowed{};       ///< in the help behind the type
  std::string default_text{};  ///< in the help
  std::size_t least{};         ///< number of values, if it is given
  std::size_t most{};          ///< zero: it is a flag
  bool commas{};               ///< separate values; then those of one name may also follow each other
  bool follow{};               ///< values of one name may follow each other
  bool required{};
  std::vector<std::string> needed{};                                     ///< options to give with it
  std::vector<std::function<std::string(const std::string&)>> checks{};  ///< each says what is wrong with a value
  std::function<void(const std::string&)> take{};                        ///< puts a value into its field
  bool* flag{};                                                          ///< field of a flag, if it has one

  bool given{};
  std::vector<std::string> values{};

  bool isArgument() const { return name.front() != '-'; }
};

/// A command as it is declared.
struct CommandNode
{
  std::string name;  ///< behind those of the commands that it belongs to: "joint_twin life age"
  std::string help;
  std::string heading{};  ///< where the command that it belongs to lists it
  std::string version{};
  std::list<DeclaredOption> options{};
  std::vector<std::vector<std::string>> alternatives{};  ///< one option of each group must be given
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

/// Type and limits of an option's value.
inline std::string typeText(const DeclaredOption& option)
{
  return option.type + option.allowed;
}
}  // namespace hjt
