// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <utility>

#include "base/joined.hpp"
#include "base/number_text.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "params/choices.hpp"
#include "params/field_rows.hpp"

namespace hjt
{
namespace
{
/// Makes a row of each field.
class RowMaker
{
public:
  void operator()(const std::string& key, const char* unit, double value, const Range& range, const Meaning& meaning)
  {
    rows.push_back({ key, "float", unit, range, {}, numberText(value), meaning });
  }
  void operator()(const std::string& key, const char* unit, int value, const Range& range, const Meaning& meaning)
  {
    rows.push_back({ key, "int", unit, range, {}, std::to_string(value), meaning });
  }
  template <std::size_t N>
  void operator()(const std::string& key, const char* unit, const std::array<double, N>& values, const Range& range,
                  const Meaning& meaning)
  {
    const std::string text = "[" + joined(values, ", ", numberText) + "]";
    rows.push_back({ key, std::to_string(N) + " floats", unit, range, {}, text, meaning });
  }
  void operator()(const std::string& key, bool value, const Meaning& meaning)
  {
    rows.push_back({ key, "bool", "-", {}, {}, value ? "true" : "false", meaning });
  }
  void operator()(const std::string& key, const std::string& value, const Meaning& meaning)
  {
    rows.push_back({ key, "text", "-", {}, {}, "\"" + value + "\"", meaning });
  }
  template <class Choice>
  std::enable_if_t<std::is_enum<Choice>::value> operator()(const std::string& key, Choice value, const Meaning& meaning)
  {
    FieldRow row{ key, "text", "-", {}, {}, "", meaning };
    for (const auto& [name, choice] : choiceNames(Choice{}))
    {
      row.choices.emplace_back(name);
      row.value = choice == value ? name : row.value;
    }
    rows.push_back(std::move(row));
  }

  std::vector<FieldRow> rows;
};

/// `section.key: value  # [unit] meaning`.
std::string lineOf(const FieldRow& row)
{
  return row.key + ": " + row.value + "  # [" + row.unit + "] " + row.meaning.text + '\n';
}

std::string allowedText(const FieldRow& row)
{
  if (row.range)
  {
    return rangeText(*row.range);
  }
  return row.type == "bool" ? "true, false" : row.choices.empty() ? "not empty" : joined(row.choices);
}
}  // namespace

std::vector<FieldRow> fieldRows(const Parameters& parameters)
{
  RowMaker maker;
  visitFields(parameters, maker);
  return std::move(maker.rows);
}

std::string describeParameters(const Parameters& parameters)
{
  RowMaker maker;
  visitFields(parameters, maker);
  int number = 0;
  for (const Fault& fault : parameters.faults)
  {
    const std::string key = faultKey(number++) + '.';
    maker(key + "kind", std::string(describe(fault.kind).name), "kind of the fault");
    maker(key + "severity", "-", fault.severity, {}, "severity");
    maker(key + "place", placeName(describe(fault.kind).place), fault.place, {}, "where; -1: the whole member");
    maker(key + "onset", "s", fault.onset, {}, "after the start");
  }
  std::string text;
  for (const FieldRow& row : maker.rows)
  {
    text += lineOf(row);
  }
  return text;
}

std::string describeSurfaceParameters(const Parameters& parameters, bool faulty)
{
  std::string text;
  for (const FieldRow& row : fieldRows(parameters))
  {
    const Shapes shapes = row.meaning.shapes;
    text += shapes == Shapes::SURFACE || (faulty && shapes == Shapes::FAULTS) ? lineOf(row) : "";
  }
  return text;
}

std::string parameterTableMarkdown()
{
  std::string table = "| parameter | type | unit | range | meaning |\n|---|---|---|---|---|\n";
  for (const FieldRow& row : fieldRows(Parameters()))
  {
    table += "| `" + row.key + "` | " + row.type + " | " + row.unit + " | " + allowedText(row) + " | " +
             row.meaning.text + " |\n";
  }
  return table;
}
}  // namespace hjt
