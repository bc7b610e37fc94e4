// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <climits>
#include <string>
#include <vector>

#include <boost/make_shared.hpp>
#include <boost/program_options.hpp>

#include "apps/common/command_node.hpp"

#include "base/edit_distance.hpp"
#include "base/joined.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
namespace po = boost::program_options;

using Words = std::vector<std::string>;

[[noreturn]] void refuse(const std::string& reason)
{
  throw UsageError(reason + "\nRun with --help for more information.");
}

/// Arguments have no names on the command line.
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

/// Words that may be the values behind an option's name: at most so many.
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

/// Options with their values as Boost tells them apart. Whole names only; negative numbers are values.
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
      refuse(name + " takes no value");
    }
    refuseMissing(*option);
  }
}

/// Gives options and arguments their values. @returns the words that belong to none.
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
    const bool follow = found.original_tokens.size() > 1;  // behind the name, else behind an equals sign
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
}  // namespace

Request parseWords(CommandNode& command, const Words& words)
{
  // The options of a command that has subcommands take no values.
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
}  // namespace hjt
