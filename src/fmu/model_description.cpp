// SPDX-License-Identifier: BSD-3-Clause
#include "fmu/model_description.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "base/joined.hpp"
#include "base/number_text.hpp"
#include "base/xml_text.hpp"
#include "fmu/fmi.hpp"

namespace hjt::fmu
{
namespace
{
/// Units as exponents of the base units kg, m, s, A, K, rad; FMI needs no base unit of the others.
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

/// A bound of a variable as its type has it; without one where the table has none.
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

/// What both versions say of a variable itself.
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

/// And of its values, but for texts.
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

/// A variable of a description and its value reference.
struct Referred
{
  FmuVariable variable;
  std::size_t reference;
};

/// As the version has them: FMI 2.0 a scalar for each element of an array.
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
}  // namespace

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
      // After a step an output is what it is, whatever the inputs become.
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
}  // namespace hjt::fmu
