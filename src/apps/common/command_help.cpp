// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iomanip>
#include <string>
#include <vector>

#include "apps/common/command_node.hpp"

#include "base/text_stream.hpp"

namespace hjt
{
namespace
{
constexpr int FIRST_COLUMN = 30;  // its width

void printRow(std::ostream& text, const std::string& label, const std::string& help)
{
  const std::string first = "  " + label;
  text << std::setw(FIRST_COLUMN) << std::left << first;
  if (first.size() >= FIRST_COLUMN)
  {
    text << '\n' << std::setw(FIRST_COLUMN) << "";
  }
  text << help << '\n';
}

std::string label(const Option& option)
{
  std::string text = std::string(option.name == "--help" ? "-h," : "") + option.name;
  if (option.most > 0)
  {
    text += " " + option.value_type + option.allowed + (option.default_text.empty() ? "" : "=" + option.default_text);
    if (option.most == Option::ANY)
    {
      text += " ...";
    }
    else if (option.least > 1)
    {
      text += " x " + std::to_string(option.least);
    }
    text += option.is_required ? " REQUIRED" : "";
  }
  text += option.needed.empty() ? "" : " Needs:";
  for (const std::string& needed : option.needed)
  {
    text += " " + needed;
  }
  return text;
}

void printUsage(std::ostream& text, const CommandNode& command)
{
  text << "Usage: " << command.name << " [OPTIONS]";
  for (const Option& option : command.table.options)
  {
    if (option.isArgument())
    {
      const std::string name = option.name + (option.most == Option::ANY ? "..." : "");
      text << ' ' << (option.is_required ? name : "[" + name + "]");
    }
  }
  text << (command.subcommands.empty() ? "\n" : " SUBCOMMAND\n");
}

/// Arguments, then the groups of options in the order of their first ones.
void printOptions(std::ostream& text, const CommandNode& command)
{
  std::vector<std::string> groups;
  for (const bool arguments : { true, false })
  {
    for (const Option& option : command.table.options)
    {
      if (option.isArgument() == arguments && std::find(groups.begin(), groups.end(), option.heading) == groups.end())
      {
        groups.push_back(option.heading);
      }
    }
  }
  for (const std::string& group : groups)
  {
    text << '\n' << group << ":\n";
    for (const Option& option : command.table.options)
    {
      if (option.heading == group)
      {
        printRow(text, label(option), option.help);
      }
    }
  }
}

void printSubcommands(std::ostream& text, const CommandNode& command)
{
  std::string heading;
  for (const CommandNode& subcommand : command.subcommands)
  {
    if (subcommand.heading != heading)
    {
      heading = subcommand.heading;
      text << '\n' << heading << ":\n";
    }
    printRow(text, subcommand.name.substr(command.name.size() + 1), subcommand.help);
  }
}
}  // namespace

std::string helpText(const CommandNode& command)
{
  TextStream text;
  text << command.help << (command.help.empty() ? "" : "\n");
  printUsage(text, command);
  printOptions(text, command);
  printSubcommands(text, command);
  text << '\n';
  return text.str();
}
}  // namespace hjt
