// SPDX-License-Identifier: BSD-3-Clause
#include "fmu/fmu_file.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <set>
#include <utility>

#include "arm/arm_controller.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "base/whole_file.hpp"
#include "fmu/arm_variables.hpp"
#include "fmu/variables.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "params/configuration_files.hpp"

namespace hjt::fmu
{
namespace
{
struct UnitDescription
{
  std::string name;
  std::string meaning;
  std::string library;  ///< name of the library in the unit, without its extension
  std::string token;    ///< see instantiationToken
  double rate{};        ///< rate of the steps inside the unit [Hz]
  double step{};        ///< step that the unit suggests to an importer [s]
  std::vector<FmuVariable> variables;
};

/// A unit of measurement with exponents of the base units kg, m, s, A, K, rad. Units without a row need no exponents.
struct UnitRow
{
  const char* name;
  std::array<int, 6> exponents;
  double offset{};
};
const std::array UNITS{
  UnitRow{ "N.m", { 1, 2, -2 } },
  UnitRow{ "N", { 1, 1, -2 } },
  UnitRow{ "J", { 1, 2, -2 } },
  UnitRow{ "rad", { 0, 0, 0, 0, 0, 1 } },
  UnitRow{ "rad/s", { 0, 0, -1, 0, 0, 1 } },
  UnitRow{ "s", { 0, 0, 1 } },
  UnitRow{ "m", { 0, 1 } },
  UnitRow{ "kg", { 1 } },
  UnitRow{ "A", { 0, 0, 0, 1 } },
  UnitRow{ "K", { 0, 0, 0, 0, 1 } },
  UnitRow{ "degC", { 0, 0, 0, 0, 1 }, 273.15 },
  UnitRow{ "rad/s^2", { 0, 0, -2, 0, 0, 1 } },
  UnitRow{ "m/s^2", { 0, 1, -2 } },
  UnitRow{ "1/s", { 0, 0, -1 } },
  UnitRow{ "N.m.s/rad", { 1, 2, -1, 0, 0, -1 } },
  UnitRow{ "N.m/rad", { 1, 2, -2, 0, 0, -1 } },
  UnitRow{ "N/m", { 1, 0, -2 } },
  UnitRow{ "kg.m^2", { 1, 2 } },
  UnitRow{ "W/K", { 1, 2, -3, 0, -1 } },
  UnitRow{ "J/K", { 1, 2, -2, 0, -1 } },
  UnitRow{ "W", { 1, 2, -3 } },
  UnitRow{ "Hz", { 0, 0, -1 } },
  UnitRow{ "m/s", { 0, 1, -1 } },
  UnitRow{ "m^2/s", { 0, 2, -1 } },
  UnitRow{ "N.s/m", { 1, 0, -1 } },
  UnitRow{ "1/K", { 0, 0, 0, 0, -1 } },
  UnitRow{ "W/(N.m)^2", { -1, -2, 1 } },
};

std::string attribute(const char* name, const std::string& value)
{
  return std::string(" ") + name + "=\"" + xmlText(value) + '"';
}

std::string unitDefinition(const std::string& unit)
{
  const auto* row = std::find_if(UNITS.begin(), UNITS.end(), [&](const UnitRow& each) { return each.name == unit; });
  std::string text = "    <Unit" + attribute("name", unit);
  if (row == UNITS.end())
  {
    return text + "/>\n";
  }
  constexpr std::array NAMES{ "kg", "m", "s", "A", "K", "rad" };
  text += "><BaseUnit";
  for (std::size_t i = 0; i < NAMES.size(); ++i)
  {
    text += row->exponents[i] != 0 ? attribute(NAMES[i], std::to_string(row->exponents[i])) : "";
  }
  return text + (row->offset != 0.0 ? attribute("offset", numberText(row->offset)) : "") + "/></Unit>\n";
}

/// Attribute `name` with a bound of the variable, written as the variable's type requires; empty without a bound.
std::string bound(const char* name, const FmuVariable& variable, double value)
{
  const bool open = value <= -std::numeric_limits<double>::max() || value >= std::numeric_limits<double>::max();
  return open                         ? "" :
         variable.type == Type::INT32 ? attribute(name, std::to_string(static_cast<int>(value))) :
                                        attribute(name, numberText(value));
}

std::string startText(const FmuVariable& variable)
{
  return joined(variable.start.numbers, " ",
                [&](double number)
                {
                  return variable.type == Type::BOOLEAN ? std::string(number != 0.0 ? "true" : "false") :
                         variable.type == Type::INT32   ? std::to_string(static_cast<int>(number)) :
                                                          numberText(number);
                });
}

/// Attributes that a variable has in FMI 2.0 and in FMI 3.0.
std::string generalAttributes(const FmuVariable& variable, std::size_t reference)
{
  constexpr std::array CAUSALITIES{ "independent", "input", "output", "parameter" };
  const bool continuous = variable.type == Type::FLOAT64 && !variable.is_discrete;
  return attribute("name", variable.name) + attribute("valueReference", std::to_string(reference)) +
         (variable.description.empty() ? "" : attribute("description", variable.description)) +
         attribute("causality", CAUSALITIES[static_cast<std::size_t>(variable.causality)]) +
         attribute("variability", variable.causality == Causality::PARAMETER ? "fixed" :
                                  continuous                                 ? "continuous" :
                                                                               "discrete") +
         (variable.causality == Causality::OUTPUT ? attribute("initial", "calculated") : "");
}

bool starts(const FmuVariable& variable)
{
  return variable.causality == Causality::INPUT || variable.causality == Causality::PARAMETER;
}

/// Attributes of a variable's values: unit, bounds and start value (but not the start value of a text).
std::string valueAttributes(const FmuVariable& variable)
{
  std::string text = variable.type == Type::FLOAT64 && variable.unit != "-" ? attribute("unit", variable.unit) : "";
  if (variable.range)
  {
    text += bound("min", variable, variable.range->min) + bound("max", variable, variable.range->max);
  }
  return text + (starts(variable) && variable.type != Type::STRING ? attribute("start", startText(variable)) : "");
}

std::string element3(const FmuVariable& variable, std::size_t reference)
{
  constexpr std::array TYPES{ "Float64", "Int32", "Boolean", "String" };
  const std::string type = TYPES[static_cast<std::size_t>(variable.type)];
  const std::string inner =
      (variable.is_array ? "<Dimension" + attribute("start", std::to_string(variable.start.numbers.size())) + "/>" :
                           std::string()) +
      (variable.type == Type::STRING ? "<Start" + attribute("value", variable.start.text) + "/>" : std::string());
  return "    <" + type + generalAttributes(variable, reference) + valueAttributes(variable) +
         (inner.empty() ? "/>\n" : ">" + inner + "</" + type + ">\n");
}

std::string element2(const FmuVariable& variable, std::size_t reference)
{
  constexpr std::array TYPES{ "Real", "Integer", "Boolean", "String" };
  return "    <ScalarVariable" + generalAttributes(variable, reference) + "><" +
         TYPES[static_cast<std::size_t>(variable.type)] + valueAttributes(variable) +
         (variable.type == Type::STRING ? attribute("start", variable.start.text) : "") + "/></ScalarVariable>\n";
}

/// A variable in the description of a unit, with its value reference.
struct Referred
{
  FmuVariable variable;
  std::size_t reference;
};

/// The variables as a version of FMI declares them: FMI 2.0 has a scalar for each element of an array.
std::vector<Referred> referred(const std::vector<FmuVariable>& all, Version version)
{
  std::vector<Referred> found;
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    if (version == Version::FMI_3 || !all[i].is_array)
    {
      found.push_back({ all[i], i });
      continue;
    }
    for (std::size_t k = 0; k < all[i].start.numbers.size(); ++k)
    {
      found.push_back({ all[i], k << ELEMENT_SHIFT | i });
      FmuVariable& scalar = found.back().variable;
      scalar.name += '[' + std::to_string(k + 1) + ']';
      scalar.start.numbers = { all[i].start.numbers[k] };
    }
  }
  return found;
}

std::string modelDescription(const UnitDescription& unit, Version version)
{
  const bool is_3 = version == Version::FMI_3;
  std::set<std::string> units;
  std::string elements;
  std::string outputs;
  std::string unknowns;
  std::size_t number = 0;
  for (const auto& [variable, reference] : referred(unit.variables, version))
  {
    elements += (is_3 ? element3 : element2)(variable, reference);
    ++number;
    if (variable.type == Type::FLOAT64 && variable.unit != "-")
    {
      units.insert(variable.unit);
    }
    if (variable.causality == Causality::OUTPUT)
    {
      // An output depends on no input, because inputs act only in the next step.
      const std::string which =
          is_3 ? attribute("valueReference", std::to_string(reference)) : attribute("index", std::to_string(number));
      outputs += std::string(is_3 ? "    <Output" : "    <Unknown") + which + attribute("dependencies", "") + "/>\n";
      unknowns += std::string(is_3 ? "    <InitialUnknown" : "    <Unknown") + which + "/>\n";
    }
  }
  return std::string("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription") +
         attribute("fmiVersion", is_3 ? "3.0" : "2.0") + attribute("modelName", unit.name) +
         attribute(is_3 ? "instantiationToken" : "guid", unit.token) + attribute("description", unit.meaning) +
         attribute("license", "BSD-3-Clause") + attribute("generationTool", "harmonic_joint_twin " HJT_VERSION) +
         attribute("variableNamingConvention", "structured") + ">\n  <CoSimulation" +
         attribute("modelIdentifier", unit.library) +
         attribute(is_3 ? "canGetAndSetFMUState" : "canGetAndSetFMUstate", "true") +
         attribute(is_3 ? "canSerializeFMUState" : "canSerializeFMUstate", "true") +
         attribute("canHandleVariableCommunicationStepSize", "true") +
         (is_3 ? attribute("fixedInternalStepSize", numberText(1.0 / unit.rate)) : "") + "/>\n  <UnitDefinitions>\n" +
         joined(units, "", unitDefinition) + "  </UnitDefinitions>\n" + "  <LogCategories>\n" +
         joined(LOG_CATEGORIES, "",
                [](const char* name) { return "    <Category" + attribute("name", name) + "/>\n"; }) +
         "  </LogCategories>\n  <DefaultExperiment startTime=\"0\" stopTime=\"1\"" +
         attribute("stepSize", numberText(unit.step)) + "/>\n  <ModelVariables>\n" + elements +
         "  </ModelVariables>\n  <ModelStructure>\n" +
         (is_3 ? outputs + unknowns :
                 "    <Outputs>\n" + outputs + "    </Outputs>\n    <InitialUnknowns>\n" + unknowns +
                     "    </InitialUnknowns>\n") +
         "  </ModelStructure>\n</fmiModelDescription>\n";
}

/// A ZIP archive of uncompressed files, smaller than 4 GB (PKWARE's APPNOTE, ISO/IEC 21320-1).
class Zip
{
public:
  /// Adds a file. `name`: path with / between directories.
  void add(const std::string& name, const std::string& bytes)
  {
    const auto offset = static_cast<std::uint32_t>(files_.size());
    const auto size = static_cast<std::uint32_t>(bytes.size());
    // The fields of `common` say: version 1.0, no flags, uncompressed, time 1980-01-01 00:00.
    std::string common;
    append(common,
           { { 10, 2 }, { 0, 2 }, { 0, 2 }, { 0, 2 }, { 0x21, 2 }, { crc(bytes), 4 }, { size, 4 }, { size, 4 } });
    append(common, { { static_cast<std::uint32_t>(name.size()), 2 }, { 0, 2 } });
    append(files_, { { 0x04034b50, 4 } });
    files_ += common + name + bytes;
    // The first fields say: made on Unix by version 2.0, readable and executable for all users.
    append(directory_, { { 0x02014b50, 4 }, { 0x0314, 2 } });
    directory_ += common;
    append(directory_, { { 0, 2 }, { 0, 2 }, { 0, 2 }, { 0100755u << 16, 4 }, { offset, 4 } });
    directory_ += name;
    ++count_;
  }

  std::string bytes() const
  {
    std::string all = files_ + directory_;
    append(all, { { 0x06054b50, 4 },
                  { 0, 2 },
                  { 0, 2 },
                  { count_, 2 },
                  { count_, 2 },
                  { static_cast<std::uint32_t>(directory_.size()), 4 },
                  { static_cast<std::uint32_t>(files_.size()), 4 },
                  { 0, 2 } });
    return all;
  }

private:
  /// Appends numbers of given sizes in bytes, lowest byte first.
  static void append(std::string& text, std::initializer_list<std::pair<std::uint32_t, int>> numbers)
  {
    for (const auto& [number, bytes] : numbers)
    {
      for (int i = 0; i < bytes; ++i)
      {
        text += static_cast<char>(number >> (8 * i) & 0xff);
      }
    }
  }

  static std::uint32_t crc(const std::string& bytes)
  {
    constexpr std::uint32_t POLYNOMIAL = 0xedb88320;
    std::uint32_t value = 0xffffffff;
    for (const char byte : bytes)
    {
      value ^= static_cast<unsigned char>(byte);
      for (int bit = 0; bit < 8; ++bit)
      {
        value = value >> 1 ^ ((value & 1) != 0 ? POLYNOMIAL : 0);
      }
    }
    return ~value;
  }

  std::string files_;
  std::string directory_;
  std::uint32_t count_{};
};

namespace fs = std::filesystem;

/// Adds the files in the directory `resources` of a unit.
class Resources
{
public:
  explicit Resources(Zip& zip) : zip_(zip) {}

  void add(const std::string& name, const std::string& text)
  {
    zip_.add("resources/" + name, text);
    texts_ += text;
  }

  /// Adds a drive with the files that `parameters` name. @returns the parameters with the names that the files have in
  /// the unit.
  Parameters addDrive(const std::string& folder, Parameters parameters)
  {
    carry(folder, parameters.indicators.signatures, "signatures.yaml");
    carry(folder, parameters.manufacture.flexspline_pitch.table, "flexspline_pitch.csv");
    carry(folder, parameters.manufacture.circular_spline_pitch.table, "circular_spline_pitch.csv");
    add(folder + PARAMETER_FILE, describeParameters(parameters));
    return parameters;
  }

  std::string token() const { return instantiationToken(texts_); }

private:
  void carry(const std::string& folder, std::string& name, const char* carried)
  {
    if (name != NO_FILE)
    {
      const std::string path =
          fs::path(name).is_absolute() ? name : findConfiguration(name, configurationDirectory(""));
      name = carried;
      zip_.add("resources/" + folder + name, readFile(path));
    }
  }

  Zip& zip_;
  std::string texts_;
};

/// Adds to the archive the unit's library and the libraries that this library loads, with the licences, which Debian
/// has in /usr/share/doc/libNAME-VERSION/copyright.
void addLibraries(const UnitLibraries& libraries, const std::string& name, Version version, Zip& zip)
{
#ifdef __aarch64__
  const std::string binaries = "binaries/aarch64-linux/";
  static_cast<void>(version);
#else
  const std::string binaries = version == Version::FMI_3 ? "binaries/x86_64-linux/" : "binaries/linux64/";
#endif
  zip.add(binaries + name + ".so", readFile(libraries.own, MAX_BINARY));
  for (const std::string& other : libraries.others)
  {
    const std::string file = fs::path(other).filename();
    zip.add(binaries + file, readFile(other, MAX_BINARY));
    const std::string package = file.substr(0, file.find(".so"));
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator("/usr/share/doc", error))
    {
      const fs::path licence = entry.path() / "copyright";
      if (entry.path().filename().string().rfind(package, 0) == 0 && fs::exists(licence, error))
      {
        zip.add("documentation/licenses/" + entry.path().filename().string() + ".txt", readFile(licence));
        break;
      }
    }
  }
}

std::string finish(const UnitDescription& unit, const UnitLibraries& libraries, Version version, Zip& zip)
{
  zip.add("modelDescription.xml", modelDescription(unit, version));
  zip.add("documentation/licenses/license.txt", readFile(packageDirectory() / "LICENSE"));
  addLibraries(libraries, unit.library, version, zip);
  return zip.bytes();
}
}  // namespace

std::string driveFmu(const Parameters& parameters, const UnitLibraries& libraries, Version version)
{
  Zip zip;
  Resources resources(zip);
  const Parameters carried = resources.addDrive("", parameters);
  const UnitDescription unit{ carried.joint.name,     "Twin of a robot joint's harmonic drive, with all its teeth",
                              "harmonic_joint_twin",  resources.token(),
                              carried.solver.rate,    0.001,
                              driveVariables(carried) };
  return finish(unit, libraries, version, zip);
}

std::string armFmu(const std::string& name, const ArmDescription& arm, const std::vector<Parameters>& drives,
                   const UnitLibraries& libraries, Version version)
{
  ArmDescription whole = arm;
  std::vector<Parameters> carried;
  Zip zip;
  Resources resources(zip);
  for (std::size_t i = 0; i < drives.size(); ++i)
  {
    whole.joints[i].gains = arm.joints[i].gains.value_or(ArmController::defaultGains(drives[i]));
  }
  resources.add(ARM_FILE, armResource(whole));
  for (std::size_t i = 0; i < drives.size(); ++i)
  {
    carried.push_back(resources.addDrive(arm.joints[i].short_name + '/', drives[i]));
  }
  const UnitDescription unit{ name,
                              "Twins of all drives of a robot arm, with its links and its controller",
                              "harmonic_joint_twin_arm",
                              resources.token(),
                              drives.front().solver.rate,
                              1.0 / arm.state_rate,
                              armVariables(whole, carried) };
  return finish(unit, libraries, version, zip);
}
}  // namespace hjt::fmu
