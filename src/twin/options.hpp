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
/// Option or argument of a function, with rules for its values, and the given values. Each member function adds a rule.
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
  /// Function that returns the error of a given text; empty if the text is right.
  using Check = std::function<std::string(const std::string&)>;
  static constexpr std::size_t ANY = std::numeric_limits<std::size_t>::max();

  Option& required();
  Option& type(const char* text);  ///< sets the type of the value that the help shows
  Option& group(const char* text);
  Option& range(double lowest, double highest);
  Option& positive();
  Option& choice(const std::vector<std::string>& names);
  Option& pair();                                           ///< requires two values with a comma between them
  Option& endsIn(const std::vector<std::string>& endings);  ///< requires a file name with one of these endings
  Option& existingFile();
  Option& existingDirectory();
  Option& needs(const char* option);
  Option& follow();  ///< allows that several values follow the option's name; for a list
  Option& check(const Check& wrong);

  bool isArgument() const { return name.front() != '-'; }

  std::string name;  ///< name; an option has leading dashes
  std::string help;
  std::string heading;  ///< heading of the option's group in the help
  Kind kind{ Kind::FLAG };
  std::string value_type{};    ///< type of the value that the help shows
  std::string allowed{};       ///< allowed values, which the help shows after the type
  std::string default_text{};  ///< default that the help shows
  std::size_t least{};         ///< least number of values if the option is given
  std::size_t most{};          ///< largest number of values; 0: the option is a flag
  bool commas{};               ///< whether commas separate the values
  bool follows{};              ///< whether several values may follow the option's name
  bool is_required{};
  std::vector<std::string> needed{};  ///< other options that the option requires
  std::vector<Check> checks{};        ///< checks of each value
  Take take{};                        ///< stores a value in its field

  bool given{};
  std::vector<std::string> values{};
  std::string shown{};  ///< name in errors about the values; empty: `name`
};

/// Options of a function with the fields that they set. The command line, its help and the keyword arguments of Python
/// derive from this table. A name with leading dashes is that of an option, another name that of an argument. Numbers
/// must be finite. The help shows the present value of a field as the default.
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
  /// Adds an option. The table passes each value of the option to `take`.
  Option& add(const std::string& name, Option::Kind kind, const Option::Take& take, const std::string& help);

  /// Requires that exactly one of the options `names` is given.
  void oneOf(const std::vector<std::string>& names);

  Option* find(const std::string& name);

  /// Stores the given values in the fields of the options. @throws InputError if a value or an option violates a rule.
  void take();

  std::list<Option> options;
  std::vector<std::vector<std::string>> alternatives;  ///< groups of options; each group requires exactly one

private:
  bool isGiven(const std::string& name);
  void checkTogether();
};

/// Options that select the parameters: directory of the default configuration, and changes of it.
struct ConfigurationOptions
{
  std::string config_dir;                ///< directory of the default configuration; empty: see configDirectory
  std::vector<std::string> configs;      ///< overlay files; values of later files win
  std::vector<std::string> assignments;  ///< section.key=value; these values replace those of the overlays
  std::vector<std::string> faults;       ///< KIND:SEVERITY[:PLACE[:ONSET]]: faults in addition to the configured faults
  ParameterMap values;                   ///< values that replace those of overlays and assignments

  /// Whether no option changes a parameter of the default configuration. Faults do not count.
  bool isDefault() const { return configs.empty() && assignments.empty() && values.empty(); }
};

constexpr const char* COMMON_GROUP = "Common options";

/// Adds the options for overlay files and assignments. The argument `overlays` of a Python call replaces these options.
void addOptions(OptionTable& table, ConfigurationOptions& options);
/// Adds the options for overlay files and assignments, and the option that allows overwriting files.
void addOptions(OptionTable& table, ConfigurationOptions& options, bool& force);

/// Adds the option `--fault`, for functions that simulate or analyse the joint.
void addFaultOption(OptionTable& table, ConfigurationOptions& options);

/// Directory of the default configuration. @throws ParameterError if there is none.
std::filesystem::path configDirectory(const ConfigurationOptions& options);

/// Steps of loadParameterMap. They read the default configuration, read an overlay (as given or relative to the default
/// configuration's directory), and add the overlays, assignments and values of the options. @throws ParameterError.
ParameterMap defaultParameterMap(const ConfigurationOptions& options);
void readOverlay(const ConfigurationOptions& options, const std::string& name, ParameterMap& map);
void addOverlays(const ConfigurationOptions& options, ParameterMap& map);

/// Default configuration, changed by the overlays, assignments and values of the options. @throws ParameterError.
ParameterMap loadParameterMap(const ConfigurationOptions& options);

/// Adds the faults of the options to the configured faults. @throws ParameterError.
void addFaults(const ConfigurationOptions& options, Parameters& parameters);

/// Checked parameters with the faults of the options. @throws ParameterError.
Parameters loadParameters(const ConfigurationOptions& options);
}  // namespace hjt
