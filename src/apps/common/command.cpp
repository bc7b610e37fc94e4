// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/command.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <utility>

#include "apps/common/command_node.hpp"
#include "output/exit_code.hpp"

#include "base/joined.hpp"
#include "base/number_text.hpp"

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

using Check = std::function<std::string(const std::string&)>;

/// Numbers for which `holds`, else "'TEXT' WRONG".
Check bound(const std::function<bool(double)>& holds, const std::string& wrong)
{
  return [=](const std::string& text)
  {
    const auto number = decimalNumber(text);
    return number && holds(*number) ? std::string() : "'" + text + "' " + wrong;
  };
}

const Check FINITE = bound([](double number) { return std::isfinite(number); }, "is not a finite number");

/// The file's name ends in one of these.
std::string wrongEnding(const std::string& path, const std::vector<std::string>& endings)
{
  const std::string ending = std::filesystem::path(path).extension().string();
  const bool good = std::find(endings.begin(), endings.end(), ending) != endings.end();
  return good ? "" : "'" + path + "' must end in " + joined(endings, " or ");
}

template <class Integer>
std::optional<Integer> wholeNumber(const std::string& text)
{
  Integer number{};
  const char* end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && next == end ? std::optional(number) : std::nullopt;
}

DeclaredOption& declare(CommandNode& node, const std::string& name, const std::string& help, const char* type,
                        std::function<void(const std::string&)> take)
{
  DeclaredOption option{ name, help, name.front() == '-' ? "Options" : "Positionals" };
  option.type = type;
  option.least = 1;
  option.most = 1;
  option.take = std::move(take);
  return node.options.emplace_back(std::move(option));
}

template <class Integer>
CommandOption declareInteger(CommandNode& node, const char* name, const char* type, Integer& field,
                             const std::string& help)
{
  DeclaredOption& option =
      declare(node, name, help, type, [&](const std::string& text) { field = wholeNumber<Integer>(text).value(); });
  option.default_text = std::to_string(field);
  return CommandOption(option).check(
      [](const std::string& text)
      {
        using Limits = std::numeric_limits<Integer>;
        return wholeNumber<Integer>(text) ? "" :
                                            "'" + text + "' is not a whole number within " +
                                                std::to_string(Limits::min()) + " ... " + std::to_string(Limits::max());
      });
}

void addHelp(CommandNode& node)
{
  node.options.push_back({ "--help", "Print this help message and exit", "Options", "-h" });
}
}  // namespace

const CommandOption& CommandOption::required() const
{
  option_.required = true;
  option_.default_text.clear();
  return *this;
}

const CommandOption& CommandOption::type(const char* name) const
{
  option_.type = name;
  return *this;
}

const CommandOption& CommandOption::follow() const
{
  option_.follow = true;
  return *this;
}

const CommandOption& CommandOption::group(const char* name) const
{
  option_.group = name;
  return *this;
}

const CommandOption& CommandOption::range(double lowest, double highest) const
{
  return check(bound([=](double number) { return number >= lowest && number <= highest; },
                     "is not within " + roundedText(lowest, 7) + " ... " + roundedText(highest, 7)));
}

const CommandOption& CommandOption::atLeast(double lowest) const
{
  return check(bound([=](double number) { return number >= lowest; }, "is less than " + roundedText(lowest, 7)));
}

const CommandOption& CommandOption::positive() const
{
  return check(bound([](double number) { return number > 0.0; }, "is not more than 0"));
}

const CommandOption& CommandOption::choice(const std::vector<std::string>& names) const
{
  const std::string all = "{" + joined(names, ",") + "}";
  option_.allowed = ":" + all;
  return check(
      [=](const std::string& text)
      {
        const bool good = std::find(names.begin(), names.end(), text) != names.end();
        return good ? "" : text + " not in " + all;
      });
}

const CommandOption& CommandOption::pair() const
{
  option_.least = 2;
  option_.most = 2;
  return *this;
}

const CommandOption& CommandOption::bag() const
{
  return check([](const std::string& path) { return wrongEnding(path, { ".bag" }); });
}

const CommandOption& CommandOption::bagOrCsv() const
{
  return check([](const std::string& path) { return wrongEnding(path, { ".bag", ".csv" }); });
}

const CommandOption& CommandOption::existingFile() const
{
  option_.allowed = ":FILE";
  return check(
      [](const std::string& path) -> std::string
      {
        std::error_code error;
        if (!std::filesystem::exists(path, error))
        {
          return "File does not exist: " + path;
        }
        return std::filesystem::is_directory(path, error) ? "File is actually a directory: " + path : "";
      });
}

const CommandOption& CommandOption::existingDirectory() const
{
  option_.allowed = ":DIR";
  return check(
      [](const std::string& path) -> std::string
      {
        std::error_code error;
        if (!std::filesystem::exists(path, error))
        {
          return "Directory does not exist: " + path;
        }
        return std::filesystem::is_directory(path, error) ? "" : "Directory is actually a file: " + path;
      });
}

const CommandOption& CommandOption::needs(const char* option) const
{
  option_.needed.emplace_back(option);
  return *this;
}

const CommandOption& CommandOption::check(const std::function<std::string(const std::string&)>& check) const
{
  option_.checks.push_back(check);
  return *this;
}

CommandOption Command::add(const char* name, double& field, const std::string& help)
{
  DeclaredOption& option =
      declare(node_, name, help, "FLOAT", [&](const std::string& text) { field = decimalNumber(text).value(); });
  option.default_text = roundedText(field, 6);
  return CommandOption(option).check(FINITE);
}

CommandOption Command::add(const char* name, int& field, const std::string& help)
{
  return declareInteger(node_, name, "INT", field, help);
}

CommandOption Command::add(const char* name, unsigned& field, const std::string& help)
{
  return declareInteger(node_, name, "UINT", field, help);
}

CommandOption Command::add(const char* name, std::string& field, const std::string& help)
{
  DeclaredOption& option = declare(node_, name, help, "TEXT", [&](const std::string& text) { field = text; });
  option.default_text = field;
  return CommandOption(option);
}

CommandOption Command::add(const char* name, std::optional<double>& field, const std::string& help)
{
  const auto take = [&](const std::string& text) { field = decimalNumber(text).value(); };
  return CommandOption(declare(node_, name, help, "FLOAT", take)).check(FINITE);
}

CommandOption Command::add(const char* name, std::optional<std::string>& field, const std::string& help)
{
  return CommandOption(declare(node_, name, help, "TEXT", [&](const std::string& text) { field = text; }));
}

CommandOption Command::add(const char* name, std::vector<double>& field, const std::string& help)
{
  DeclaredOption& option = declare(node_, name, help, "FLOAT",
                                   [&](const std::string& text) { field.push_back(decimalNumber(text).value()); });
  option.most = DeclaredOption::ANY;
  option.commas = true;
  return CommandOption(option).check(FINITE);
}

CommandOption Command::add(const char* name, std::vector<std::string>& field, const std::string& help)
{
  DeclaredOption& option = declare(node_, name, help, "TEXT", [&](const std::string& text) { field.push_back(text); });
  option.most = DeclaredOption::ANY;
  return CommandOption(option);
}

CommandOption Command::flag(const char* name, bool& field, const std::string& help)
{
  DeclaredOption option{ name, help, "Options" };
  option.flag = &field;
  return CommandOption(node_.options.emplace_back(std::move(option)));
}

void Command::oneOf(const std::vector<const char*>& options)
{
  node_.alternatives.emplace_back(options.begin(), options.end());
  for (DeclaredOption& option : node_.options)
  {
    if (std::find(options.begin(), options.end(), option.name) != options.end())
    {
      option.group = "Exactly one of these is required";
    }
  }
}

Subcommand::Subcommand(Subject subject, const char* name, const char* help, std::function<Run(Command&)> declare)
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
  root_->options.push_back({ "--version", "Display program version information and exit", "Options" });
}

CommandLine::~CommandLine() = default;

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
      Command command(node);
      node.run = subcommand->declare_(command);
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
