// SPDX-License-Identifier: BSD-3-Clause
#include "twin/options.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "params/configuration_files.hpp"

namespace hjt
{
namespace
{
/// Makes a check that a text is a number for which `holds` is true. Its error is the text in quotes, then `wrong`.
Option::Check bound(const std::function<bool(double)>& holds, const std::string& wrong)
{
  return [=](const std::string& text)
  {
    const auto number = decimalNumber(text);
    return number && holds(*number) ? std::string() : "'" + text + "' " + wrong;
  };
}

const Option::Check FINITE = bound([](double number) { return std::isfinite(number); }, "is not a finite number");

std::string wrongPlace(const std::string& path, bool is_directory)
{
  const std::string what = is_directory ? "Directory " : "File ";
  std::error_code error;
  if (!std::filesystem::exists(path, error))
  {
    return what + "does not exist: " + path;
  }
  const bool is_other = std::filesystem::is_directory(path, error) != is_directory;
  return is_other ? what + "is actually a " + (is_directory ? "file: " : "directory: ") + path : "";
}

template <class Integer>
std::optional<Integer> wholeNumber(const std::string& text)
{
  Integer number{};
  const char* end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && next == end ? std::optional(number) : std::nullopt;
}

template <class Integer>
Option& declareInteger(OptionTable& table, const char* name, const char* type, Integer& field, const std::string& help)
{
  Option& option = table.add(
      name, Option::Kind::WHOLE, [&](const std::string& text) { field = wholeNumber<Integer>(text).value(); }, help);
  option.default_text = std::to_string(field);
  return option.type(type).check(
      [](const std::string& text)
      {
        using Limits = std::numeric_limits<Integer>;
        return wholeNumber<Integer>(text) ? "" :
                                            "'" + text + "' is not a whole number within " +
                                                std::to_string(Limits::min()) + " ... " + std::to_string(Limits::max());
      });
}

void requireValues(const Option& option)
{
  const std::string shown = option.shown.empty() ? option.name : option.shown;
  for (const std::string& value : option.values)
  {
    for (const Option::Check& check : option.checks)
    {
      if (const std::string wrong = check(value); !wrong.empty())
      {
        throw InputError(shown + ": " + wrong);
      }
    }
  }
  const std::size_t count = option.values.size();
  if (count < option.least || count > option.most)
  {
    throw InputError(
        shown + ": the number of values must be at " +
        (count < option.least ? "least " + std::to_string(option.least) : "most " + std::to_string(option.most)) +
        ", but is " + std::to_string(count));
  }
}
}  // namespace

Option& Option::required()
{
  is_required = true;
  default_text.clear();
  return *this;
}

Option& Option::type(const char* text)
{
  value_type = text;
  return *this;
}

Option& Option::group(const char* text)
{
  heading = text;
  return *this;
}

Option& Option::range(double lowest, double highest)
{
  return check(bound([=](double number) { return number >= lowest && number <= highest; },
                     "is not within " + roundedText(lowest, 7) + " ... " + roundedText(highest, 7)));
}

Option& Option::positive()
{
  return check(bound([](double number) { return number > 0.0; }, "is not more than 0"));
}

Option& Option::choice(const std::vector<std::string>& names)
{
  const std::string all = "{" + joined(names, ",") + "}";
  allowed = ":" + all;
  return check(
      [=](const std::string& text)
      {
        const bool good = std::find(names.begin(), names.end(), text) != names.end();
        return good ? "" : text + " is not one of " + all;
      });
}

Option& Option::pair()
{
  least = 2;
  most = 2;
  commas = true;
  return *this;
}

Option& Option::endsIn(const std::vector<std::string>& endings)
{
  return check(
      [=](const std::string& path)
      {
        const std::string ending = std::filesystem::path(path).extension().string();
        const bool good = std::find(endings.begin(), endings.end(), ending) != endings.end();
        return good ? "" : "'" + path + "' must end in " + joined(endings, " or ");
      });
}

Option& Option::existingFile()
{
  allowed = ":FILE";
  return check([](const std::string& path) { return wrongPlace(path, false); });
}

Option& Option::existingDirectory()
{
  allowed = ":DIR";
  return check([](const std::string& path) { return wrongPlace(path, true); });
}

Option& Option::needs(const char* option)
{
  needed.emplace_back(option);
  return *this;
}

Option& Option::follow()
{
  follows = true;
  return *this;
}

Option& Option::check(const Check& wrong)
{
  checks.push_back(wrong);
  return *this;
}

Option& OptionTable::add(const std::string& name, Option::Kind kind, const Option::Take& take, const std::string& help)
{
  Option& option = options.emplace_back(Option{ name, help, name.front() == '-' ? "Options" : "Positionals", kind });
  option.least = kind == Option::Kind::FLAG ? 0 : 1;
  option.most = option.least;
  option.take = take;
  return kind == Option::Kind::NUMBER ? option.type("FLOAT").check(FINITE) : option.type("TEXT");
}

Option& OptionTable::add(const char* name, double& field, const std::string& help)
{
  Option& option = add(
      name, Option::Kind::NUMBER, [&](const std::string& text) { field = decimalNumber(text).value(); }, help);
  option.default_text = roundedText(field, 6);
  return option;
}

Option& OptionTable::add(const char* name, int& field, const std::string& help)
{
  return declareInteger(*this, name, "INT", field, help);
}

Option& OptionTable::add(const char* name, unsigned& field, const std::string& help)
{
  return declareInteger(*this, name, "UINT", field, help);
}

Option& OptionTable::add(const char* name, std::string& field, const std::string& help)
{
  Option& option = add(
      name, Option::Kind::TEXT, [&](const std::string& text) { field = text; }, help);
  option.default_text = field;
  return option;
}

Option& OptionTable::add(const char* name, std::optional<double>& field, const std::string& help)
{
  return add(
      name, Option::Kind::NUMBER, [&](const std::string& text) { field = decimalNumber(text).value(); }, help);
}

Option& OptionTable::add(const char* name, std::optional<std::string>& field, const std::string& help)
{
  return add(
      name, Option::Kind::TEXT, [&](const std::string& text) { field = text; }, help);
}

Option& OptionTable::add(const char* name, std::vector<double>& field, const std::string& help)
{
  Option& option = add(
      name, Option::Kind::NUMBER, [&](const std::string& text) { field.push_back(decimalNumber(text).value()); }, help);
  option.most = Option::ANY;
  option.commas = true;
  return option;
}

Option& OptionTable::add(const char* name, std::vector<std::string>& field, const std::string& help)
{
  Option& option = add(
      name, Option::Kind::TEXT, [&](const std::string& text) { field.push_back(text); }, help);
  option.most = Option::ANY;
  return option;
}

Option& OptionTable::flag(const char* name, bool& field, const std::string& help)
{
  return add(
      name, Option::Kind::FLAG, [&](const std::string& /*none*/) { field = true; }, help);
}

void OptionTable::oneOf(const std::vector<std::string>& names)
{
  alternatives.push_back(names);
  for (const std::string& name : names)
  {
    find(name)->heading = "Exactly one of these options is required";
  }
}

Option* OptionTable::find(const std::string& name)
{
  const auto found =
      std::find_if(options.begin(), options.end(), [&](const Option& option) { return option.name == name; });
  return found == options.end() ? nullptr : &*found;
}

bool OptionTable::isGiven(const std::string& name)
{
  const Option* option = find(name);
  return option != nullptr && option->given;
}

void OptionTable::take()
{
  for (const Option& option : options)
  {
    if (!option.given)
    {
      continue;
    }
    requireValues(option);
    for (const std::string& value : option.kind == Option::Kind::FLAG ? std::vector{ std::string() } : option.values)
    {
      option.take(value);
    }
  }
  checkTogether();
}

void OptionTable::checkTogether()
{
  for (const Option& option : options)
  {
    if (option.is_required && !option.given)
    {
      throw InputError(option.name + " is required");
    }
    for (const std::string& needed : option.needed)
    {
      if (option.given && !isGiven(needed))
      {
        throw InputError(option.name + " requires " + needed);
      }
    }
  }
  for (const std::vector<std::string>& names : alternatives)
  {
    const auto given =
        std::count_if(names.begin(), names.end(), [&](const std::string& name) { return isGiven(name); });
    if (given != 1)
    {
      throw InputError("Exactly 1 option from [" + joined(names, ",") + "] is required" +
                       (given > 1 ? " and " + std::to_string(given) + " were given" : ""));
    }
  }
}

namespace fs = std::filesystem;

void addOptions(OptionTable& table, ConfigurationOptions& options)
{
  table
      .add("--config", options.configs,
           "YAML file whose values replace those of the default configuration; repeatable, later files win")
      .type("FILE")
      .group(COMMON_GROUP);
  table
      .add("--set", options.assignments,
           "value of one parameter, which replaces its value in all files; repeatable, later values win")
      .type("section.key=value")
      .group(COMMON_GROUP);
  table.add("--config-dir", options.config_dir, "directory of the default configuration [or HJT_CONFIG_DIR]")
      .type("DIR")
      .group(COMMON_GROUP);
}

void addOptions(OptionTable& table, ConfigurationOptions& options, bool& force)
{
  addOptions(table, options);
  table.flag("--force", force, "overwrite existing output files").group(COMMON_GROUP);
}

void addFaultOption(OptionTable& table, ConfigurationOptions& options)
{
  table
      .add("--fault", options.faults,
           "fault of the gear in addition to the configured faults (list: `joint_twin faults`); repeatable")
      .type("KIND:SEVERITY[:PLACE[:ONSET]]");
}

fs::path configDirectory(const ConfigurationOptions& options)
{
  return configurationDirectory(options.config_dir);
}

ParameterMap defaultParameterMap(const ConfigurationOptions& options)
{
  ParameterMap map;
  readDefaultConfiguration(configDirectory(options).string(), map);
  return map;
}

void readOverlay(const ConfigurationOptions& options, const std::string& name, ParameterMap& map)
{
  readYamlFile(findConfiguration(name, configDirectory(options)), map);
}

void addOverlays(const ConfigurationOptions& options, ParameterMap& map)
{
  for (const std::string& overlay : options.configs)
  {
    readOverlay(options, overlay, map);
  }
  for (const std::string& assignment : options.assignments)
  {
    readAssignment(assignment, map);
  }
  if (options.values.count(faultKey(0) + ".kind") > 0)
  {
    eraseFaults(map);
  }
  putOver(options.values, map);
  if (!options.config_dir.empty())
  {
    findNamedFiles(configDirectory(options), map);
  }
}

ParameterMap loadParameterMap(const ConfigurationOptions& options)
{
  ParameterMap map = defaultParameterMap(options);
  addOverlays(options, map);
  return map;
}

void addFaults(const ConfigurationOptions& options, Parameters& parameters)
{
  for (const std::string& fault : options.faults)
  {
    parameters.faults.push_back(parseFault(fault, parameters));
  }
  if (parameters.faults.size() > MAX_FAULTS)
  {
    throw ParameterError("--fault: more than " + std::to_string(MAX_FAULTS) + " faults, with the configured faults");
  }
}

Parameters loadParameters(const ConfigurationOptions& options)
{
  Parameters parameters = parseParameters(loadParameterMap(options));
  addFaults(options, parameters);
  return parameters;
}
}  // namespace hjt
