// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/command.hpp"

#include <algorithm>
#include <array>
#include <iostream>
#include <utility>

#include "apps/common/command_node.hpp"
#include "output/exit_code.hpp"

namespace hjt
{
namespace
{
constexpr std::array<const char*, 5> HEADINGS{ "The gear", "Studies of the model", "The joint", "Recordings",
                                               "Data sets and settings" };

std::vector<const Subcommand*>& subcommands()
{
  static std::vector<const Subcommand*> all;
  return all;
}

void addHelp(CommandNode& node)
{
  node.table.options.push_back({ "--help", "Print this help message and exit", "Options" });
}
}  // namespace

Subcommand::Subcommand(Subject subject, const char* name, const char* help, std::function<Run(OptionTable&)> declare)
  : subject_(subject), name_(name), help_(help), declare_(std::move(declare))
{
  subcommands().push_back(this);
}

CommandLine::CommandLine(const char* name, const char* help) : root_(std::make_unique<CommandNode>())
{
  root_->name = name;
  root_->help = help;
  root_->version = std::string(name) + " " HJT_VERSION;
  addHelp(*root_);
  root_->table.options.push_back({ "--version", "Display program version information and exit", "Options" });
}

CommandLine::~CommandLine() = default;

OptionTable& CommandLine::root()
{
  return root_->table;
}

void CommandLine::addSubcommands()
{
  std::vector<const Subcommand*> all = subcommands();
  std::sort(all.begin(), all.end(),
            [](const Subcommand* a, const Subcommand* b)
            { return std::pair(a->subject_, a->name_) < std::pair(b->subject_, b->name_); });
  for (const Subcommand* subcommand : all)
  {
    // "life age" comes after "life".
    const bool inner = subcommand->name_.find(' ') != std::string::npos;
    CommandNode& parent = inner ? root_->subcommands.back() : *root_;
    CommandNode& node = parent.subcommands.emplace_back();
    node.name = root_->name + " " + subcommand->name_;
    node.help = subcommand->help_;
    node.heading = HEADINGS[static_cast<std::size_t>(subcommand->subject_)];
    addHelp(node);
    if (subcommand->declare_)
    {
      node.run = subcommand->declare_(node.table);
    }
  }
}

bool CommandLine::knows(int argc, char** argv)
{
  const std::string first = argc > 1 ? argv[1] : "";
  const std::vector<const Subcommand*>& all = subcommands();
  return first == "--version" ||
         std::any_of(all.begin(), all.end(), [&](const Subcommand* each) { return each->name_ == first; });
}

std::optional<int> CommandLine::parse(int argc, char** argv)
{
  try
  {
    const Request request = parseWords(*root_, { argv + 1, argv + argc });
    if (request.text.empty())
    {
      run_ = request.command->run;
      return std::nullopt;
    }
    std::cout << request.text;
    return EXIT_DONE;
  }
  catch (const UsageError& error)
  {
    std::cerr << error.what() << '\n';
    return EXIT_USAGE;
  }
}
}  // namespace hjt
