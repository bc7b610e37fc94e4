// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "twin/options.hpp"

namespace hjt
{
struct CommandNode;

/// Groups of subcommands, in the order in which the help lists them.
enum class Subject
{
  GEAR,
  STUDY,
  JOINT,
  RECORDING,
  DATA_SET
};

/// A subcommand of the tool. A static object of this type, at the end of the subcommand's file, adds it to the tool.
/// "life age" is the subcommand `age` of the subcommand `life`.
class Subcommand
{
public:
  using Run = std::function<int()>;  ///< returns the exit code

  /// Declares a subcommand that has subcommands of its own.
  Subcommand(Subject subject, const char* name, const char* help)
    : Subcommand(subject, name, help, std::function<Run(OptionTable&)>())
  {
  }

  template <class Options>
  Subcommand(Subject subject, const char* name, const char* help, void (*declare)(OptionTable&, Options&),
             int (*run)(const Options&))
    : Subcommand(subject, name, help,
                 [declare, run](OptionTable& table)
                 {
                   const auto options = std::make_shared<Options>();
                   declare(table, *options);
                   return [options, run] { return run(*options); };
                 })
  {
  }

private:
  friend class CommandLine;
  Subcommand(Subject subject, const char* name, const char* help, std::function<Run(OptionTable&)> declare);

  const Subject subject_;
  const std::string name_;
  const std::string help_;
  const std::function<Run(OptionTable&)> declare_;  // empty if the subcommand has subcommands
};

class CommandLine
{
public:
  CommandLine(const char* name, const char* help);
  ~CommandLine();

  OptionTable& root();
  void addSubcommands();

  /// Whether the command line names a subcommand of this program, or only prints the version.
  static bool knows(int argc, char** argv);

  /// Parses the command line. @returns the exit code if only help, the version or an error was printed; else nothing.
  std::optional<int> parse(int argc, char** argv);

  int run() const { return run_(); }

private:
  std::unique_ptr<CommandNode> root_;
  Subcommand::Run run_;
};
}  // namespace hjt
