// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/params/parameter_map.hpp"

#include "base/joined.hpp"
#include "base/number_text.hpp"
#include "params/cross_checks.hpp"
#include "params/field_reader.hpp"
#include "params/field_table.hpp"

namespace hjt
{
std::optional<double> numberOf(const decltype(ParameterValue::value)& value)
{
  struct
  {
    std::optional<double> operator()(std::int64_t whole) const { return static_cast<double>(whole); }
    std::optional<double> operator()(double number) const { return number; }
    std::optional<double> operator()(const std::string& text) const { return decimalNumber(text); }
    std::optional<double> operator()(bool) const { return std::nullopt; }
    std::optional<double> operator()(const std::vector<double>&) const { return std::nullopt; }
  } read;
  return std::visit(read, value);
}

std::string valueText(const ParameterValue& configured)
{
  struct
  {
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(std::int64_t value) const { return std::to_string(value); }
    std::string operator()(double value) const { return numberText(value); }
    std::string operator()(const std::string& value) const { return "'" + value + "'"; }
    std::string operator()(const std::vector<double>& value) const
    {
      return "[" + joined(value, ", ", numberText) + "]";
    }
  } write;
  return std::visit(write, configured.value);
}

Parameters parseParameters(const ParameterMap& map)
{
  Parameters parameters;
  FieldReader reader(map);
  visitFields(parameters, reader);
  reader.readFaults(parameters.faults);
  reader.refuseUnknownKeys();
  throwIfAny(reader.errors());
  // Only values that are each in range can be compared with each other.
  throwIfAny(contradictions(parameters, map));
  return parameters;
}

void changeParameters(Parameters& parameters, const ParameterMap& changes)
{
  FieldReader reader(changes);
  visitFields(parameters,
              [&](const std::string& key, auto&&... field)
              {
                if (changes.count(key) > 0)
                {
                  reader(key, field...);
                }
              });
  reader.readFaults(parameters.faults);
  reader.refuseUnknownKeys();
  throwIfAny(reader.errors());
  throwIfAny(contradictions(parameters, changes));
}
}  // namespace hjt
