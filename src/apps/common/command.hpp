// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace hjt
{
struct CommandNode;
struct DeclaredOption;

/// One option or argument of a command; each call adds a rule. What a rule refuses is a wrong usage.
class CommandOption
{
public:
  explicit CommandOption(DeclaredOption& option) : option_(option) {}

  const CommandOption& required() const;
  const CommandOption& type(const char* name) const;  ///< of the value, in the help
  const CommandOption& group(const char* name) const;
  const CommandOption& range(double lowest, double highest) const;
  const CommandOption& atLeast(double lowest) const;
  const CommandOption& positive() const;
  const CommandOption& choice(const std::vector<std::string>& names) const;
  const CommandOption& pair() const;  ///< of a list: two values
  const CommandOption& bag() const;   ///< the file's name ends in .bag
  const CommandOption& bagOrCsv() const;
  const CommandOption& existingFile() const;
  const CommandOption& existingDirectory() const;
  const CommandOption& needs(const char* option) const;
  const CommandOption& follow() const;  ///< of a list: values may follow each other behind one name
  /// `check` gives what is wrong with the text, or nothing.
  const CommandOption& check(const std::function<std::string(const std::string&)>& check) const;

private:
  DeclaredOption& option_;
};

/// A command while its options are declared. Names with dashes are options, else arguments. Numbers must be finite;
/// what a field holds at the declaration is the default, shown in the help.
class Command
{
public:
  explicit Command(CommandNode& node) : node_(node) {}

  CommandOption add(const char* name, double& field, const std::string& help);
  CommandOption add(const char* name, int& field, const std::string& help);
  CommandOption add(const char* name, unsigned& field, const std::string& help);
  CommandOption add(const char* name, std::string& field, const std::string& help);
  CommandOption add(const char* name, std::optional<double>& field, const std::string& help);
  CommandOption add(const char* name, std::optional<std::string>& field, const std::string& help);
  CommandOption add(const char* name, std::vector<double>& field, const std::string& help);  ///< separated by commas
  CommandOption add(const char* name, std::vector<std::string>& field, const std::string& help);  ///< once or more
  CommandOption flag(const char* name, bool& field, const std::string& help);

  /// One of these options must be given.
  void oneOf(const std::vector<const char*>& options);

private:
  CommandNode& node_;
};

/// Groups of subcommands, in the order of the help.
enum class Subject
{
  GEAR,
  STUDY,
  JOINT,
  RECORDING,
  DATA_SET
};

/// A subcommand of the tool. A static object of this type, at the end of the file that has its code, is all it takes to
/// add one. "life age" is the subcommand `age` of the subcommand `life`.
class Subcommand
{
public:
  using Run = std::function<int()>;  ///< gives the exit code

  /// A subcommand with subcommands of its own.
  Subcommand(Subject subject, const char* name, const char* help)
    : Subcommand(subject, name, help, std::function<Run(Command&)>())
  {
  }

  template <class Options>
  Subcommand(Subject subject, const char* name, const char* help, void (*declare)(Command&, Options&),
             int (*run)(const Options&))
    : Subcommand(subject, name, help,
                 [declare, run](Command& command)
                 {
                   const auto options = std::make_shared<Options>();
                   declare(command, *options);
                   return [options, run] { return run(*options); };
                 })
  {
  }

private:
  friend class CommandLine;
  Subcommand(Subject subject, const char* name, const char* help, std::function<Run(Command&)> declare);

  const Subject subject_;
  const std::string name_;
  const std::string help_;
  const std::function<Run(Command&)> declare_;  // empty: has subcommands
};

/// The command line of a program.
class CommandLine
{
public:
  CommandLine(const char* name, const char* help);
  ~CommandLine();

  Command root() { return Command(*root_); }
  void addSubcommands();

  /// The subcommand given is one of this program, or only the version is asked for.
  static bool knows(int argc, char** argv);

  /// Fills the fields. @returns the exit code if the process ends here: help, version or wrong usage, which are
  /// printed.
  std::optional<int> parse(int argc, char** argv);

  /// Runs the subcommand that was chosen. @returns its exit code.
  int run() const { return run_(); }

private:
  std::unique_ptr<CommandNode> root_;
  Subcommand::Run run_;
};
}  // namespace hjt
