// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/command.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <utility>

#include <CLI/CLI.hpp>

#include "apps/common/exit_code.hpp"
#include "apps/common/text_table.hpp"

#include "base/edit_distance.hpp"
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

template <class Field>
CommandOption addWithDefault(CLI::App& app, const char* name, Field& field, const std::string& help)
{
  return CommandOption(*app.add_option(name, field, help)->capture_default_str());
}
}  // namespace

const CommandOption& CommandOption::required() const
{
  option_.required()->default_str("");
  return *this;
}

const CommandOption& CommandOption::type(const char* name) const
{
  option_.type_name(name);
  return *this;
}

const CommandOption& CommandOption::group(const char* name) const
{
  option_.group(name);
  return *this;
}

const CommandOption& CommandOption::range(double lowest, double highest) const
{
  return check(bound([=](double number) { return number >= lowest && number <= highest; },
                     "is not within " + shortNumber(lowest) + " ... " + shortNumber(highest)));
}

const CommandOption& CommandOption::atLeast(double lowest) const
{
  return check(bound([=](double number) { return number >= lowest; }, "is less than " + shortNumber(lowest)));
}

const CommandOption& CommandOption::positive() const
{
  return check(bound([](double number) { return number > 0.0; }, "is not more than 0"));
}

const CommandOption& CommandOption::choice(const std::vector<std::string>& names) const
{
  option_.check(CLI::IsMember(names));
  return *this;
}

const CommandOption& CommandOption::pair() const
{
  option_.expected(2);
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
  option_.check(CLI::ExistingFile);
  return *this;
}

const CommandOption& CommandOption::existingDirectory() const
{
  option_.check(CLI::ExistingDirectory);
  return *this;
}

const CommandOption& CommandOption::needs(const char* option) const
{
  option_.needs(option);
  return *this;
}

const CommandOption& CommandOption::excludes(const char* option) const
{
  option_.excludes(option);
  return *this;
}

const CommandOption& CommandOption::check(const std::function<std::string(const std::string&)>& check) const
{
  option_.check(check);
  return *this;
}

CommandOption Command::add(const char* name, double& field, const std::string& help)
{
  return addWithDefault(app_, name, field, help).check(FINITE);
}

CommandOption Command::add(const char* name, int& field, const std::string& help)
{
  return addWithDefault(app_, name, field, help);
}

CommandOption Command::add(const char* name, unsigned& field, const std::string& help)
{
  return addWithDefault(app_, name, field, help);
}

CommandOption Command::add(const char* name, std::string& field, const std::string& help)
{
  return addWithDefault(app_, name, field, help);
}

CommandOption Command::add(const char* name, std::optional<double>& field, const std::string& help)
{
  return CommandOption(*app_.add_option(name, field, help)).check(FINITE);
}

CommandOption Command::add(const char* name, std::optional<std::string>& field, const std::string& help)
{
  return CommandOption(*app_.add_option(name, field, help));
}

CommandOption Command::add(const char* name, std::vector<double>& field, const std::string& help)
{
  return CommandOption(*app_.add_option(name, field, help)->delimiter(',')).check(FINITE);
}

CommandOption Command::add(const char* name, std::vector<std::string>& field, const std::string& help)
{
  CLI::Option* option = app_.add_option(name, field, help);
  return CommandOption(option->get_positional() ? *option : *option->allow_extra_args(false));
}

CommandOption Command::flag(const char* name, bool& field, const std::string& help)
{
  return CommandOption(*app_.add_flag(name, field, help));
}

void Command::oneOf(const std::vector<const char*>& options)
{
  auto* group = app_.add_option_group("drive", "one of");
  for (const char* option : options)
  {
    group->add_option(app_.get_option(option));
  }
  group->require_option(1);
}

Subcommand::Subcommand(Subject subject, const char* name, const char* help, std::function<Run(Command&)> declare)
  : subject_(subject), name_(name), help_(help), declare_(std::move(declare))
{
  subcommands().push_back(this);
}

CommandLine::CommandLine(const char* name, const char* help) : app_(std::make_unique<CLI::App>(help, name))
{
  app_->set_version_flag("--version", std::string(name) + " " HJT_VERSION);
}

CommandLine::~CommandLine() = default;

void CommandLine::addSubcommands()
{
  std::vector<const Subcommand*> all = subcommands();
  std::sort(all.begin(), all.end(),
            [](const Subcommand* a, const Subcommand* b)
            { return std::pair(a->subject_, a->name_) < std::pair(b->subject_, b->name_); });
  app_->require_subcommand(1);
  for (const Subcommand* subcommand : all)
  {
    const std::size_t space = subcommand->name_.find(' ');
    const bool inner = space != std::string::npos;
    CLI::App* parent = inner ? app_->get_subcommand(subcommand->name_.substr(0, space)) : app_.get();
    CLI::App* app = parent->add_subcommand(subcommand->name_.substr(inner ? space + 1 : 0), subcommand->help_);
    if (!inner)
    {
      app->group(HEADINGS[static_cast<std::size_t>(subcommand->subject_)]);
    }
    if (!subcommand->declare_)
    {
      app->require_subcommand(1);
      continue;
    }
    Command command(*app);
    app->callback([this, run = subcommand->declare_(command)] { run_ = run; });
  }
}

bool CommandLine::knows(int argc, char** argv)
{
  const std::string first = argc > 1 ? argv[1] : "";
  const std::vector<const Subcommand*>& all = subcommands();
  return first == "--version" ||
         std::any_of(all.begin(), all.end(), [&](const Subcommand* each) { return each->name_ == first; });
}

std::string CommandLine::unknownSubcommand(int argc, char** argv) const
{
  const CLI::App* app = app_.get();
  for (int i = 1; i < argc && app->get_require_subcommand_min() > 0 && argv[i][0] != '-'; ++i)
  {
    const std::string given = argv[i];
    const auto known = app->get_subcommands([](const CLI::App*) { return true; });
    std::string nearest;
    std::size_t distance = std::max<std::size_t>(2, given.size() / 3) + 1;
    for (const CLI::App* candidate : known)
    {
      if (candidate->get_name() == given)
      {
        app = candidate;
        nearest.clear();
        distance = 0;
      }
      else if (const std::size_t edits = editDistance(given, candidate->get_name()); edits < distance)
      {
        nearest = candidate->get_name();
        distance = edits;
      }
    }
    if (distance > 0)
    {
      return "unknown subcommand '" + given + "'" + (nearest.empty() ? "" : ", did you mean " + nearest + "?") + " `" +
             app_->get_name() + " --help` lists all";
    }
  }
  return {};
}

std::optional<int> CommandLine::parse(int argc, char** argv, bool aloud)
{
  if (const std::string unknown = unknownSubcommand(argc, argv); !unknown.empty())
  {
    std::cerr << app_->get_name() << ": " << unknown << '\n';
    return EXIT_USAGE;
  }
  try
  {
    app_->parse(argc, argv);
    return std::nullopt;
  }
  catch (const CLI::ParseError& error)
  {
    return (aloud ? app_->exit(error) : error.get_exit_code()) == 0 ? EXIT_DONE : EXIT_USAGE;
  }
}
}  // namespace hjt
