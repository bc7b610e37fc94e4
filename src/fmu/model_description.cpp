// SPDX-License-Identifier: BSD-3-Clause
#include "fmu/model_description.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "base/joined.hpp"
#include "base/number_text.hpp"
#include "base/xml_text.hpp"
#include "fmu/fmi3.hpp"

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

std::string element(const FmuVariable& variable, std::size_t reference)
{
  constexpr std::array TYPES{ "Float64", "Int32", "Boolean", "String" };
  constexpr std::array CAUSALITIES{ "independent", "input", "output", "parameter" };
  const std::string type = TYPES[static_cast<std::size_t>(variable.type)];
  const bool continuous = variable.type == Type::FLOAT64 && !variable.is_discrete;
  const bool starts = variable.causality == Causality::INPUT || variable.causality == Causality::PARAMETER;
  std::string text = "    <" + type + attribute("name", variable.name) +
                     attribute("valueReference", std::to_string(reference)) +
                     (variable.description.empty() ? "" : attribute("description", variable.description)) +
                     attribute("causality", CAUSALITIES[static_cast<std::size_t>(variable.causality)]) +
                     attribute("variability", variable.causality == Causality::PARAMETER ? "fixed" :
                                              continuous                                 ? "continuous" :
                                                                                           "discrete");
  text += variable.causality == Causality::OUTPUT ? attribute("initial", "calculated") : "";
  text += variable.type == Type::FLOAT64 && variable.unit != "-" ? attribute("unit", variable.unit) : "";
  if (variable.range)
  {
    text += bound("min", variable, variable.range->min) + bound("max", variable, variable.range->max);
  }
  text += starts && variable.type != Type::STRING ? attribute("start", startText(variable)) : "";
  std::string inner;
  if (variable.is_array)
  {
    inner += "<Dimension" + attribute("start", std::to_string(variable.start.numbers.size())) + "/>";
  }
  if (variable.type == Type::STRING)
  {
    inner += "<Start" + attribute("value", variable.start.text) + "/>";
  }
  return text + (inner.empty() ? "/>\n" : ">" + inner + "</" + type + ">\n");
}
}  // namespace

std::string modelDescription(const UnitDescription& unit)
{
  const std::vector<FmuVariable>& all = unit.variables;
  std::set<std::string> units;
  std::string elements;
  std::string outputs;
  std::string unknowns;
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    elements += element(all[i], i);
    if (all[i].type == Type::FLOAT64 && all[i].unit != "-")
    {
      units.insert(all[i].unit);
    }
    if (all[i].causality == Causality::OUTPUT)
    {
      // After a step an output is what it is, whatever the inputs become.
      outputs +=
          "    <Output" + attribute("valueReference", std::to_string(i)) + attribute("dependencies", "") + "/>\n";
      unknowns += "    <InitialUnknown" + attribute("valueReference", std::to_string(i)) + "/>\n";
    }
  }
  return std::string("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription fmiVersion=\"3.0\"") +
         attribute("modelName", unit.name) + attribute("instantiationToken", unit.token) +
         attribute("description", unit.meaning) + attribute("license", "BSD-3-Clause") +
         attribute("generationTool", "harmonic_joint_twin " HJT_VERSION) +
         attribute("variableNamingConvention", "structured") + ">\n  <CoSimulation" +
         attribute("modelIdentifier", unit.library) + attribute("canGetAndSetFMUState", "true") +
         attribute("canHandleVariableCommunicationStepSize", "true") +
         attribute("fixedInternalStepSize", numberText(1.0 / unit.rate)) + "/>\n  <UnitDefinitions>\n" +
         joined(units, "", unitDefinition) + "  </UnitDefinitions>\n" + "  <LogCategories>\n" +
         joined(LOG_CATEGORIES, "",
                [](const char* name) { return "    <Category" + attribute("name", name) + "/>\n"; }) +
         "  </LogCategories>\n  <DefaultExperiment startTime=\"0\" stopTime=\"1\"" +
         attribute("stepSize", numberText(unit.step)) +
         "/>\n"
         "  <ModelVariables>\n" +
         elements + "  </ModelVariables>\n  <ModelStructure>\n" + outputs + unknowns +
         "  </ModelStructure>\n</fmiModelDescription>\n";
}
}  // namespace hjt::fmu
