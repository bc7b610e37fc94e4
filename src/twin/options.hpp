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
/// One option or argument of a function: a row of its table, with the rules for what is given; each call adds one. And
/// what is given.
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
  /// What is wrong with a text, or nothing.
  using Check = std::function<std::string(const std::string&)>;
  static constexpr std::size_t ANY = std::numeric_limits<std::size_t>::max();

  Option& required();
  Option& type(const char* text);  ///< of the value, in the help
  Option& group(const char* text);
  Option& range(double lowest, double highest);
  Option& positive();
  Option& choice(const std::vector<std::string>& names);
  Option& pair();                                           ///< two values, separated by a comma
  Option& endsIn(const std::vector<std::string>& endings);  ///< the file's name
  Option& existingFile();
  Option& existingDirectory();
  Option& needs(const char* option);
  Option& follow();  ///< of a list: values may follow each other behind one name
  Option& check(const Check& wrong);

  bool isArgument() const { return name.front() != '-'; }

  std::string name;  ///< begins with dashes, else it is an argument
  std::string help;
  std::string heading;  ///< of its group in the help
  Kind kind{ Kind::FLAG };
  std::string value_type{};    ///< in the help
  std::string allowed{};       ///< in the help behind the type
  std::string default_text{};  ///< in the help
  std::size_t least{};         ///< number of values, if it is given
  std::size_t most{};          ///< zero: it is a flag
  bool commas{};               ///< separate values; then those of one name may also follow each other
  bool follows{};              ///< values of one name may follow each other
  bool is_required{};
  std::vector<std::string> needed{};  ///< options to give with it
  std::vector<Check> checks{};        ///< of each value
  Take take{};                        ///< puts a value into its field

  bool given{};
  std::vector<std::string> values{};
  std::string shown{};  ///< in errors about the values; empty: the name
};

/// The options of a function, with the fields that they set. From it come the command line, its help, and what Python
/// takes by name. Names with dashes are options, else arguments. Numbers must be finite; what a field holds at the
/// declaration is the default, shown in the help.
struct OptionTable
{
  Option& add(const char* name, double& field, const std::string& help);
  Option& add(const char* name, int& field, const std::string& help);
  Option& add(const char* name, unsigned& field, const std::string& help);
  Option& add(const char* name, std::string& field, const std::string& help);
  Option& add(const char* name, std::optional<double>& field, const std::string& help);
  Option& add(const char* name, std::optional<std::string>& field, const std::string& help);
  Option& add(const char* name, std::vector<double>& field, const std::string& help);       ///< separated by commas
  Option& add(const char* name, std::vector<std::string>& field, const std::string& help);  ///< once or more
  Option& flag(const char* name, bool& field, const std::string& help);
  /// Each value is given to `take`.
  Option& add(const std::string& name, Option::Kind kind, const Option::Take& take, const std::string& help);

  /// One of these options must be given.
  void oneOf(const std::vector<std::string>& names);

  Option* find(const std::string& name);

  /// Fills the fields of what is given. @throws InputError: a rule refuses it.
  void take();

  std::list<Option> options;
  std::vector<std::vector<std::string>> alternatives;  ///< one option of each must be given

private:
  bool isGiven(const std::string& name);
  void checkTogether();
};

/// Which parameters are asked for: the default configuration and what lies over it.
struct ConfigurationOptions
{
  std::string config_dir;                ///< where the default configuration lies; empty: found by itself
  std::vector<std::string> configs;      ///< overlays, files; later wins
  std::vector<std::string> assignments;  ///< section.key=value, over the overlays
  std::vector<std::string> faults;       ///< KIND:SEVERITY[:PLACE[:ONSET]], beside the configured ones
  ParameterMap values;                   ///< over all of these

  /// Nothing lies over the default configuration but faults.
  bool isDefault() const { return configs.empty() && assignments.empty() && values.empty(); }
};

constexpr const char* COMMON_GROUP = "Common options";

/// Its files and assignments; Python has `overlays` in their place.
void addOptions(OptionTable& table, ConfigurationOptions& options);
/// The same, and whether files are overwritten.
void addOptions(OptionTable& table, ConfigurationOptions& options, bool& force);

/// `--fault`, for what marches or analyses the joint.
void addFaultOption(OptionTable& table, ConfigurationOptions& options);

/// Folder of the default configuration. @throws ParameterError if there is none.
std::filesystem::path configDirectory(const ConfigurationOptions& options);

/// Steps of loadParameterMap: the default configuration, one overlay as given or beside it, those of the options.
/// @throws ParameterError.
ParameterMap defaultParameterMap(const ConfigurationOptions& options);
void readOverlay(const ConfigurationOptions& options, const std::string& name, ParameterMap& map);
void addOverlays(const ConfigurationOptions& options, ParameterMap& map);

/// The default configuration with the overlays, assignments and values over it. @throws ParameterError.
ParameterMap loadParameterMap(const ConfigurationOptions& options);

/// Adds the faults of the options to the configured ones. @throws ParameterError.
void addFaults(const ConfigurationOptions& options, Parameters& parameters);

/// The same, checked, with the faults. @throws ParameterError.
Parameters loadParameters(const ConfigurationOptions& options);
}  // namespace hjt
