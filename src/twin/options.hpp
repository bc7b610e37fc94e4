// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <list>
#include <optional>
#include <string>
#include <vector>

#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// One option or argument of a function: a row of its table with the rules for its values. Each call adds a rule. The
/// option also holds the given values.
struct Option
{
  enum class Kind
  {
    FLAG,
    WHOLE,
    NUMBER,
    TEXT
  };
  using Take = std::function<void(const std::string&)>;
  /// Returns the error of a text; empty if there is none.
  using Check = std::function<std::string(const std::string&)>;
  static constexpr std::size_t ANY = std::numeric_limits<std::size_t>::max();

  Option& required();
  Option& type(const char* text);  ///< type of the value in the help
  Option& group(const char* text);
  Option& range(double lowest, double highest);
  Option& positive();
  Option& choice(const std::vector<std::string>& names);
  Option& pair();                                           ///< requires two values, separated by a comma
  Option& endsIn(const std::vector<std::string>& endings);  ///< requires one of these endings of the file's name
  Option& existingFile();
  Option& existingDirectory();
  Option& needs(const char* option);
  Option& follow();  ///< for a list: several values may follow one name
  Option& check(const Check& wrong);

  bool isArgument() const { return name.front() != '-'; }

  std::string name;  ///< with leading dashes for an option, without for an argument
  std::string help;
  std::string heading;  ///< heading of its group in the help
  Kind kind{ Kind::FLAG };
  std::string value_type{};    ///< type of the value in the help
  std::string allowed{};       ///< allowed values, after the type in the help
  std::string default_text{};  ///< default in the help
  std::size_t least{};         ///< least number of values, if the option is given
  std::size_t most{};          ///< largest number of values; zero: the option is a flag
  bool commas{};               ///< commas separate the values, and values may follow one name
  bool follows{};              ///< several values may follow one name
  bool is_required{};
  std::vector<std::string> needed{};  ///< other options that the option requires
  std::vector<Check> checks{};        ///< checks of each value
  Take take{};                        ///< stores a value in its field

  bool given{};
  std::vector<std::string> values{};
  std::string shown{};  ///< name in errors about the values; empty: `name`
};

/// The options of a function with the fields that they set. The command line, its help and the keyword arguments of
/// Python derive from this table. Names with leading dashes are options, others arguments. Numbers must be finite. The
/// value of a field at its declaration is the default in the help.
struct OptionTable
{
  Option& add(const char* name, double& field, const std::string& help);
  Option& add(const char* name, int& field, const std::string& help);
  Option& add(const char* name, unsigned& field, const std::string& help);
  Option& add(const char* name, std::string& field, const std::string& help);
  Option& add(const char* name, std::optional<double>& field, const std::string& help);
  Option& add(const char* name, std::optional<std::string>& field, const std::string& help);
  Option& add(const char* name, std::vector<double>& field, const std::string& help);  ///< values separated by commas
  Option& add(const char* name, std::vector<std::string>& field, const std::string& help);  ///< one or more values
  Option& flag(const char* name, bool& field, const std::string& help);
  /// Adds an option whose values are passed to `take`.
  Option& add(const std::string& name, Option::Kind kind, const Option::Take& take, const std::string& help);

  /// Requires one of these options.
  void oneOf(const std::vector<std::string>& names);

  Option* find(const std::string& name);

  /// Stores the given values in their fields. @throws InputError if a rule is violated.
  void take();

  std::list<Option> options;
  std::vector<std::vector<std::string>> alternatives;  ///< groups of options, one of each of which is required

private:
  bool isGiven(const std::string& name);
  void checkTogether();
};

/// Options that select the parameters: the default configuration and its changes.
struct ConfigurationOptions
{
  std::string config_dir;                ///< directory of the default configuration; empty: found automatically
  std::vector<std::string> configs;      ///< overlay files; later ones win
  std::vector<std::string> assignments;  ///< section.key=value, which replace values of the overlays
  std::vector<std::string> faults;       ///< KIND:SEVERITY[:PLACE[:ONSET]], in addition to the configured faults
  ParameterMap values;                   ///< values that replace all others

  /// Whether at most faults change the default configuration.
  bool isDefault() const { return configs.empty() && assignments.empty() && values.empty(); }
};

constexpr const char* COMMON_GROUP = "Common options";

/// Adds the options for files and assignments; Python has the argument `overlays` instead.
void addOptions(OptionTable& table, ConfigurationOptions& options);
/// Adds these options and the one that allows overwriting files.
void addOptions(OptionTable& table, ConfigurationOptions& options, bool& force);

/// Adds `--fault`, for functions that simulate or analyse the joint.
void addFaultOption(OptionTable& table, ConfigurationOptions& options);

/// Directory of the default configuration. @throws ParameterError if there is none.
std::filesystem::path configDirectory(const ConfigurationOptions& options);

/// Steps of loadParameterMap: the default configuration; one overlay, as given or relative to it; those of the options.
/// @throws ParameterError.
ParameterMap defaultParameterMap(const ConfigurationOptions& options);
void readOverlay(const ConfigurationOptions& options, const std::string& name, ParameterMap& map);
void addOverlays(const ConfigurationOptions& options, ParameterMap& map);

/// The default configuration, changed by overlays, assignments and values. @throws ParameterError.
ParameterMap loadParameterMap(const ConfigurationOptions& options);

/// Adds the faults of the options to the configured ones. @throws ParameterError.
void addFaults(const ConfigurationOptions& options, Parameters& parameters);

/// Checked parameters with the faults of the options. @throws ParameterError.
Parameters loadParameters(const ConfigurationOptions& options);
}  // namespace hjt
