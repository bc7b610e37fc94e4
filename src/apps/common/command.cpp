// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/command.hpp"

#include <algorithm>
#include <array>
#include <climits>
#include <iomanip>
#include <iostream>
#include <list>
#include <stdexcept>
#include <utility>
#include <vector>

#include <boost/make_shared.hpp>
#include <boost/program_options.hpp>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "output/process_end.hpp"

namespace hjt
{
struct CommandNode
{
  std::string name;  ///< full name, which begins with the names of all parent commands: "joint_twin life age"
  std::string help;
  std::string heading{};  ///< heading under which the help of the parent command lists this command
  std::string version{};
  OptionTable table{};
  std::list<CommandNode> subcommands{};
  std::function<int()> run{};
};

namespace
{
struct UsageError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

struct Request
{
  const CommandNode* command;
  std::string text;  ///< text that is printed instead of running the command: help or version
};

constexpr int FIRST_COLUMN = 30;  // width of the help's first column [characters]

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

/// Prints the help on arguments, then on groups of options, ordered by the first option of each group.
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

namespace po = boost::program_options;

using Words = std::vector<std::string>;

[[noreturn]] void refuse(const std::string& reason)
{
  throw UsageError(reason + "\nRun with --help for more information.");
}

/// Finds an option by its name. Returns null for an unknown name and for an argument, because arguments have no names
/// on the command line.
Option* findOption(CommandNode& command, const std::string& name)
{
  Option* option = command.table.find(name);
  return option == nullptr || option->isArgument() ? nullptr : option;
}

Option* nextArgument(CommandNode& command)
{
  const auto found =
      std::find_if(command.table.options.begin(), command.table.options.end(),
                   [](const Option& option) { return option.isArgument() && option.values.size() < option.most; });
  return found == command.table.options.end() ? nullptr : &*found;
}

bool isGiven(CommandNode& command, const std::string& name)
{
  const Option* option = findOption(command, name);
  return option != nullptr && option->given;
}

void addValues(Option& option, const std::string& text)
{
  std::size_t begin = 0;
  for (std::size_t comma = text.find(','); option.commas && comma != std::string::npos; comma = text.find(',', begin))
  {
    option.values.push_back(text.substr(begin, comma - begin));
    begin = comma + 1;
  }
  option.values.push_back(text.substr(begin));
}

[[noreturn]] void refuseMissing(const Option& option)
{
  refuse(option.name + ": " + std::to_string(option.least) + " required " + option.value_type + option.allowed +
         " missing");
}

/// Description for Boost of an option with up to `most` values after its name.
class Values : public po::typed_value<Words>
{
public:
  explicit Values(std::size_t most)
    : typed_value(nullptr), most_(static_cast<unsigned>(std::min<std::size_t>(most, INT_MAX)))
  {
  }

  unsigned max_tokens() const override { return most_; }

private:
  const unsigned most_;
};

const po::value_semantic* valuesOf(const Option& option)
{
  if (option.most == 0)
  {
    return po::bool_switch();
  }
  return new Values(option.commas || option.follows ? option.most : 1);
}

/// Splits the words of a command line by Boost into options with values. An abbreviated name of an option is an error,
/// and a negative number is a value.
std::vector<po::option> split(CommandNode& command, const Words& words)
{
  po::options_description known;
  for (const Option& option : command.table.options)
  {
    if (!option.isArgument())
    {
      known.add(boost::make_shared<po::option_description>(option.name.substr(2).c_str(), valuesOf(option), ""));
    }
  }
  namespace style = po::command_line_style;
  try
  {
    return po::command_line_parser(words)
        .options(known)
        .style(style::allow_long | style::long_allow_next | style::long_allow_adjacent)
        .allow_unregistered()
        .run()
        .options;
  }
  catch (const po::error_with_option_name& error)
  {
    const std::string name = error.get_option_name();
    const Option* option = findOption(command, name);
    if (option == nullptr)
    {
      refuse(error.what());
    }
    if (option->most == 0)
    {
      refuse(name + " does not take a value");
    }
    refuseMissing(*option);
  }
}

/// Gives each option of the command its values from `words`. @returns the words that belong to no option.
Words distribute(CommandNode& command, Words words)
{
  std::replace(words.begin(), std::find(words.begin(), words.end(), "--"), std::string("-h"), std::string("--help"));
  Words unexpected;
  const auto give = [&unexpected](Option* option, const std::string& value)
  {
    if (option == nullptr)
    {
      unexpected.push_back(value);
      return;
    }
    option->given = true;
    addValues(*option, value);
  };
  for (const po::option& found : split(command, words))
  {
    Option* option = findOption(command, "--" + found.string_key);
    if (option == nullptr)
    {
      const bool is_argument = found.position_key >= 0;
      for (const std::string& word : found.original_tokens)
      {
        give(is_argument ? nextArgument(command) : nullptr, word);
      }
      continue;
    }
    option->given = true;
    const std::size_t before = option->values.size();
    const bool follow = found.original_tokens.size() > 1;  // the value is a separate word, not joined by '='
    for (const std::string& value : found.value)
    {
      if (follow && findOption(command, value) != nullptr)
      {
        refuseMissing(*option);
      }
      give(option->values.size() - before < option->most ? option : nextArgument(command), value);
    }
  }
  return unexpected;
}

CommandNode& subcommand(CommandNode& command, const std::string& given)
{
  Words names;
  for (CommandNode& candidate : command.subcommands)
  {
    const std::string name = candidate.name.substr(command.name.size() + 1);
    if (name == given)
    {
      return candidate;
    }
    names.push_back(name);
  }
  const std::string nearest = nearestName(given, names);
  const std::string program = command.name.substr(0, command.name.find(' '));
  throw UsageError(program + ": unknown subcommand '" + given + "'" +
                   (nearest.empty() ? ";" : ", did you mean " + nearest + "?") + " `" + command.name +
                   " --help` lists all");
}

/// Parses the words after the program's name into the fields of the chosen command. @throws UsageError.
Request parseWords(CommandNode& command, const Words& words)
{
  // Options of a command with subcommands have no values, so the first word without a dash is a subcommand.
  const auto end = std::find_if(words.begin(), words.end(),
                                [&](const std::string& word)
                                { return !command.subcommands.empty() && (word.empty() || word[0] != '-'); });
  const Words unexpected = distribute(command, Words(words.begin(), end));
  if (isGiven(command, "--help"))
  {
    return { &command, helpText(command) };
  }
  if (isGiven(command, "--version"))
  {
    return { &command, command.version + "\n" };
  }
  try
  {
    command.table.take();
  }
  catch (const InputError& error)
  {
    refuse(error.what());
  }
  if (!unexpected.empty())
  {
    refuse((unexpected.size() > 1 ? "The following arguments were not expected: " :
                                    "The following argument was not expected: ") +
           joined(unexpected, " "));
  }
  if (command.subcommands.empty())
  {
    return { &command, "" };
  }
  if (end == words.end())
  {
    refuse("A subcommand is required");
  }
  return parseWords(subcommand(command, *end), Words(end + 1, words.end()));
}

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
    // The names are sorted: "life" comes before "life age", so the parent command exists.
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
