// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <vector>

#include "apps/common/command_node.hpp"

#include "base/edit_distance.hpp"
#include "base/joined.hpp"

namespace hjt
{
namespace
{
using Words = std::vector<std::string>;
using Word = Words::const_iterator;

[[noreturn]] void refuse(const std::string& reason)
{
  throw UsageError(reason + "\nRun with --help for more information.");
}

/// Negative numbers are values.
bool looksLikeOption(const std::string& word)
{
  return word.size() > 1 && word[0] == '-' && word[1] != '.' && (word[1] < '0' || word[1] > '9');
}

DeclaredOption* findOption(CommandNode& command, const std::string& name)
{
  const auto found = std::find_if(command.options.begin(), command.options.end(),
                                  [&](const DeclaredOption& option) {
                                    return !option.isArgument() && (option.name == name || option.short_name == name);
                                  });
  return found == command.options.end() ? nullptr : &*found;
}

DeclaredOption* nextArgument(CommandNode& command)
{
  const auto found = std::find_if(command.options.begin(), command.options.end(),
                                  [](const DeclaredOption& option)
                                  { return option.isArgument() && option.values.size() < option.most; });
  return found == command.options.end() ? nullptr : &*found;
}

bool isGiven(CommandNode& command, const std::string& name)
{
  const DeclaredOption* option = findOption(command, name);
  return option != nullptr && option->given;
}

void addValues(DeclaredOption& option, const std::string& text)
{
  std::size_t begin = 0;
  for (std::size_t comma = text.find(','); option.commas && comma != std::string::npos; comma = text.find(',', begin))
  {
    option.values.push_back(text.substr(begin, comma - begin));
    begin = comma + 1;
  }
  option.values.push_back(text.substr(begin));
}

/// Takes the values behind an option's name.
void takeValues(DeclaredOption& option, Word& word, const Word end)
{
  const std::size_t before = option.values.size();
  const std::size_t wanted = option.commas ? option.most : std::min<std::size_t>(option.most, 1);
  while (option.values.size() - before < wanted && word != end && !looksLikeOption(*word))
  {
    addValues(option, *word++);
  }
  if (wanted > 0 && option.values.size() == before)
  {
    refuse(option.name + ": " + std::to_string(option.least) + " required " + typeText(option) + " missing");
  }
}

/// Gives options and arguments their values. @returns the words that belong to none.
Words distribute(CommandNode& command, Word word, const Word end)
{
  Words unexpected;
  bool arguments_only = false;
  while (word != end)
  {
    const std::string& text = *word++;
    if (text == "--" && !arguments_only)
    {
      arguments_only = true;
      continue;
    }
    const bool is_option = !arguments_only && looksLikeOption(text);
    const std::size_t equals = is_option ? text.find('=') : std::string::npos;
    DeclaredOption* option = is_option ? findOption(command, text.substr(0, equals)) : nextArgument(command);
    if (option == nullptr)
    {
      unexpected.push_back(text);
      continue;
    }
    option->given = true;
    if (equals != std::string::npos && option->most == 0)
    {
      refuse(option->name + " takes no value");
    }
    if (is_option && equals == std::string::npos)
    {
      takeValues(*option, word, end);
    }
    else
    {
      addValues(*option, is_option ? text.substr(equals + 1) : text);
    }
  }
  return unexpected;
}

void store(const DeclaredOption& option)
{
  for (const std::string& value : option.values)
  {
    for (const auto& check : option.checks)
    {
      if (const std::string wrong = check(value); !wrong.empty())
      {
        refuse(option.name + ": " + wrong);
      }
    }
  }
  const std::size_t count = option.values.size();
  if (count < option.least || count > option.most)
  {
    refuse(option.name + ": At " +
           (count < option.least ? "least " + std::to_string(option.least) : "Most " + std::to_string(option.most)) +
           " required but received " + std::to_string(count));
  }
  for (const std::string& value : option.values)
  {
    option.take(value);
  }
  if (option.flag != nullptr)
  {
    *option.flag = true;
  }
}

void checkTogether(CommandNode& command)
{
  for (const DeclaredOption& option : command.options)
  {
    if (option.required && !option.given)
    {
      refuse(option.name + " is required");
    }
    for (const std::string& needed : option.needed)
    {
      if (option.given && !isGiven(command, needed))
      {
        refuse(option.name + " requires " + needed);
      }
    }
  }
  for (const std::vector<std::string>& names : command.alternatives)
  {
    const auto given =
        std::count_if(names.begin(), names.end(), [&](const std::string& name) { return isGiven(command, name); });
    if (given != 1)
    {
      refuse("Exactly 1 option from [" + joined(names, ",") + "] is required" +
             (given > 1 ? " and " + std::to_string(given) + " were given" : ""));
    }
  }
}

CommandNode& subcommand(CommandNode& command, const std::string& given)
{
  std::string nearest;
  std::size_t distance = std::max<std::size_t>(2, given.size() / 3) + 1;
  for (CommandNode& candidate : command.subcommands)
  {
    const std::string name = candidate.name.substr(command.name.size() + 1);
    if (name == given)
    {
      return candidate;
    }
    if (const std::size_t edits = editDistance(given, name); edits < distance)
    {
      nearest = name;
      distance = edits;
    }
  }
  const std::string program = command.name.substr(0, command.name.find(' '));
  throw UsageError(program + ": unknown subcommand '" + given + "'" +
                   (nearest.empty() ? ";" : ", did you mean " + nearest + "?") + " `" + command.name +
                   " --help` lists all");
}
}  // namespace

Request parseWords(CommandNode& command, const std::vector<std::string>& words)
{
  const Word end =
      command.subcommands.empty() ? words.end() : std::find_if_not(words.begin(), words.end(), looksLikeOption);
  const Words unexpected = distribute(command, words.begin(), end);
  if (isGiven(command, "--help"))
  {
    return { &command, helpText(command) };
  }
  if (isGiven(command, "--version"))
  {
    return { &command, command.version + "\n" };
  }
  for (const DeclaredOption& option : command.options)
  {
    if (option.given)
    {
      store(option);
    }
  }
  checkTogether(command);
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
